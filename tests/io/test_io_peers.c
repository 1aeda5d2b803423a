/* Files that other programs write and read, beyond the samples of tests/data: odd, but good. And those that
 * must be refused, or said. */
#include "support/io_files.h"

#ifdef __unix__
#include <sys/stat.h>
#include <unistd.h>
#endif

static vox_io_mesh* read_bytes(const char* name, const void* data, size_t size) {
    const vox_io_source source = {name, data, size};
    vox_io_mesh* mesh = NULL;
    const vox_result result = vox_io_read(&source, 1, NULL, &mesh);
    ck_assert_msg(result == VOX_OK, "%s: %s\n%.400s", name, vox_last_error(), (const char*)data);
    check_sound(mesh);
    return mesh;
}

/* Reads a body of that many tets (or triangles, negative) and volume; its warnings hold `words`. */
static void gives_bytes(const char* name, const void* data, size_t size, int elements, double volume,
                        const char* words) {
    vox_io_mesh* mesh = read_bytes(name, data, size);
    const vox_io_report report = report_of(mesh);
    const int found = elements < 0 ? -(int)report.triangles : (int)report.tets;
    ck_assert_msg(found == elements && close_to(report.volume, volume, 1e-6), "%s: %d, volume %g\n%.400s",
                  name, found, report.volume, (const char*)data);
    const char* warnings = vox_io_mesh_get_warnings(mesh);
    ck_assert_msg(*words ? strstr(warnings, words) != NULL : !*warnings, "%s: %s", name, warnings);
    vox_io_mesh_destroy(mesh);
}

static void gives(const char* name, const char* text, int elements, double volume, const char* words) {
    gives_bytes(name, text, strlen(text), elements, volume, words);
}

static void refused(const char* name, const char* text, vox_result code, const char* words) {
    const vox_io_source source = {name, text, strlen(text)};
    vox_io_mesh* mesh = NULL;
    ck_fails(vox_io_read(&source, 1, NULL, &mesh), code, words);
    ck_assert_ptr_null(mesh);
}

/* ---- surfaces: a tetrahedron of volume 1/6 ---- */

#define FACET(sep, a, b, c)                                                                                  \
    "facet normal 0 0 0" sep "outer loop" sep "vertex " a sep "vertex " b sep "vertex " c sep "endloop" sep  \
    "endfacet" sep
#define FACETS(sep)                                                                                          \
    FACET(sep, "0 0 0", "0 1 0", "1 0 0")                                                                    \
    FACET(sep, "0 0 0", "1 0 0", "0 0 1")                                                                    \
    FACET(sep, "1 0 0", "0 1 0", "0 0 1") FACET(sep, "0 0 0", "0 0 1", "0 1 0")

START_TEST(stl) {
    static const char* const good[] = {
        "solid a b\n" FACETS("\n") "end solid a b\n",
        "solid\n" FACETS("\n"),
        "solid a\n" FACETS("\n") "End\nSolid a",
        "solid facet of mine\n" FACETS("\n") "endsolid facet of mine\n",
        "solid a " FACETS(" ") "endsolid a",
        "solid a " FACETS(" ") "endsolid",
        "solid " FACETS("\t") "end solid a\n",
        "solid a\r" FACETS("\r\r") "endsolid a\r",
        "solid a\nfacet normal 0 0 1 outer loop vertex 0 0 0\nvertex\n0 1\n0 vertex 1 0 0 end loop end "
        "facet\n" FACET(" ", "0 0 0", "1 0 0", "0 0 1") FACET(
            "\n", "1 0 0", "0 1 0", "0 0 1") "endsolid\nsolid b\n" FACET("\n", "0 0 0", "0 0 1", "0 1 0")};
    for (size_t i = 0; i < sizeof good / sizeof *good; ++i) gives("a.stl", good[i], -4, 1.0 / 6, "");
    /* Two solids in one line, and without an end between them. */
    gives("a.stl",
          "solid a " FACET(" ", "0 0 0", "0 1 0", "1 0 0") "endsolid a solid b " FACET(
              " ", "0 0 0", "1 0 0", "0 0 1") "solid c " FACET(" ", "1 0 0", "0 1 0", "0 0 1") "endsolid c",
          -3, 0, "open");
    refused("a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", VOX_ERROR_FORMAT,
            "line 5: expected vertex, found the end of the file");

    bytes cube = read_file(VOX_TEST_DATA, "cube.stl");
    char* longer = (char*)calloc(cube.size + 92, 1);
    memcpy(longer, cube.data, cube.size);
    for (size_t more = 1; more <= 92; more += 91) {
        gives_bytes("a.stl", longer, cube.size + more, -12, 1, "left out");
        memcpy(longer, "solid a", 7);
        gives_bytes(NULL, longer, cube.size + more, -12, 1, more == 1 ? "1 byte behind" : "92 bytes behind");
    }
    free(longer);
    free(cube.data);
}
END_TEST

#define OBJ_V "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
#define OBJ_F "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"

START_TEST(obj_order) {
    static const char* const good[] = {
        OBJ_F OBJ_V, "v 0 0 0\n" OBJ_F "v 1 0 0\nv 0 1 0\n# last\nv 0 0 \\\n1\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 -1 -2\nf 1 2 4\nv 0 0 1\nf -3 -2 -1\nf 1 4 3"};
    for (size_t i = 0; i < sizeof good / sizeof *good; ++i) gives("a.obj", good[i], -4, 1.0 / 6, "");
    refused("a.obj", OBJ_F "v 0 0 0\nv 1 0 0\nv 0 1 0\n", VOX_ERROR_FORMAT,
            "line 2: expected a vertex number from 1 to 3, found 4");
    refused("a.obj", "f 1 2 3\n" OBJ_V "f 1 2 -5\n", VOX_ERROR_FORMAT,
            "1 to 4, of the vertices above, found -5");
    refused("a.obj", "v 0 0 0\nf 1 2 -2\n" OBJ_V, VOX_ERROR_FORMAT,
            "1 to 1, of the vertices above, found -2");
    refused("a.obj", "f 1 2 3\nv 0 0 0\nv 1 x 0\n", VOX_ERROR_FORMAT, "line 3: expected a coordinate");
}
END_TEST

#define PLY_HEAD(comment)                                                                                    \
    "ply\n" comment                                                                                          \
    "format ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"             \
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"

START_TEST(ply) {
    static const char* const good[] = {
        PLY_HEAD("comment format binary\nobj_info by hand\n") "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 "
                                                              "3\n3 1 2 3\n3 0 3 2\n",
        PLY_HEAD("") "0\n0\n0\n1 0\n0 0 1\n\n0 0 0 1\n3\n0 2 1\n3 0\n1\n3\n3 1 2 3 3 0 3 2",
        PLY_HEAD("") "0 0 0 1 0 0 0 1 0 0 0 1 3 0 2 1 3 0 1 3 3 1 2 3 3 0 3 2\n\n"};
    for (size_t i = 0; i < sizeof good / sizeof *good; ++i) gives("a.ply", good[i], -4, 1.0 / 6, "");
    refused("a.ply", PLY_HEAD("") "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2 7\n",
            VOX_ERROR_FORMAT, "line 17: expected the end of the file after the last element, found \"7\"");
    for (int big = 0; big < 2; ++big) {
        bytes cube = read_file(VOX_TEST_DATA, big ? "cube_big.ply" : "cube_little.ply");
        char* longer = (char*)malloc(cube.size + 2);
        memcpy(longer, cube.data, cube.size);
        memcpy(longer + cube.size, "\r\n", 2);
        gives_bytes("a.ply", longer, cube.size + 2, -12, 1, "");
        const vox_io_source source = {"a.ply", longer, cube.size + 2};
        longer[cube.size] = 'x';
        vox_io_mesh* mesh = NULL;
        ck_fails(vox_io_read(&source, 1, NULL, &mesh), VOX_ERROR_FORMAT, "expected the end of the file");
        free(longer);
        free(cube.data);
    }
}
END_TEST

START_TEST(off) {
    static const struct {
        const char *head, *behind; /* each vertex */
    } good[] = {{"OFF", ""},
                {"COFF", " 1 0 0 1"},
                {"NOFF", " 0 0 1"},
                {"NCOFF", " 0 0 1 255 0 0 255"},
                {"CNOFF", " 0 0 1 255 0 0 255"},
                {"CSTOFF", " 0.5 0.5 0.5 1 0 0"},
                {"STCNOFF", " 0 0 1 1 1 1 0 0"},
                {"NCSTOFF", " 0 0 1 1 1 1 0 0"},
                {"4OFF", " 1"},
                {"STCN4OFF", " 1 0 0 1"},
                {"nOFF 3", ""},
                {"STCN4nOFF 3", " 1 0"}};
    for (size_t i = 0; i < sizeof good / sizeof *good; ++i) {
        const char* b = good[i].behind;
        char text[512];
        snprintf(text, sizeof text,
                 "%s\n4 4 6\n0 0 0%s\n1 0 0%s\n0 1 0%s\n0 0 1%s\n3 0 2 1 1 0 0\n3 0 1 3\n3 1 2 3\n3 0 3 2\n",
                 good[i].head, b, b, b, b);
        gives(i % 2 ? NULL : "a.off", text, -4, 1.0 / 6, "");
    }
    gives("a.off",
          "4OFF\n4 4 0\n0 0 0 -3\n2 0 0 2\n0 -1 0 -1\n0 0 .5 .5\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n", -4,
          1.0 / 6, "");
    refused("a.off", "4OFF\n3 1 0\n0 0 0 1\n1 0 0 0\n0 1 0 1\n3 0 1 2\n", VOX_ERROR_FORMAT,
            "line 4: expected a fourth coordinate that divides the others, found 0");
    refused("a.off", "nOFF 4\n3 1 0\n", VOX_ERROR_UNSUPPORTED, "three dimensions are read, found 4");
    refused("a.off", "CCOFF\n3 1 0\n", VOX_ERROR_UNSUPPORTED, "CCOFF: expected OFF, with");
}
END_TEST

/* ---- tets: one of volume 1/6, in ways that hold more nodes than its corners ---- */

static const char* fill(char* text, const char* before, int nodes, const char* separator,
                        const char* behind) {
    char* at = text + sprintf(text, "%s", before);
    for (int i = 0; i < nodes; ++i) at += sprintf(at, "%s%d", i ? separator : "", i < 4 ? i + 1 : 1 + i % 4);
    sprintf(at, "%s", behind);
    return text;
}

#define MEDIT "MeshVersionFormatted 2\nDimension 3\nVertices 4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
#define HIGHER "1 tet has more than four nodes; only its corners were used\n"

START_TEST(medit_orders) {
    static char text[20000], before[400];
    for (int order = 1; order <= 5; ++order) {
        const int nodes = (order + 1) * (order + 2) * (order + 3) / 6;
        if (order == 1)
            snprintf(before, sizeof before,
                     MEDIT "TrianglesP4 1\n1 2 3 1 2 3 1 2 3 1 2 3 1 2 3 0\nTetrahedra 1\n");
        else
            snprintf(before, sizeof before, MEDIT "TetrahedraP%d 1\n", order);
        gives("a.mesh", fill(text, before, nodes, " ", " 7\nEnd\n"), 1, 1.0 / 6, order == 1 ? "" : HIGHER);
    }
    /* Other volumes of any order are said, beside a tet. */
    gives("a.mesh", fill(text, MEDIT "Tetrahedra 1 1 2 3 4 0\nHexahedraQ2 1\n", 27, " ", " 0\nEnd\n"), 1,
          1.0 / 6, "1 volume element of another kind was left out: hexahedra");
    gives("a.mesh", fill(text, MEDIT "Tetrahedra 1 1 2 3 4 0\nPrismsP3 1\n", 40, " ", " 0\nEnd\n"), 1,
          1.0 / 6, "prisms");
    gives("a.mesh", fill(text, MEDIT "Tetrahedra 1 1 2 3 4 0\nPyramidsP2 1\n", 14, " ", " 0\nEnd\n"), 1,
          1.0 / 6, "pyramids");
    /* The order of the nodes may be another: said if corners are not first. */
#define ORDERING(a, b)                                                                                       \
    MEDIT "TetrahedraP2Ordering 10\n" a "\n" b                                                               \
          "\n0 0 2 0\n0 0 0 2\n1 1 0 0\n0 1 1 0\n1 0 1 0\n1 0 0 1\n0 1 0 1\n"                                \
          "0 0 1 1\nTetrahedraP2 1\n1 2 3 4 1 2 3 4 1 2 0\nEnd\n"
    gives("a.mesh", ORDERING("2 0 0 0", "0 2 0 0"), 1, 1.0 / 6, HIGHER);
    refused("a.mesh", ORDERING("0 2 0 0", "2 0 0 0"), VOX_ERROR_UNSUPPORTED,
            "TetrahedraP2Ordering: elements are read whose corners come first");
    refused("a.mesh", MEDIT "TetrahedraP3 1\n1 2 3 4 1\nEnd\n", VOX_ERROR_FORMAT,
            "number of elements: 1 are declared");
}
END_TEST

START_TEST(fortran_exponents) {
    static const char* const ones[] = {"1.0D+00", "0.1d1",   "10.D-1", "+1.0D0",
                                       "1.0+00",  "0.1+001", "100.-2", "1e0"};
    for (size_t i = 0; i < sizeof ones / sizeof *ones; ++i) {
        char text[256];
        snprintf(text, sizeof text,
                 "MeshVersionFormatted 1\nDimension 3\nVertices 4\n0 0 0 0\n%s 0.D0 0 0\n0 %s 0 0\n0 0 %s 0\n"
                 "Tetrahedra 1\n1 2 3 4 0\nEnd\n",
                 ones[i], ones[i], ones[i]);
        gives("a.mesh", text, 1, 1.0 / 6, "");
    }
    static const char* const bad[] = {"1.0D", "1.0D+", "1D1x", "1e0D0", "1+1", "1.0E+00D+00", "1.0DD0"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        char text[256];
        snprintf(text, sizeof text, OBJ_V "v %s 0 0\nf 1 2 3\n", bad[i]);
        refused("a.obj", text, VOX_ERROR_FORMAT, "line 5: expected a coordinate");
    }
    refused("a.obj", "v 1.0D400 0 0\n", VOX_ERROR_FORMAT, "out of range");
}
END_TEST

#define VTK "# vtk DataFile Version 3.0\na\nASCII\nDATASET UNSTRUCTURED_GRID\n"
#define VTK_POINTS "POINTS 5 double\n0 0 0 1 0 0 0 1 0 0 0 1 9 9 9\n"

START_TEST(vtk_kinds) {
    static const struct {
        int type, nodes, corners;
    } rows[] = {{71, 4, 4},  {71, 20, 4}, {71, 35, 4}, {78, 10, 4}, {78, 20, 4}, {64, 10, 4}, {69, 3, 3},
                {69, 10, 3}, {76, 6, 3},  {76, 15, 3}, {61, 10, 3}, {22, 6, 3},  {34, 7, 3}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        const int nodes = rows[i].nodes, is_tet = rows[i].corners == 4;
        char text[1024];
        int at = snprintf(text, sizeof text, VTK VTK_POINTS "CELLS 2 %d\n4 0 1 2 3\n%d", nodes + 6, nodes);
        for (int k = 0; k < nodes; ++k) at += sprintf(text + at, " %d", k % 5);
        sprintf(text + at, "\nCELL_TYPES 2\n10\n%d\n", rows[i].type);
        vox_io_mesh* mesh = read_bytes("a.vtk", text, strlen(text));
        ck_assert_uint_eq(report_of(mesh).tets, is_tet ? 2u : 1u);
        ck_assert_uint_eq(report_of(mesh).triangles, is_tet ? 0u : 1u);
        ck_assert_uint_eq(report_of(mesh).second_order_tets, is_tet && nodes > 4);
        vox_io_mesh_destroy(mesh);
    }
    refused("a.vtk", VTK VTK_POINTS "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n71\n", VOX_ERROR_FORMAT,
            "cell 0: expected 4 points (Lagrange tetrahedron), found 3");
    refused("a.vtk", VTK VTK_POINTS "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n5\n", VOX_ERROR_FORMAT,
            "expected 3 points");
}
END_TEST

#define ONE_TET VTK_POINTS "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n"

START_TEST(vtk_fields) {
    gives("a.vtk",
          VTK "FIELD f 3\nauthor 1 2 string\nAn%20author\n\nNULL_ARRAY\nMETADATA\nINFORMATION 0\n\nv 1 1 "
              "variant\n14 x y\n" ONE_TET,
          1, 1.0 / 6, "belongs to no tet");
    gives("a.vtk",
          VTK "FIELD f 2\nflags 1 9 bit\n0 1 0 1 0 1 0 1 1\nMETADATA\nINFORMATION 0\n\nt 1 1 "
              "signed_char\n-1\n" ONE_TET,
          1, 1.0 / 6, "belongs");
    /* In binary the length takes 1, 2, 4 or 8 bytes. */
    static char data[90000];
    const size_t lengths[] = {0, 5, 63, 64, 100, 16383, 16384, 20000, 7};
    size_t at = (size_t)sprintf(data, "# vtk DataFile Version 3.0\na\nBINARY\nDATASET UNSTRUCTURED_GRID\n"
                                      "FIELD f 3\nbits 1 9 bit\n##\nnames 3 3 string\n");
    for (size_t i = 0; i < 9; ++i) {
        const size_t n = lengths[i];
        const int code = i == 8 ? 0 : n < 64 ? 3 : n < 16384 ? 2 : 1, bytes_of = 1 << (3 - code);
        for (int b = bytes_of - 1; b >= 0; --b)
            data[at++] = (char)((b == bytes_of - 1 ? code << 6 : 0) | (int)((b < 4 ? n >> 8 * b : 0) & 255));
        memset(data + at, '\n', n);
        at += n;
    }
    at += (size_t)sprintf(data + at, "\nt 1 2 double\n1234567812345678\nPOINTS 4 char\n");
    memcpy(data + at,
           "\0\0\0\1\0\0\0\1\0\0\0\1\nCELLS 1 5\n\0\0\0\4\0\0\0\0\0\0\0\1\0\0\0\2\0\0\0\3\nCELL_TYPES "
           "1\n\0\0\0\12\n",
           12 + 11 + 20 + 14 + 5);
    gives_bytes("a.vtk", data, at + 62, 1, 1.0 / 6, "");
    refused(
        "a.vtk",
        "# vtk DataFile Version 3.0\na\nBINARY\nDATASET UNSTRUCTURED_GRID\nFIELD f 1\na 1 1 string\n\xff ",
        VOX_ERROR_FORMAT, "bytes of a string: 63 are declared");
}
END_TEST

START_TEST(vtk_surfaces) {
    static const char head[] = "# vtk DataFile Version 3.0\na\nASCII\nDATASET POLYDATA\n" VTK_POINTS;
    char text[600];
    snprintf(text, sizeof text,
             "%sVERTICES 1 2\n1 4\nPOLYGONS 2 8\n3 0 2 1\n3 0 1 3\nTRIANGLE_STRIPS 1 5\n4 0 3 2 1\n", head);
    gives("a.vtk", text, -4, 1.0 / 6, "");
    gives(NULL, text, -4, 1.0 / 6, "");
    gives("a.vtk", head, 0, 0, "points alone");
    snprintf(text, sizeof text, "%sPOLYGONS 1 4\n3 0 2 5\n", head);
    refused("a.vtk", text, VOX_ERROR_FORMAT, "cell 0: expected a point from 0 to 4, found 5");
    snprintf(text, sizeof text, "%sCELLS 1 4\n3 0 2 1\n", head);
    refused("a.vtk", text, VOX_ERROR_FORMAT, "expected POINTS, POLYGONS, TRIANGLE_STRIPS");
    refused("a.vtk", "# vtk DataFile Version 3.0\na\nASCII\nDATASET STRUCTURED_GRID\n", VOX_ERROR_FORMAT,
            "expected UNSTRUCTURED_GRID or POLYDATA");
    bytes file = read_file(VOX_TEST_DATA, "cube.vtk");
    vox_io_mesh* mesh = read_bytes(NULL, file.data, file.size);
    ck_assert_uint_eq(report_of(mesh).skipped_elements, 1); /* a line */
    vox_io_mesh_destroy(mesh);
    free(file.data);
}
END_TEST

#ifdef VOX_TEST_XML
START_TEST(vtu_compressors) {
    bytes raw = read_file(VOX_TEST_DATA, "box_ascii.vtu");
    vox_io_mesh* mesh = read_bytes("raw.vtu", raw.data, raw.size);
    for (int lzma = 0; lzma < 2; ++lzma) {
        bytes file = read_file(VOX_TEST_DATA, lzma ? "box_appended_lzma.vtu" : "box_base64_lz4.vtu");
#ifndef VOX_TEST_LZMA
        if (lzma) {
            const vox_io_source source = {"a.vtu", file.data, file.size};
            vox_io_mesh* none = NULL;
            ck_fails(vox_io_read(&source, 1, NULL, &none), VOX_ERROR_UNSUPPORTED, "VOX_IO_LZMA");
            free(file.data);
            continue;
        }
#endif
        vox_io_mesh* packed = read_bytes("a.vtu", file.data, file.size);
        check_same(mesh, packed);
        vox_io_mesh_destroy(packed);
        free(file.data);
    }
    vox_io_mesh_destroy(mesh);
    free(raw.data);
    refused("a.vtu", "<VTKFile type=\"UnstructuredGrid\" compressor=\"vtkOtherCompressor\"/>",
            VOX_ERROR_UNSUPPORTED, "vtkLZ4DataCompressor and vtkLZMADataCompressor are read");
#define POINTS_OF_LZ4(base64)                                                                                \
    "<VTKFile type=\"PolyData\" compressor=\"vtkLZ4DataCompressor\"><PolyData><Piece "                       \
    "NumberOfPoints=\"2\"><Points>"                                                                          \
    "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"binary\">" base64                         \
    "</DataArray></Points></Piece></PolyData></VTKFile>"
    /* One block of 48 bytes: a zero, 46 more copied from one before, a zero. */
    gives("a.vtp", POINTS_OF_LZ4("AQAAADAAAAAAAAAABwAAAB8AAQAbEAA="), 0, 0, "points alone");
    static const char* const bad[] = {"AQAAADAAAAAAAAAABwAAAB8AAgAbEAA=", /* from before the begin */
                                      "AQAAADAAAAAAAAAABwAAAB8AAAAbEAA=", /* from itself */
                                      "AQAAADAAAAAAAAAABwAAAB8AAQAcEAA=", /* too long */
                                      "AQAAADAAAAAAAAAABwAAAB8AAQAaEAA=", /* too short */
                                      "AQAAADAAAAAAAAAABAAAAB8AAQA=",     /* without the rest of a length */
                                      "AQAAADAAAAAAAAAAAQAAAPA="};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        char text[400];
        snprintf(text, sizeof text, POINTS_OF_LZ4("%s"), bad[i]);
        refused("a.vtp", text, VOX_ERROR_FORMAT, "block 0: expected 48 bytes packed by LZ4");
    }
}
END_TEST
#endif

#define MSH                                                                                                  \
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 "                     \
    "1\n$EndNodes\n$Elements\n"

START_TEST(gmsh_types) {
    static char text[20000], before[400];
    static const struct {
        int type, nodes, tets;
    } rows[] = {{71, 84, 2},  {75, 286, 2}, {32, 22, 2}, {79, 34, 2},  {137, 16, 2}, {36, 16, 1}, {42, 28, 1},
                {95, 343, 1}, {118, 30, 1}, {34, 7, 1},  {1234, 9, 1}, {140, 4, 1},  {62, 7, 1}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        snprintf(before, sizeof before, MSH "2\n1 4 2 1 1 1 2 3 4\n2 %d 2 1 1 ", rows[i].type);
        fill(text, before, rows[i].nodes, " ", "\n$EndElements\n");
        vox_io_mesh* mesh = read_bytes("a.msh", text, strlen(text));
        ck_assert_msg((int)report_of(mesh).tets == rows[i].tets, "type %d", rows[i].type);
        ck_assert_uint_eq(report_of(mesh).triangles, rows[i].type == 42);
        vox_io_mesh_destroy(mesh);
    }
    gives("a.msh", MSH "2\n1 4 2 1 1 1 2 3 4\n2 35 0 1 2 3 4\n$EndElements\n", 1, 1.0 / 6, "of unknown type");
    refused("a.msh", MSH "2\n1 4 2 1 1 1 2 3 4\n2 0 0 1 2 3 4\n$EndElements\n", VOX_ERROR_FORMAT,
            "an element type of Gmsh");
}
END_TEST

/* A type above 31 between two blocks of tets in binary: its nodes must be counted to find the next. */
START_TEST(gmsh_binary_types) {
    static const int types[][2] = {{71, 84}, {98, 1000}, {106, 126}, {131, 69}, {61, 40}, {34, 0}};
    for (size_t i = 0; i < sizeof types / sizeof *types; ++i) {
        static char data[8000];
        size_t at = (size_t)sprintf(data, "$MeshFormat\n2.2 1 8\n");
        const int one = 1;
        memcpy(data + at, &one, 4);
        at += 4 + (size_t)sprintf(data + at + 4, "\n$EndMeshFormat\n$Nodes\n4\n");
        for (int n = 0; n < 4; ++n) {
            const int number = n + 1;
            const double p[3] = {n == 1, n == 2, n == 3};
            memcpy(data + at, &number, 4);
            memcpy(data + at + 4, p, 24);
            at += 28;
        }
        at += (size_t)sprintf(data + at, "\n$EndNodes\n$Elements\n3\n");
        for (int block = 0; block < 3; ++block) {
            const int nodes = block == 1 ? types[i][1] : 4;
            const int head[4] = {block == 1 ? types[i][0] : 4, 1, 0, block + 1};
            memcpy(data + at, head, 16);
            at += 16;
            for (int n = 0; n < nodes; ++n, at += 4) memcpy(data + at, &(const int){1 + n % 4}, 4);
        }
        at += (size_t)sprintf(data + at, "\n$EndElements\n");
        if (types[i][1]) {
            vox_io_mesh* mesh = read_bytes("a.msh", data, at);
            ck_assert_uint_eq(report_of(mesh).tets, types[i][0] == 71 ? 3u : 2u);
            vox_io_mesh_destroy(mesh);
        } else {
            const vox_io_source source = {"a.msh", data, at};
            vox_io_mesh* mesh = NULL;
            ck_fails(vox_io_read(&source, 1, NULL, &mesh), VOX_ERROR_FORMAT,
                     "with a fixed number of nodes, found 34");
        }
    }
}
END_TEST

/* ---- Abaqus ---- */

#define NODES "*NODE\n1, 0., 0., 0.\n2, 1.0D0, , 0.\n3,0,1\n40, 0, 0, 1, 0.5\n"

START_TEST(abaqus) {
    static const char* const good[] = {
        NODES "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 40\n",
        "** by hand\r\n*heading\r\n a title, with a *star\r\n** \r\n*Node , nset = \"all "
        "nodes\"\r\n1,0,0,0\r\n2,1,0,0\r\n"
        "** in between\r\n3,0,1,0\r\n40,0,0,1\r\n*Element, type = c3d4h , elset=E\r\n 7 ,1 , "
        "2,3,\r\n40\r\n*End Step",
        "*ELEMENT, TYPE=C3D10M\n1, 1,2,3,40,1,2,\n3,40,1,2\n" NODES,
        "*ELEMENT, TYPE=DC3D10\n1, 1,2,3,40,1,2\n3,40,1,2\n*NODE OUTPUT\nU, RF\n" NODES,
        "*PREPRINT, ECHO=NO\n*MATERIAL, NAME=m\n" NODES
        "*ELEMENT, TYPE=S3R\n9, 1, 2, 3\n*ELEMENT, TYPE=C3D4\n1,1,2,3,40\n"};
    for (size_t i = 0; i < sizeof good / sizeof *good; ++i)
        gives(i % 2 ? "a.inp" : NULL, good[i], 1, 1.0 / 6, i == 2 || i == 3 ? HIGHER : "");
    gives("a.inp",
          NODES "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 40\n*ELEMENT, "
                "TYPE=C3D20R\n2,1,2,3,40,1,2,3,40,1,2,3,40,1,2,3,\n40,1,2,3,4\n"
                "3,1,2,3,40,1,2,3,40,1,2,3,40,1,2,3,\n40,1,2,3,4\n*ELEMENT, "
                "TYPE=COH3D6\n5,1,2,3,40,1,2\n*INCLUDE, INPUT=more.inp\n",
          1, 1.0 / 6, "2 volume elements of another kind were left out: hexahedra");
    gives("a.inp", NODES "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 40\n*INCLUDE, INPUT=more.inp\n", 1, 1.0 / 6,
          "a.inp, line 8: *INCLUDE: what is in another file, MORE.INP, was left out");
    refused("a.inp", NODES "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n", VOX_ERROR_FORMAT,
            "line 7: expected the number of a node, found 4");
    refused("a.inp", NODES "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3\n", VOX_ERROR_FORMAT, "expected a node number");
    refused("a.inp", NODES "*ELEMENT, TYPE=C3D4\n1, 1, , 3, 40\n", VOX_ERROR_FORMAT,
            "line 7: expected a node number");
    refused("a.inp", NODES NODES "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 40\n", VOX_ERROR_FORMAT,
            "two nodes have the number 1");
    refused("a.inp", NODES "*ELEMENT, TYPE=S3\n1, 1, 2, 3\n", VOX_ERROR_FORMAT,
            "expected tetrahedra, found none (but 1 tri");
    refused("a.inp", "*NODE, SYSTEM=C\n1, 0, 0, 0\n", VOX_ERROR_UNSUPPORTED, "line 1: SYSTEM=C: rectangular");
    refused("a.inp", NODES "*NGEN\n1, 40, 1\n", VOX_ERROR_UNSUPPORTED, "line 6: *NGEN is not read");
}
END_TEST

/* Numbers begin anew in each part; each instance of one is placed. A part that has none is not shown. */
START_TEST(abaqus_instances) {
#define PART(name) "*PART, NAME=" name "\n" NODES "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 40\n*END PART\n"
    static const char text[] = PART("a")
        PART("b") "*ASSEMBLY, NAME=all\n*INSTANCE, NAME=a-1, PART=a\n*END INSTANCE\n"
                  "*INSTANCE, NAME=a-2, PART=A\n10., 0., 0.\n*END INSTANCE\n"
                  "*INSTANCE, NAME=a-3, PART=a\n5., 0., 0.\n5., 0., 0., 5., 0., 1., 90.\n*END INSTANCE\n"
                  "*INSTANCE, NAME=own\n*NODE\n1,20,0,0\n2,21,0,0\n3,20,1,0\n4,20,0,1\n*ELEMENT, "
                  "TYPE=C3D4\n1,1,2,3,4\n*END INSTANCE\n"
                  "*NODE\n1, 0, 0, 7\n*END ASSEMBLY\n";
    vox_io_mesh* mesh = read_bytes("a.inp", text, strlen(text));
    const vox_io_report report = report_of(mesh);
    ck_assert_uint_eq(report.tets, 4);
    ck_assert_uint_eq(report.components, 4);
    ck_assert(close_to(report.volume, 4.0 / 6, 1e-12));
    ck_assert_double_eq(report.bounds_max[0], 21);
    vox_io_mesh_view view;
    ck_ok(vox_io_mesh_get_arrays(mesh, &view));
    /* The third instance is turned about its own corner: x becomes y. */
    int found = 0;
    for (uint64_t v = 0; v < view.vertex_count; ++v)
        found += fabs(view.positions[3 * v] - 4) < 1e-12 && fabs(view.positions[3 * v + 1]) < 1e-12;
    ck_assert_int_eq(found, 1);
    vox_io_mesh_destroy(mesh);
    gives("a.inp", PART("a") PART("b"), 2, 2.0 / 6, "lie exactly where earlier ones lie");
    refused("a.inp", PART("a") "*ASSEMBLY\n*INSTANCE, NAME=x, PART=c\n*END INSTANCE\n*END ASSEMBLY\n",
            VOX_ERROR_FORMAT, "line 11: expected the name of a part, found C");
}
END_TEST

/* A part of some nodes that is placed many times stands for more than its file. */
START_TEST(abaqus_limit) {
    const size_t nodes = 20000, instances = 20000;
    char* text = (char*)malloc(40 * (nodes + instances) + 1000);
    char* at = text + sprintf(text, "*PART, NAME=a\n*NODE\n");
    for (size_t n = 0; n < nodes; ++n) at += sprintf(at, "%d,%d\n", (int)n + 1, (int)n);
    at += sprintf(at, "*ELEMENT,TYPE=C3D4\n1,1,2,3,4\n*END PART\n");
    for (size_t i = 0; i < instances; ++i) at += sprintf(at, "*INSTANCE,PART=a\n");
    refused("a.inp", text, VOX_ERROR_LIMIT, "more nodes or tetrahedra than the limit of");
    free(text);
}
END_TEST

/* ---- glTF ---- */

/* Four corners, four faces; sparse indices 1, 2, 3 of one byte, with a corner each; base64 of 48 + 12 + 3 (+
 * 1) + 36. */
#define GLTF(scenes, nodes, positions)                                                                       \
    "{\"asset\":{\"version\":\"2.0\"}," scenes nodes                                                         \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"                       \
    "\"accessors\":[{\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"," positions "},"                   \
    "{\"bufferView\":1,\"componentType\":5121,\"count\":12,\"type\":\"SCALAR\"}],"                           \
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":12},"  \
    "{\"buffer\":0,\"byteOffset\":60,\"byteLength\":4},{\"buffer\":0,\"byteOffset\":64,\"byteLength\":36}]," \
    "\"buffers\":[{\"byteLength\":100,\"uri\":\"data:;base64,"                                               \
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/"                                       \
    "AAIBAAEDAQIDAAMCAQIDAwAAAEAAAAAAAAAAAAAAAAAAAABAAAAAAAAAAAAAAAAAAAAAQA==\"}]}"
#define SCENE "\"scenes\":[{\"nodes\":[0]}],"
#define PLAIN "\"bufferView\":0"
#define SPARSE(count, base, type)                                                                            \
    base "\"sparse\":{\"count\":" count ",\"indices\":{\"bufferView\":2,\"componentType\":" type             \
         "},\"values\":{\"bufferView\":3}}"

START_TEST(gltf_sparse) {
    gives("a.gltf", GLTF(SCENE, "\"nodes\":[{\"mesh\":0}],", PLAIN), -4, 1.0 / 6, "");
    /* All but the origin are others, twice as far: over zeros, and over what is there. */
    gives("a.gltf", GLTF(SCENE, "\"nodes\":[{\"mesh\":0}],", SPARSE("3", "", "5121")), -4, 8.0 / 6, "");
    gives("a.gltf", GLTF(SCENE, "\"nodes\":[{\"mesh\":0}],", SPARSE("3", PLAIN ",", "5121")), -4, 8.0 / 6,
          "");
    gives("a.gltf", GLTF(SCENE, "\"nodes\":[{\"mesh\":0}],", SPARSE("1", PLAIN ",", "5121")), -4, 2.0 / 6,
          "");
    static const struct {
        const char *text, *words;
    } bad[] = {{GLTF(SCENE, "\"nodes\":[{\"mesh\":0}],", SPARSE("4", PLAIN ",", "5121")),
                "accessor 0.sparse.values: 4 values of 12 bytes do not fit into the 36 bytes"},
               {GLTF(SCENE, "\"nodes\":[{\"mesh\":0}],", SPARSE("2", PLAIN ",", "5123")),
                "accessor 0.sparse.indices: expected numbers below 4 that ascend, found 513 at 0"},
               {GLTF(SCENE, "\"nodes\":[{\"mesh\":0}],", SPARSE("2", PLAIN ",", "5120")),
                "expected an unsigned type, found 5120"},
               {GLTF(SCENE, "\"nodes\":[{\"mesh\":0}],", "\"normalized\":false"),
                "accessor 0: expected a buffer view, found none"},
               {GLTF(SCENE, "\"nodes\":[{\"mesh\":0}],", "\"sparse\":{\"count\":1}"),
                "accessor 0.sparse: expected a buffer view"},
               {GLTF(SCENE, "\"nodes\":[{\"mesh\":0}],", "\"sparse\":{\"count\":-1}"),
                "accessors[0].sparse.count: expected a number of values, found -1"}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i)
        refused("a.gltf", bad[i].text, VOX_ERROR_FORMAT, bad[i].words);
    /* Zeros take no bytes; their number has a limit. */
    char* text = (char*)malloc(4000);
    strcpy(text, GLTF(SCENE, "\"nodes\":[{\"mesh\":0}],", SPARSE("3", "", "5121")));
    char* count = strstr(text, "\"count\":4");
    memmove(count + 18, count + 9, strlen(count + 9) + 1);
    memcpy(count, "\"count\":4000000000", 18);
    refused("a.gltf", text, VOX_ERROR_LIMIT,
            "accessor 0: 4000000000 values without a buffer view are more than");
    free(text);
}
END_TEST

START_TEST(gltf_without_scenes) {
    gives("a.gltf", GLTF("", "\"nodes\":[{\"mesh\":0}],", PLAIN), -4, 1.0 / 6, "");
    gives("a.gltf",
          GLTF("\"scenes\":[],", "\"nodes\":[{\"mesh\":0},{\"children\":[0],\"scale\":[2,2,2]}],", PLAIN), -4,
          8.0 / 6, "");
    gives("a.gltf", GLTF("", "", PLAIN), -4, 1.0 / 6, ""); /* a library of meshes */
    refused("a.gltf", GLTF("\"scene\":0,", "\"nodes\":[{\"mesh\":0}],", PLAIN), VOX_ERROR_FORMAT,
            "expected scene 0, found 0 scenes");
}
END_TEST

START_TEST(gltf_placements) {
#define NODE(how) GLTF(SCENE, "\"nodes\":[{\"mesh\":0," how "}],", PLAIN)
    static const struct {
        const char* text;
        double volume;
    } good[] = {{NODE("\"rotation\":[0,0,0.7071,0.7071]"), 1.0 / 6}, /* rounded */
                {NODE("\"rotation\":[0.1826,0.3651,0.5477,0.7303]"), 1.0 / 6},
                {NODE("\"rotation\":[0,0,0,1.009]"), 1.0 / 6},
                {NODE("\"scale\":[-1,1,1]"), 1.0 / 6}, /* mirrored: what is outside stays outside */
                {NODE("\"scale\":[-1,-1,-1]"), 1.0 / 6},
                {NODE("\"matrix\":[1,0,0,0, 3,1,0,0, 0,0,1,0, 0,0,0,1]"), 1.0 / 6}, /* sheared */
                {NODE("\"matrix\":[0,1,0,0, 1,0,0,0, 0,0,1,0, 5,5,5,1]"), 1.0 / 6}, /* mirrored */
                {GLTF(SCENE,
                      "\"nodes\":[{\"children\":[1],\"scale\":[1,-2,1]},{\"mesh\":0,\"scale\":[-1,1,1],"
                      "\"rotation\":[0,0,0.3827,0.9239]}],",
                      PLAIN),
                 2.0 / 6}}; /* mirrored twice, sheared by a scale around a rotation */
    for (size_t i = 0; i < sizeof good / sizeof *good; ++i)
        gives("a.gltf", good[i].text, -4, good[i].volume, "");
    refused("a.gltf", NODE("\"rotation\":[0,0,2,2]"), VOX_ERROR_FORMAT,
            "nodes[0].rotation: expected a quaternion of length 1, within 0.01, found 0 0 2 2, of length "
            "2.82843");
    refused("a.gltf", NODE("\"rotation\":[0,0,0,0]"), VOX_ERROR_FORMAT, "of length 0");
    refused("a.gltf", NODE("\"rotation\":[0,0,0,1e200]"), VOX_ERROR_FORMAT, "nodes[0].rotation: expected");
    refused("a.gltf", NODE("\"matrix\":[1,0,0,0.5, 0,1,0,0, 0,0,1,0, 0,0,0,1]"), VOX_ERROR_FORMAT,
            "nodes[0].matrix: expected 0 0 0 1 as the last row, found 0.5 0 0 1");
    /* So small that the determinant is no double. */
    gives("a.gltf", NODE("\"scale\":[-1e-100,-1e-110,-1e-120]"), -4, 0, "too small for single precision");
}
END_TEST

#ifdef __unix__
/* Beside a .node its .ele, whatever the case of the two names. */
START_TEST(tetgen_names) {
    char folder[] = "/tmp/vox_test_io_XXXXXX";
    ck_assert_ptr_nonnull(mkdtemp(folder));
    bytes data[2] = {read_file(VOX_TEST_DATA, "box.node"), read_file(VOX_TEST_DATA, "box.ele")};
    static const char* const pairs[][2] = {{"A.NODE", "A.ELE"},
                                           {"B.node", "b.Ele"},
                                           {"c.Node", "C.ele"},
                                           {"d.node", "d.ele"},
                                           {"\xc3\xa9.node", "\xc3\xa9.ELE"}};
    char paths[2][256];
    for (size_t p = 0; p < sizeof pairs / sizeof *pairs; ++p) {
        for (int i = 0; i < 2; ++i) {
            snprintf(paths[i], sizeof paths[i], "%s/%s", folder, pairs[p][i]);
            FILE* file = fopen(paths[i], "wb");
            ck_assert_ptr_nonnull(file);
            fwrite(data[i].data, 1, data[i].size, file);
            fclose(file);
        }
        for (int i = 0; i < 2; ++i) {
            vox_io_mesh* mesh = NULL;
            const vox_result result = vox_io_load(paths[i], NULL, &mesh);
            ck_assert_msg(result == VOX_OK, "%s: %s", pairs[p][i], vox_last_error());
            ck_assert_uint_eq(report_of(mesh).tets, 10);
            vox_io_mesh_destroy(mesh);
        }
        unlink(paths[1]);
        vox_io_mesh* mesh = NULL;
        ck_fails(vox_io_load(paths[0], NULL, &mesh), VOX_ERROR_FILE, ".ele: No such file");
        unlink(paths[0]);
    }
    rmdir(folder);
    free(data[0].data);
    free(data[1].data);
}
END_TEST
#endif

SUITE(io_peers) {
    TCase* tests = add_case(suite, "peers");
    tcase_add_each(tests, stl, obj_order, ply, off, medit_orders, fortran_exponents, vtk_kinds, vtk_fields,
                   vtk_surfaces, gmsh_types, gmsh_binary_types, abaqus, abaqus_instances, abaqus_limit,
                   gltf_sparse, gltf_without_scenes, gltf_placements);
#ifdef VOX_TEST_XML
    tcase_add_test(tests, vtu_compressors);
#endif
#ifdef __unix__
    tcase_add_test(tests, tetgen_names);
#endif
}
