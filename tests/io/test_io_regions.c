/* A number for each tet: from every format that has some, and through what is written. */
#include "support/io_files.h"

#define NODES "$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n$EndNodes\n"
#define VTK                                                                                                  \
    "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n"                     \
    "0 0 0 1 0 0 0 1 0 0 0 1 1 1 1\nCELLS 4 18\n3 0 1 2\n4 0 1 2 3\n4 4 1 2 3\n3 4 1 2\nCELL_TYPES 4\n5 10 " \
    "10 5\n"
#define VTU(data)                                                                                            \
    "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"5\" NumberOfCells=\"3\">"  \
    "<CellData>" data "</CellData>"                                                                          \
    "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\">0 0 0 1 0 0 0 1 0 0 0 1 1 1 1</DataArray>" \
    "</Points><Cells><DataArray type=\"Int64\" Name=\"connectivity\">0 1 2 0 1 2 3 4 1 2 3</DataArray>"      \
    "<DataArray type=\"Int64\" Name=\"offsets\">3 7 11</DataArray>"                                          \
    "<DataArray type=\"UInt8\" Name=\"types\">5 10 "                                                         \
    "10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>"
#define ARRAY(name, type, values) "<DataArray type=\"" type "\" Name=\"" name "\">" values "</DataArray>"

/* Each file has two tets. */
static const struct {
    const char *name, *text, *second;
    int32_t regions[2]; /* 0, 0: none */
} files[] = {
    {"1.msh",
     "$NOD\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n$ENDNOD\n$ELM\n2\n1 4 7 1 4 1 2 3 4\n"
     "2 4 -3 1 4 5 2 3 4\n$ENDELM\n",
     NULL,
     {7, -3}},
    {"2.msh",
     "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" NODES
     "$Elements\n3\n1 2 2 9 1 1 2 3\n2 4 2 7 1 1 2 3 4\n3 4 2 12 2 5 2 3 4\n$EndElements\n",
     NULL,
     {7, 12}},
    {"2 without tags.msh",
     "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" NODES
     "$Elements\n2\n1 4 0 1 2 3 4\n2 4 0 5 2 3 4\n$EndElements\n",
     NULL,
     {0, 0}},
    /* Entity 5 is in the groups 30 and 31, entity 6 in none; surface 5 is in group 99. */
    {"4.1.msh",
     "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n1 1 1 2\n1 0 0 0 1 50\n1 0 0 0 1 0 0 0 2 1 -1\n"
     "5 0 0 0 1 1 0 1 99 1 1\n5 0 0 0 1 1 1 2 30 31 1 5\n6 0 0 0 1 1 1 0 0\n$EndEntities\n"
     "$Nodes\n1 5 1 5\n3 5 0 5\n1\n2\n3\n4\n5\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n$EndNodes\n"
     "$Elements\n2 2 1 2\n3 6 4 1\n1 1 2 3 4\n3 5 4 1\n2 5 2 3 4\n$EndElements\n",
     NULL,
     {0, 30}},
    {"4.0.msh",
     "$MeshFormat\n4 0 8\n$EndMeshFormat\n$Entities\n1 0 0 2\n1 0 0 0 0 0 0 0\n5 0 0 0 1 1 1 1 30 0\n"
     "6 0 0 0 1 1 1 1 8 1 5\n$EndEntities\n$Nodes\n1 5\n5 3 0 5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 "
     "1\n"
     "$EndNodes\n$Elements\n2 2\n6 3 4 1\n1 1 2 3 4\n5 3 4 1\n2 5 2 3 4\n$EndElements\n",
     NULL,
     {8, 30}},
    {"a.mesh",
     "MeshVersionFormatted 2\nDimension 3\nVertices\n5\n0 0 0 4 1 0 0 4 0 1 0 4 0 0 1 4 1 1 1 4\n"
     "Triangles\n1\n1 2 3 9\nTetrahedra\n2\n1 2 3 4 3\n5 2 3 4 0\nEnd\n",
     NULL,
     {3, 0}},
    {"a.node",
     "5 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n",
     "2 4 2\n1 1 2 3 4 0.5 3.0\n2 5 2 3 4 0.5 -4\n",
     {3, -4}},
    {"first whole.vtk",
     VTK "POINT_DATA 5\nSCALARS region int 1\nLOOKUP_TABLE default\n1 2 3 4 5\nCELL_DATA 4\n"
         "SCALARS stress double 1\nLOOKUP_TABLE default\n1 2 3 4\nVECTORS v float\n"
         "0 0 0 0 0 0 0 0 0 0 0 0\nSCALARS part int\nLOOKUP_TABLE default\n9 6 7 9\n",
     NULL,
     {6, 7}},
    {"named.vtk",
     VTK "CELL_DATA 4\nFIELD FieldData 3\nids 1 4 int\n1 2 3 4\nwords 1 4 string\na b c d\n"
         "MaterialIDs 1 4 double\n9 2 1 9\n",
     NULL,
     {2, 1}},
    {"damaged.vtk", VTK "CELL_DATA 4\nSCALARS part int\nLOOKUP_TABLE default\n9 6\n", NULL, {0, 0}},
    {"first whole.vtu",
     VTU(ARRAY("stress", "Float64", "1 2 3") ARRAY("part", "Int8", "9 6 7")),
     NULL,
     {6, 7}},
    {"named.vtu",
     VTU(ARRAY("part", "Int64", "9 6 7") ARRAY("gmsh:physical", "Float32", "0 -1 1")),
     NULL,
     {-1, 1}},
    {"not whole.vtu",
     VTU(ARRAY("region", "Float64", "1 2.5 3") ARRAY("r", "Int64", "1 3000000000 1")),
     NULL,
     {0, 0}},
    {"damaged.vtu", VTU(ARRAY("region", "Int64", "1 x 3")), NULL, {0, 0}}};

static void check_regions(const vox_io_mesh* mesh, const int32_t regions[2], const char* name) {
    vox_io_mesh_view view;
    ck_ok(vox_io_mesh_get_arrays(mesh, &view));
    ck_assert_uint_eq(view.tet_count, 2);
    ck_assert_msg((view.tet_regions != NULL) == (regions[0] || regions[1]), "%s", name);
    if (!view.tet_regions) return;
    ck_assert_msg(memcmp(view.tet_regions, regions, 8) == 0, "%s: %d %d", name, view.tet_regions[0],
                  view.tet_regions[1]);
}

START_TEST(read_regions) {
    const char* const second = files[_i].second;
    const vox_io_source sources[2] = {{files[_i].name, files[_i].text, strlen(files[_i].text)},
                                      {"a.ele", second, second ? strlen(second) : 0}};
    vox_io_mesh* mesh = NULL;
    ck_ok(vox_io_read(sources, second ? 2 : 1, NULL, &mesh));
    check_sound(mesh);
    check_regions(mesh, files[_i].regions, files[_i].name);
    vox_io_mesh_destroy(mesh);
}
END_TEST

typedef struct text {
    char* bytes;
    size_t size;
} text;

static int32_t append(const void* data, size_t size, void* user) {
    text* to = (text*)user;
    to->bytes = (char*)realloc(to->bytes, to->size + size + 1);
    memcpy(to->bytes + to->size, data, size);
    to->size += size;
    to->bytes[to->size] = 0;
    return 0;
}

/* Writes and reads again, each way, with triangles and without. The order of the tets stays. */
START_TEST(written_regions) {
    static const double positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
    static const uint32_t tets[] = {0, 1, 2, 3, 4, 1, 2, 3, 0, 1, 2, 3, 4, 1, 2, 3}, triangle[] = {0, 1, 2};
    static const int32_t regions[] = {40, -2, 0, 40};
    const vox_io_mesh_view arrays = {positions, 5, tets, 4, triangle, (uint64_t)_i % 2, regions, NULL, NULL};
    vox_io_mesh *mesh = NULL, *again = NULL;
    ck_ok(vox_io_mesh_create(&arrays, &mesh));
    vox_io_write_desc desc = vox_default_io_write_desc();
    desc.format = (vox_io_write_format)(1 + _i / 4);
    desc.binary = _i / 2 % 2;
    text file = {NULL, 0};
    const vox_io_sink sink = {append, &file};
    ck_ok(vox_io_write_to(mesh, &desc, &sink));
    const vox_io_source source = {"written", file.bytes, file.size};
    ck_ok(vox_io_read(&source, 1, NULL, &again));
    check_same(mesh, again);
    vox_io_mesh_view view;
    ck_ok(vox_io_mesh_get_arrays(again, &view));
    ck_assert_ptr_nonnull(view.tet_regions);
    ck_assert_mem_eq(view.tet_regions, regions, sizeof regions);
    free(file.bytes);
    vox_io_mesh_destroy(mesh);
    vox_io_mesh_destroy(again);
}
END_TEST

/* Cell data of the name that regions have stands in their place. */
START_TEST(own_cell_data) {
    static const double positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, own[] = {5};
    static const uint32_t tet[] = {0, 1, 2, 3};
    static const int32_t regions[] = {3};
    const vox_io_mesh_view arrays = {positions, 4, tet, 1, NULL, 0, regions, NULL, NULL};
    const vox_io_point_data data = {"region", own, 1, 0};
    vox_io_mesh *mesh = NULL, *again = NULL;
    ck_ok(vox_io_mesh_create(&arrays, &mesh));
    vox_io_write_desc desc = vox_default_io_write_desc();
    desc.format = VOX_IO_WRITE_VTU;
    desc.cell_data = &data;
    desc.cell_data_count = 1;
    text file = {NULL, 0};
    const vox_io_sink sink = {append, &file};
    ck_ok(vox_io_write_to(mesh, &desc, &sink));
    ck_assert_ptr_null(strstr(strstr(file.bytes, "\"region\"") + 1, "\"region\""));
    const vox_io_source source = {"written", file.bytes, file.size};
    ck_ok(vox_io_read(&source, 1, NULL, &again));
    vox_io_mesh_view view;
    ck_ok(vox_io_mesh_get_arrays(again, &view));
    ck_assert_int_eq(view.tet_regions[0], 5);
    free(file.bytes);
    vox_io_mesh_destroy(mesh);
    vox_io_mesh_destroy(again);
}
END_TEST

SUITE(io_regions) {
    TCase* tests = add_case(suite, "regions");
    tcase_add_loop_test(tests, read_regions, 0, (int)(sizeof files / sizeof *files));
    tcase_add_loop_test(tests, written_regions, 0, 12);
    tcase_add_test(tests, own_cell_data);
}
