/* Surfaces: what each format may hold, line ends, errors and their places, polygons, scenes with files beside
 * them, and assimp, which reads only where it is asked for. */
#include "support/io_files.h"

#ifdef __unix__
#include <sys/stat.h>
#include <unistd.h>
#endif

static const uint32_t all_meshes = UINT32_MAX; /* as an index of a mesh */

static vox_io_mesh* read_bytes(const char* name, const void* data, size_t size, uint32_t mesh_index) {
    const vox_io_source source = {name, data, size};
    vox_io_load_desc desc = vox_default_io_load_desc();
    desc.mesh = mesh_index + 1;
    vox_io_mesh* mesh = NULL;
    const vox_result result = vox_io_read(&source, 1, &desc, &mesh);
    ck_assert_msg(result == VOX_OK, "%s: %s", name, vox_last_error());
    check_sound(mesh);
    return mesh;
}

static vox_io_mesh* read_text(const char* name, const char* text) {
    return read_bytes(name, text, strlen(text), all_meshes);
}

static uint64_t triangles_of(const char* name, const char* text, uint32_t mesh_index) {
    vox_io_mesh* mesh = read_bytes(name, text, strlen(text), mesh_index);
    const uint64_t triangles = report_of(mesh).triangles;
    vox_io_mesh_destroy(mesh);
    return triangles;
}

static void refused(const char* name, const char* text, vox_result code, const char* words) {
    const vox_io_source source = {name, text, strlen(text)};
    vox_io_mesh* mesh = NULL;
    ck_fails(vox_io_read(&source, 1, NULL, &mesh), code, words);
    ck_assert_ptr_null(mesh);
}

/* `file` with other line ends, up to the byte `last`. */
static bytes with_line_ends(const bytes* file, const char* end, size_t last) {
    bytes out = {(unsigned char*)malloc(2 * file->size + 1), 0};
    for (size_t i = 0; i < file->size; ++i) {
        const size_t length = i < last && file->data[i] == '\n' ? strlen(end) : 1;
        memcpy(out.data + out.size, length == 1 && file->data[i] != '\n' ? (const char*)&file->data[i] : end,
               length);
        if (i >= last) out.data[out.size] = file->data[i];
        out.size += length;
    }
    return out;
}

/* Files of points alone: all of them, repeated ones too. */
START_TEST(points_alone) {
    static const char* const files[] = {
        "v 0 0 0\nv 1 0 0\nv 1 0 0\np 1 2\n",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
        "z\nend_header\n"
        "0 0 0\n1 0 0\n1 0 0\n",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 0\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n1 0 0\n",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element tristrips 0\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 0 0\n"};
    vox_io_load_desc desc = vox_default_io_load_desc();
    for (int i = 0; i < 4; ++i) {
        const vox_io_source source = {i == 0 ? "cloud.obj" : "cloud.ply", files[i], strlen(files[i])};
        vox_io_mesh* mesh = NULL;
        desc.mesh = 2; /* they are one mesh, that of index 0 */
        ck_fails(vox_io_read(&source, 1, &desc, &mesh), VOX_ERROR_INVALID_ARGUMENT,
                 "mesh 2 was asked for, but the file holds 1");
        desc.mesh = i % 2;
        ck_assert_msg(vox_io_read(&source, 1, &desc, &mesh) == VOX_OK, "%s", vox_last_error());
        vox_io_mesh_view view;
        ck_assert_int_eq(vox_io_mesh_get_arrays(mesh, &view), VOX_OK);
        ck_assert_uint_eq(view.vertex_count, 3);
        ck_assert_uint_eq(view.triangle_count, 0);
        ck_assert_double_eq(view.positions[6], 1);
        vox_io_mesh_destroy(mesh);
    }
    refused("a.ply",
            "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
            "end_header\n",
            VOX_ERROR_FORMAT, "expected triangles, found none");
}
END_TEST

/* Windows and old Macintosh: every text format gives the same mesh, and so do headers of binary ones. */
START_TEST(line_ends) {
    static const char* const files[] = {
        "cube.obj",        "cube.off",    "cube.ply",   "cube_strips.ply", "cube_text.stl",
        "box_1.msh",       "box_22.msh",  "box_40.msh", "box_41.msh",      "box.mesh",
        "box.veg",         "box_30.vtk",  "box_51.vtk", "box_ascii.vtu",   "two_tetrahedra.gltf",
        "cube_little.ply", "cube_big.ply"};
    for (size_t f = 0; f < sizeof files / sizeof *files; ++f) {
        bytes file = read_file(VOX_TEST_DATA, files[f]);
        ck_assert_ptr_nonnull(file.data);
        const char* header = strstr((const char*)file.data, "end_header\n");
        const size_t last = header && strstr(files[f], "_") && !strstr(files[f], "strips")
                                ? (size_t)(header - (const char*)file.data) + 11
                                : file.size;
        vox_io_mesh* mesh = read_bytes(files[f], file.data, file.size, all_meshes);
        for (int way = 0; way < 2; ++way) {
            bytes other = with_line_ends(&file, way ? "\r" : "\r\n", last);
            vox_io_mesh* again = read_bytes(files[f], other.data, other.size, all_meshes);
            check_same(mesh, again);
            vox_io_mesh_destroy(again);
            free(other.data);
        }
        vox_io_mesh_destroy(mesh);
        free(file.data);
    }
    bytes node = read_file(VOX_TEST_DATA, "box.node"), ele = read_file(VOX_TEST_DATA, "box.ele");
    bytes dos_node = with_line_ends(&node, "\r\n", node.size),
          dos_ele = with_line_ends(&ele, "\r\n", ele.size);
    const vox_io_source sources[2] = {{"b.node", dos_node.data, dos_node.size},
                                      {"b.ele", dos_ele.data, dos_ele.size}};
    vox_io_mesh* mesh = NULL;
    ck_ok(vox_io_read(sources, 2, NULL, &mesh));
    ck_assert_uint_eq(report_of(mesh).tets, 10);
    vox_io_mesh_destroy(mesh);
    free(node.data);
    free(ele.data);
    free(dos_node.data);
    free(dos_ele.data);
}
END_TEST

/* A binary PLY whose lines end in "\r" and whose first byte of data is a line feed, or the other way round.
 */
START_TEST(first_byte_of_binary_data) {
    static const char* const ends[] = {"\n", "\r", "\r\n"};
    for (int e = 0; e < 3; ++e) {
        char data[512];
        const char* const n = ends[e];
        const int head =
            snprintf(data, sizeof data,
                     "ply%sformat binary_little_endian 1.0%selement vertex 3%sproperty char x%sproperty "
                     "char y%sproperty char z%selement face 1%sproperty list char char vertex_index%s"
                     "end_header%s",
                     n, n, n, n, n, n, n, n, n);
        memcpy(data + head, "\n\0\0\1\0\0\0\1\0\3\0\1\2", 13);
        vox_io_mesh* mesh = read_bytes("first", data, (size_t)head + 13, all_meshes);
        ck_assert_double_eq(report_of(mesh).bounds_max[0], 10);
        vox_io_mesh_destroy(mesh);
    }
}
END_TEST

/* Without a name to go by. */
START_TEST(content_alone) {
    static const char* const files[] = {"cube.ply",          "cube_big.ply", "cube.stl",
                                        "cube_text.stl",     "cube.off",     "two_tetrahedra.gltf",
                                        "two_tetrahedra.glb"};
    for (size_t f = 0; f < sizeof files / sizeof *files; ++f) {
        bytes file = read_file(VOX_TEST_DATA, files[f]);
        vox_io_mesh* named = read_bytes(files[f], file.data, file.size, all_meshes);
        vox_io_mesh* mesh = read_bytes(NULL, file.data, file.size, all_meshes);
        check_same(named, mesh);
        ck_assert_int_eq(report_of(mesh).format, VOX_IO_FORMAT_SURFACE);
        vox_io_mesh_destroy(named);
        vox_io_mesh_destroy(mesh);
        free(file.data);
    }
}
END_TEST

#define THREE "v 0 0 0\nv 1 0 0\nv 0 1 0\n"

START_TEST(obj) {
    vox_io_mesh* mesh =
        read_text("a.obj", "mtllib x.mtl\r\nvn 0 0 1\nvt 0 0\nv 0 0 0 1 0 0\nv 2 0 0 2\nv 0 1 0 1.0\n"
                           "s off\nf -3/1/1 -2//1 \\\n -1/1\nl 1 2\np 1\nvp 0.5\nf 1 2\n");
    const vox_io_report report = report_of(mesh);
    ck_assert_uint_eq(report.triangles, 1);
    ck_assert_uint_eq(report.skipped_elements, 3);
    ck_assert_double_eq(report.bounds_max[0], 1); /* 2 by its weight 2 */
    vox_io_mesh_destroy(mesh);

    /* Lines that are continued, also before each number of a vertex. */
    mesh = read_text("a.obj", THREE "f 1 2 3\n");
    vox_io_mesh* again =
        read_text("a.obj", "v 0 0 \\\n0\nv \\\r\n 2 0 0 \\\n 2 \\\n\nv 0 \\\n\\\n1 0 1 0 \\\n 0\n"
                           "vn 0 \\\n 0 1\nf \\\n 1 \\\n 2 3 \\\n\n");
    check_same(mesh, again);
    vox_io_mesh_destroy(mesh);
    vox_io_mesh_destroy(again);
    refused("a.obj", "v 0 0 \\\n\n", VOX_ERROR_FORMAT,
            "line 2: expected a coordinate, found the end of the line");
    refused("a.obj", "v 0 0 \\ 1\n", VOX_ERROR_FORMAT, "line 2: expected a coordinate");

    static const char parts[] =
        THREE "v 0 0 1\no a\nf 1 2 3\nusemtl m\nf 1 2 4\nusemtl m\nf 2 3 4\ng x y\nf 1 3 4\n";
    ck_assert_uint_eq(triangles_of("a.obj", parts, 0), 1);
    ck_assert_uint_eq(triangles_of("a.obj", parts, 1), 2);
    ck_assert_uint_eq(triangles_of("a.obj", parts, 2), 1);
    ck_assert_uint_eq(triangles_of("a.obj", parts, all_meshes), 4);

    refused("a.obj", THREE "f 1 2 4\n", VOX_ERROR_FORMAT,
            "a.obj, line 4: expected a vertex number from 1 to 3");
    refused("a.obj", THREE "f 1 2 -4\n", VOX_ERROR_FORMAT, "of the vertices above, found -4");
    refused("a.obj", THREE "f 0 1 2\n", VOX_ERROR_FORMAT, "line 4");
    refused("a.obj", THREE "f 1 2 3x\n", VOX_ERROR_FORMAT, "expected a vertex number, found \"3x\"");
    refused("a.obj", THREE "f 1 2 99999999999999999999\n", VOX_ERROR_FORMAT, "line 4");
    refused("a.obj", "v 0 0\n", VOX_ERROR_FORMAT, "line 1: expected a coordinate, found the end of the line");
    refused("a.obj", "v 0 0 nan\n", VOX_ERROR_FORMAT, "line 1: expected a finite number");
    refused("a.obj", "v 0 0 1e999\n", VOX_ERROR_FORMAT, "out of range");
    refused("a.obj", "v 0 0 1 0\n", VOX_ERROR_FORMAT, "expected a weight");
    refused("a.obj", "v 0 0 0\n7 8\n", VOX_ERROR_FORMAT, "line 2: expected a keyword, found \"7\"");
}
END_TEST

#define FACET "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"

START_TEST(stl) {
    static const char two[] =
        "solid a\n" FACET FACET "endsolid a\nSOLID b\nFacet Normal -nan(ind) 0 0\nOUTER LOOP\n"
        "vertex 0 0 0\nVERTEX 1e0 0 0\nvertex 0 0 1\nendLoop\nendfacet\nENDSOLID\n";
    ck_assert_uint_eq(triangles_of("a.stl", two, 0), 2);
    ck_assert_uint_eq(triangles_of("a.stl", two, 1), 1);
    ck_assert_uint_eq(triangles_of("a.stl", two, all_meshes), 3);
    ck_assert_uint_eq(triangles_of(NULL, two, all_meshes), 3);
    ck_assert_uint_eq(triangles_of(NULL, "SOLID A\n" FACET "ENDSOLID A\n", all_meshes), 1);
    ck_assert_uint_eq(triangles_of(NULL, "\n Solid\r\n" FACET "endsolid", all_meshes), 1);
    refused("a.stl", "solid a\n" FACET "end", VOX_ERROR_FORMAT,
            "line 9: expected solid, found the end of the file");
    refused("a.stl", "solid a\n" FACET "endsolid\nrest\n", VOX_ERROR_FORMAT,
            "line 10: expected solid, found \"rest\"");
    refused("a.stl", "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 0 0\n", VOX_ERROR_FORMAT,
            "line 6: expected a coord");
    refused("a.stl", "solid\nendsolid\n", VOX_ERROR_FORMAT, "expected triangles, found none");
    refused("a.stl", "triangles", VOX_ERROR_FORMAT, "a.stl, byte 0: expected 80 bytes (a header)");

    /* A binary file may begin with "solid" as well. */
    bytes file = read_file(VOX_TEST_DATA, "cube.stl");
    memcpy(file.data, "solid cube", 10);
    vox_io_mesh* mesh = read_bytes("a.stl", file.data, file.size, all_meshes);
    ck_assert_uint_eq(report_of(mesh).triangles, 12);
    vox_io_mesh* same = NULL;
    static const char* const headers[] = {"ply",         "glTF",           "{",     "STOFF",
                                          "$MeshFormat", "# vtk DataFile", "SOLID", "MeshVersionFormatted",
                                          "*VERTICES",   "<VTKFile"};
    for (size_t i = 0; i < 2 * sizeof headers / sizeof *headers; ++i) {
        memset(file.data, ' ', 80);
        memcpy(file.data, headers[i / 2], strlen(headers[i / 2]));
        same = read_bytes(i % 2 ? NULL : "a.stl", file.data, file.size, all_meshes);
        check_same(mesh, same);
        vox_io_mesh_destroy(same);
    }
    vox_io_mesh_destroy(mesh);
    memset(file.data, ' ', 80);
    const vox_io_source cut = {"a.stl", file.data, file.size - 1};
    ck_fails(vox_io_read(&cut, 1, NULL, &mesh), VOX_ERROR_FORMAT,
             "byte 80: number of triangles: 12 are declared");
    const float infinite = INFINITY;
    memcpy(file.data + 84 + 50 + 12 + 16, &infinite, 4);
    const vox_io_source far = {"a.stl", file.data, file.size};
    ck_fails(vox_io_read(&far, 1, NULL, &mesh), VOX_ERROR_FORMAT,
             "byte 162: triangle 1: expected a coordinate");
    free(file.data);
}
END_TEST

#define PLY(points, faces)                                                                                   \
    "ply\nformat ascii 1.0\nelement vertex " points                                                          \
    "\nproperty float x\nproperty float y\nproperty float z\n"                                               \
    "element face " faces "\nproperty list uchar int vertex_indices\nend_header\n"

START_TEST(ply) {
    static const struct {
        const char *text, *words;
    } bad[] = {{PLY("3", "1") "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
                "line 13: expected a vertex number below 3, found 3"},
               {PLY("3", "1") "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "found -1"},
               {PLY("3", "1") "0 0 0\n1 0 0\n0 1 0\n4 0 1 2\n",
                "line 14: expected a vertex number, found the end of the file"},
               {PLY("3", "1") "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 2\n", "line 13: expected the end of the file"},
               {PLY("3", "1") "0 0 0\n1 0\n0 1 0\n3 0 1 2\n",
                "line 13: expected the end of the file after the last element, found \"1\""},
               {PLY("3", "1") "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n7\n", "line 14: expected the end of the file"},
               {PLY("30", "1") "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
                "line 3: number of elements vertex: 30 are declared"},
               {PLY("-3", "1") "", "line 3: expected a number of elements, found \"-3\""},
               {"ply\nformat ascii 2.0\n", "line 2: expected version 1.0"},
               {"ply\nformat ascii 1.0\nelement vertex 1\nproperty long x\n", "line 4: expected a type"},
               {"ply\nformat ascii 1.0\nelement face 1\nproperty list float int vertex_index\n",
                "expected an integer type"},
               {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n",
                "expected a property y"},
               {"ply\nformat ascii 1.0\nelement face 1\nproperty int a\nend_header\n0\n",
                "list of integers vertex_ind"},
               {"ply\nformat ascii 1.0\nwhat 1\n", "line 3: expected element, property"},
               {"ply\nformat ascii 1.0\n",
                "expected element, property, comment or end_header, found the end of the file"}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i)
        refused("a.ply", bad[i].text, VOX_ERROR_FORMAT, bad[i].words);
#define VERTEX "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
    refused("a.ply", "ply\nformat ascii 1.0\n" VERTEX VERTEX "end_header\n0 0 0\n1 1 1\n", VOX_ERROR_FORMAT,
            "line 7: expected one element vertex, found another");
    refused("a.ply", "ply\nformat binary 1.0\n", VOX_ERROR_UNSUPPORTED, "line 2: format binary");
    ck_assert_uint_eq(triangles_of("a", PLY("3", "2") "0 0 0\n1 0 0\n0 1 0\n2 0 1\n3 0 1 2", 0), 1);
}
END_TEST

/* A polygon that is not convex is cut so that the triangles cover it and nothing else. */
START_TEST(polygons) {
    static const struct {
        const char* text;
        double area;
        uint64_t triangles;
    } rows[] = {
        {"v 0 0 5\nv 4 0 5\nv 1 1 5\nv 0 4 5\nf 1 2 3 4\n", 4, 2}, /* an arrow, from each of its corners */
        {"v 0 0 5\nv 4 0 5\nv 1 1 5\nv 0 4 5\nf 2 3 4 1\n", 4, 2},
        {"v 0 0 5\nv 4 0 5\nv 1 1 5\nv 0 4 5\nf 3 4 1 2\n", 4, 2},
        {"v 0 0 5\nv 4 0 5\nv 1 1 5\nv 0 4 5\nf 4 3 2 1\n", 4, 2}, /* the other way round */
        {"v 0 0 0\nv 0 3 0\nv 0 3 1\nv 0 1 1\nv 0 1 3\nv 0 0 3\nf 1 2 3 4 5 6\n", 5, 4}, /* an L */
        {"v 0 0 0\nv 3 0 0\nv 3 0 3\nv 2 0 3\nv 2 0 1\nv 1 0 1\nv 1 0 3\nv 0 0 3\nf 1 2 3 4 5 6 7 8\n", 7, 6},
        {"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", 1, 2}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        vox_io_mesh* mesh = read_text("a.obj", rows[i].text);
        vox_io_mesh_view view;
        ck_ok(vox_io_mesh_get_arrays(mesh, &view));
        ck_assert_uint_eq(view.triangle_count, rows[i].triangles);
        double sum = 0;
        for (uint64_t t = 0; t < view.triangle_count; ++t) {
            double e[2][3];
            for (int k = 0; k < 3; ++k)
                for (int j = 0; j < 2; ++j)
                    e[j][k] = view.positions[3 * view.triangles[3 * t + 1 + j] + k] -
                              view.positions[3 * view.triangles[3 * t] + k];
            const double n[3] = {e[0][1] * e[1][2] - e[0][2] * e[1][1], e[0][2] * e[1][0] - e[0][0] * e[1][2],
                                 e[0][0] * e[1][1] - e[0][1] * e[1][0]};
            sum += sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
        }
        ck_assert_msg(close_to(sum, rows[i].area, 1e-12), "polygon %zu has area %g, not %g", i, sum,
                      rows[i].area);
        ck_assert_uint_eq(report_of(mesh).misoriented_edges, 0);
        vox_io_mesh_destroy(mesh);
    }
}
END_TEST

#define GLTF(more)                                                                                           \
    "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}]," more "}"
#define GLTF_TRIANGLE(uri, primitive)                                                                        \
    GLTF("\"meshes\":[{\"primitives\":[" primitive                                                           \
         "]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"                                      \
         "\"count\":3,\"type\":\"VEC3\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{" \
         "\"byteLength\":36,\"uri\":\"" uri "\"}]")
#define GLTF_DATA "data:application/gltf-buffer;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"
#define GLTF_FACE "{\"attributes\":{\"POSITION\":0}}"

START_TEST(gltf) {
    ck_assert_uint_eq(triangles_of("a.gltf", GLTF_TRIANGLE(GLTF_DATA, GLTF_FACE), 0), 1);
    ck_assert_uint_eq(
        triangles_of("a",
                     GLTF_TRIANGLE("data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA",
                                   GLTF_FACE "," GLTF_FACE),
                     1),
        1);
    static const struct {
        const char *text, *words;
    } bad[] = {
        {"{\"asset\":{\"version\":\"2.0\"}}", "expected triangles, found none"},
        {"{\"scenes\":[{}]}", "expected asset.version, found none"},
        {GLTF("\"meshes\":[]"), "expected the number of a mesh below 0, found 0"},
        {GLTF("\"meshes\":[,]"),
         "line 1: expected JSON, found this: syntax error while parsing value - unexpected ','"},
        {GLTF("\"extras\":tru"), "line 1: expected JSON, found this: syntax error while parsing value - "
                                 "invalid literal; last read: '\"extras\":tru}"},
        {GLTF("\"extras\":\"\1\""), "control character"},
        {"{\n\"asset\":\n{\"version\":2}}", "a.gltf: asset.version: expected a version, found 2"},
        {"{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{}]} x", "expected end of input"},
        {"{\n\"asset\":\n{]}", "a.gltf, line 3: expected JSON"},
        {"[]", "a.gltf: expected an object, found an array"},
        {"{\"nodes\":5}", "nodes: expected an array, found 5"},
        {"{\"nodes\":[{},{\"mesh\":[1]}]}", "nodes[1].mesh: expected the number of a mesh, found an array"},
        {"{\"nodes\":[{\"children\":[0,1.5]}]}",
         "nodes[0].children[1]: expected the number of a node, found 1.5"},
        {"{\"nodes\":[{\"scale\":[1,2]}]}", "nodes[0].scale: expected 3 numbers, found 2"},
        {"{\"nodes[].mesh\":0,\"nodes[]\":{\"mesh\":0}}", "expected asset.version, found none"},
        {"{\"accessors\":[{\"count\":1e999}]}", "number overflow parsing '1e999'"},
        {GLTF_TRIANGLE("data:text/plain,x", GLTF_FACE), "expected data in base64"},
        {GLTF_TRIANGLE("data:;base64,AAAA", GLTF_FACE),
         "accessor 0: its buffer view has bytes 0 to 36 of buffer 0, which has 3"},
        {GLTF_TRIANGLE("data:;base64,A*AA", GLTF_FACE), "buffers[0].uri: expected base64 text, found \"*\""},
        {GLTF_TRIANGLE(GLTF_DATA, "{\"attributes\":{\"POSITION\":1}}"),
         "expected the number of an accessor below 1, found 1"},
        {GLTF_TRIANGLE(GLTF_DATA, "{\"mode\":7,\"attributes\":{\"POSITION\":0}}"),
         "expected a mode from 0 to 6, found 7"},
        {GLTF_TRIANGLE(GLTF_DATA, "{\"attributes\":{\"POSITION\":-1}}"),
         "meshes[0].primitives[0].attributes.POSITION: expected the number of an accessor, found -1"},
        {GLTF_TRIANGLE(GLTF_DATA, "{\"indices\":0,\"attributes\":{\"POSITION\":0}}"),
         "expected indices, unsigned SCALAR"},
        {GLTF_TRIANGLE("data.bin", GLTF_FACE),
         "a buffer is in another file, data.bin: load this one by its path"}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i)
        refused("a.gltf", bad[i].text, VOX_ERROR_FORMAT, bad[i].words);
    refused("a.gltf", "{\"asset\":{\"version\":\"1.0\"}}", VOX_ERROR_UNSUPPORTED,
            "version 1.0: version 2 is read");
    refused("a.gltf", GLTF("\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]"), VOX_ERROR_UNSUPPORTED,
            "KHR_draco_mesh_compression is required and not read");
}
END_TEST

#ifdef __unix__

static char folder[] = "/tmp/vox_test_io_XXXXXX";

static const char* in_folder(const char* name) {
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void write_file(const char* name, const void* data, size_t size) {
    FILE* file = fopen(in_folder(name), "wb");
    ck_assert_ptr_nonnull(file);
    ck_assert_uint_eq(fwrite(data, 1, size, file), size);
    fclose(file);
}

/* A scene may name files in its folder or below; no other file is opened, and no pipe, which would wait. */
START_TEST(files_beside) {
    static const float triangle[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const struct {
        const char* text;
        vox_result result;
        const char* words;
    } rows[] = {{GLTF_TRIANGLE("a b.bin", GLTF_FACE), VOX_OK, ""},
                {GLTF_TRIANGLE("a%20b.bin", GLTF_FACE), VOX_OK, ""},
                {GLTF_TRIANGLE("\\u0061 b\\u002ebin", GLTF_FACE), VOX_OK, ""},
                {GLTF_TRIANGLE("./below/c.bin", GLTF_FACE), VOX_OK, ""},
                {GLTF_TRIANGLE("below/../a b.bin", GLTF_FACE), VOX_OK, ""},
                {GLTF_TRIANGLE("missing.bin", GLTF_FACE), VOX_ERROR_FILE, "scene.gltf: No such file"},
                {GLTF_TRIANGLE("below", GLTF_FACE), VOX_ERROR_FILE, "not a regular file"},
                {GLTF_TRIANGLE("pipe", GLTF_FACE), VOX_ERROR_FILE, "not a regular file"},
                {GLTF_TRIANGLE("/etc/passwd", GLTF_FACE), VOX_ERROR_UNSUPPORTED,
                 "only files in the same folder or below"},
                {GLTF_TRIANGLE("../a b.bin", GLTF_FACE), VOX_ERROR_UNSUPPORTED,
                 "only files in the same folder or below"},
                {GLTF_TRIANGLE("below/%2e%2e/../x.bin", GLTF_FACE), VOX_ERROR_UNSUPPORTED,
                 "only files in the same folder"},
                {GLTF_TRIANGLE("file:///etc/passwd", GLTF_FACE), VOX_ERROR_UNSUPPORTED,
                 "only files in the same folder"},
                {GLTF_TRIANGLE("", GLTF_FACE), VOX_ERROR_UNSUPPORTED, "only files in the same folder"}};
    ck_assert_ptr_nonnull(mkdtemp(folder));
    ck_assert_int_eq(mkdir(in_folder("below"), 0700), 0);
    ck_assert_int_eq(mkfifo(in_folder("pipe"), 0600), 0);
    write_file("a b.bin", triangle, sizeof triangle);
    write_file("below/c.bin", triangle, sizeof triangle);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        write_file("scene.gltf", rows[i].text, strlen(rows[i].text));
        vox_io_mesh* mesh = NULL;
        if (rows[i].result == VOX_OK) {
            ck_ok(vox_io_load(in_folder("scene.gltf"), NULL, &mesh));
            ck_assert_uint_eq(report_of(mesh).triangles, 1);
            vox_io_mesh_destroy(mesh);
        } else {
            ck_fails(vox_io_load(in_folder("scene.gltf"), NULL, &mesh), rows[i].result, rows[i].words);
        }
    }
    /* A path of millions of parts would take far more memory than its text. */
    static char parts[2][2000001];
    for (size_t i = 0; i < 2000000; i += 2) memcpy(parts[0] + i, "a/", 2);
    const int length = snprintf(parts[1], sizeof parts[1], GLTF_TRIANGLE("%.1990000s", GLTF_FACE), parts[0]);
    write_file("scene.gltf", parts[1], (size_t)length);
    vox_io_mesh* mesh = NULL;
    ck_fails(vox_io_load(in_folder("scene.gltf"), NULL, &mesh), VOX_ERROR_LIMIT,
             "whose name has 1990000 bytes, more than the limit of 4096");
    static const char* const made[] = {"scene.gltf", "a b.bin", "below/c.bin", "pipe"};
    for (size_t i = 0; i < sizeof made / sizeof *made; ++i) unlink(in_folder(made[i]));
    rmdir(in_folder("below"));
    rmdir(folder);
}
END_TEST

#endif

/* What only assimp reads is refused until it is asked for by name. */
START_TEST(assimp) {
    static const char ac[] =
        "AC3Db\nMATERIAL \"m\" rgb 1 1 1 amb 0 0 0 emis 0 0 0 spec 0 0 0 shi 0 trans 0\nOBJECT world\n"
        "kids 1\nOBJECT poly\nnumvert 3\n0 0 0\n1 0 0\n0 1 0\nnumsurf 1\nSURF 0x0\nmat 0\nrefs 3\n"
        "0 0 0\n1 0 0\n2 0 0\nkids 0\n";
    refused("a.ac", ac, VOX_ERROR_UNSUPPORTED, "neither known content nor a known extension");
    refused("ogre.mesh", "\x10[MeshSerializer_v1.40]\n", VOX_ERROR_UNSUPPORTED, "neither known content");
    const vox_io_source source = {"a.ac", ac, sizeof ac - 1};
    vox_io_load_desc desc = vox_default_io_load_desc();
    vox_io_mesh* mesh = NULL;
    desc.format = VOX_IO_FORMAT_SURFACE;
    ck_fails(vox_io_read(&source, 1, &desc, &mesh), VOX_ERROR_UNSUPPORTED, "expected a surface");
    desc.format = VOX_IO_FORMAT_ASSIMP;
#ifdef VOX_TEST_ASSIMP
    ck_ok(vox_io_read(&source, 1, &desc, &mesh));
    ck_assert_uint_eq(report_of(mesh).triangles, 1);
    ck_assert_int_eq(report_of(mesh).format, VOX_IO_FORMAT_ASSIMP);
    vox_io_mesh_destroy(mesh);
    const vox_io_source unknown = {"a.xyzw", "nothing", 7};
    ck_fails(vox_io_read(&unknown, 1, &desc, &mesh), VOX_ERROR_UNSUPPORTED, "that assimp reads");

    /* It finds the same as our own readers. */
    static const char* const files[] = {"cube.obj", "cube.ply",      "cube_big.ply",
                                        "cube.stl", "cube_text.stl", "two_tetrahedra.gltf"};
    for (size_t f = 0; f < sizeof files / sizeof *files; ++f) {
        char path[1024];
        snprintf(path, sizeof path, "%s/%s", VOX_TEST_DATA, files[f]);
        vox_io_mesh *own = NULL, *other = NULL;
        ck_ok(vox_io_load(path, NULL, &own));
        ck_ok(vox_io_load(path, &desc, &other));
        check_same(own, other);
        vox_io_mesh_destroy(own);
        vox_io_mesh_destroy(other);
    }
#else
    ck_fails(vox_io_read(&source, 1, &desc, &mesh), VOX_ERROR_UNSUPPORTED, "VOX_IO_ASSIMP");
#endif
}
END_TEST

SUITE(io_surfaces) {
    TCase* tests = add_case(suite, "surfaces");
    tcase_add_each(tests, points_alone, line_ends, first_byte_of_binary_data, content_alone, obj, stl, ply,
                   polygons, gltf, assimp);
#ifdef __unix__
    tcase_add_test(tests, files_beside);
#endif
}
