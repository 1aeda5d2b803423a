/* Vertices of a file that belong to no tet are left out, in every format, unless the caller keeps them. */
#include "support/io_files.h"

/* Six points: one of the geometry, the corners of a tet, and one of a triangle beside it. */
#define POINTS(sep) "9 9 9" sep "0 0 0" sep "1 0 0" sep "0 1 0" sep "0 0 1" sep "5 5 5"

static const struct {
    const char *name, *text, *second;
    int triangles; /* that the format keeps: of the tet, and with the last point */
} files[] = {
    {"a.msh",
     "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 9 9 9\n2 0 0 0\n3 1 0 0\n4 0 1 0\n5 0 0 1\n6 5 5 5\n"
     "$EndNodes\n$Elements\n4\n1 15 2 0 1 1\n2 2 2 0 1 2 3 6\n3 2 2 0 1 4 3 2\n4 4 2 0 1 2 3 4 "
     "5\n$EndElements\n",
     NULL, 2},
    {"a.node", "6 3 0 0\n1 9 9 9\n2 0 0 0\n3 1 0 0\n4 0 1 0\n5 0 0 1\n6 5 5 5\n", "1 4 0\n1 2 3 4 5\n", 0},
    {"a.mesh",
     "MeshVersionFormatted 2\nDimension 3\nVertices\n6\n9 9 9 0 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 0 5 5 5 0\n"
     "Triangles\n2\n2 3 6 0\n4 3 2 0\nTetrahedra\n1\n2 3 4 5 0\nEnd\n",
     NULL, 2},
    {"a.veg",
     "*VERTICES\n6 3 0 0\n1 9 9 9\n2 0 0 0\n3 1 0 0\n4 0 1 0\n5 0 0 1\n6 5 5 5\n*ELEMENTS\nTET\n1 4 0\n1 2 3 "
     "4 5\n",
     NULL, 0},
    {"a.vtk",
     "# vtk DataFile Version 2.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 double\n" POINTS(
         "\n") "\nCELLS 4 15\n"
               "1 0\n3 1 2 5\n3 3 2 1\n4 1 2 3 4\nCELL_TYPES 4\n1\n5\n5\n10\n",
     NULL, 2},
    {"a.vtu",
     "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"6\" NumberOfCells=\"3\">"
     "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\">" POINTS(
         " ") "</DataArray></Points><Cells>"
              "<DataArray type=\"Int64\" Name=\"connectivity\">1 2 5 3 2 1 1 2 3 4</DataArray>"
              "<DataArray type=\"Int64\" Name=\"offsets\">3 6 10</DataArray>"
              "<DataArray type=\"UInt8\" Name=\"types\">5 5 "
              "10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>",
     NULL, 2}};

static vox_io_mesh* load(int file, uint32_t flags) {
    const vox_io_source sources[2] = {
        {files[file].name, files[file].text, strlen(files[file].text)},
        {"a.ele", files[file].second, files[file].second ? strlen(files[file].second) : 0}};
    vox_io_load_desc desc = vox_default_io_load_desc();
    desc.flags = flags;
    vox_io_mesh* mesh = NULL;
    ck_ok(vox_io_read(sources, files[file].second ? 2 : 1, &desc, &mesh));
    check_sound(mesh);
    return mesh;
}

START_TEST(left_out) {
    static const uint32_t tet[] = {0, 1, 2, 3}, triangle[] = {2, 1, 0}, numbers[] = {1, 2, 3, 4};
    static const double corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    vox_io_mesh* mesh = load(_i, 0);
    vox_io_mesh_view view;
    ck_ok(vox_io_mesh_get_arrays(mesh, &view));
    ck_assert_uint_eq(view.vertex_count, 4);
    ck_assert_mem_eq(view.positions, corners, sizeof corners);
    ck_assert_mem_eq(view.tets, tet, sizeof tet);
    ck_assert_mem_eq(view.file_vertices, numbers, sizeof numbers);
    ck_assert_uint_eq(view.triangle_count, files[_i].triangles / 2);
    if (view.triangle_count) ck_assert_mem_eq(view.triangles, triangle, sizeof triangle);
    const vox_io_report report = report_of(mesh);
    ck_assert_uint_eq(report.left_out_vertices, 2);
    ck_assert_uint_eq(report.left_out_triangles, files[_i].triangles / 2);
    ck_assert_uint_eq(report.unused_vertices, 0);
    const char* const warnings = vox_io_mesh_get_warnings(mesh);
    ck_assert_ptr_nonnull(strstr(warnings, "2 vertices belong to no tet and were left out\n"));
    ck_assert_int_eq(strstr(warnings, "1 triangle has such a vertex") != NULL, files[_i].triangles > 0);
    vox_io_mesh_destroy(mesh);
}
END_TEST

START_TEST(kept) {
    vox_io_mesh* mesh = load(_i, VOX_IO_LOAD_KEEP_UNUSED);
    vox_io_mesh_view view;
    ck_ok(vox_io_mesh_get_arrays(mesh, &view));
    ck_assert_uint_eq(view.vertex_count, 6);
    ck_assert_uint_eq(view.tets[0], 1);
    ck_assert_uint_eq(view.triangle_count, files[_i].triangles);
    ck_assert_ptr_null(view.file_vertices);
    const vox_io_report report = report_of(mesh);
    ck_assert_uint_eq(report.left_out_vertices + report.left_out_triangles, 0);
    ck_assert_uint_eq(report.unused_vertices, files[_i].triangles ? 1 : 2);
    vox_io_mesh_destroy(mesh);
}
END_TEST

/* The contacts of the mesh with itself at rest, and with a tet around (9, 9, 9). */
static uint64_t contacts_at_rest(const vox_io_mesh* mesh) {
    static const double around[] = {8, 8, 8, 12, 8, 8, 8, 12, 8, 8, 8, 12};
    static const uint32_t tet[] = {0, 1, 2, 3};
    const vox_mesh_desc other = vox_mesh_desc_doubles(around, 4, tet, 1);
    vox_grid* grid = grid_of(NULL);
    vox_mesh_desc desc = vox_default_mesh_desc();
    ck_ok(vox_io_mesh_describe(mesh, &desc));
    desc.filter.flags |= VOX_FILTER_SELF_COLLISION;
    (void)insert_mesh(grid, &desc);
    (void)insert_mesh(grid, &other);
    ck_ok(vox_grid_step(grid));
    const uint64_t count = contacts_of(grid).count;
    vox_grid_destroy(grid);
    return count;
}

START_TEST(contacts) {
    vox_io_mesh* mesh = load(_i, 0);
    ck_assert_uint_eq(contacts_at_rest(mesh), 0);
    vox_io_mesh_destroy(mesh);
    mesh = load(_i, VOX_IO_LOAD_KEEP_UNUSED);
    ck_assert_uint_eq(contacts_at_rest(mesh), 1);
    vox_io_mesh_destroy(mesh);
}
END_TEST

/* Nodes on edges are vertices of no tet: a tet of ten nodes does not touch itself. */
START_TEST(ten_nodes) {
    static const char text[] =
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n1 0 0 0\n2 1 0 0\n3 .5 0 0\n4 0 1 0\n5 .5 .5 0\n6 "
        "0 .5 0\n"
        "7 0 0 1\n8 0 0 .5\n9 .5 0 .5\n10 0 .5 .5\n$EndNodes\n$Elements\n1\n1 11 2 0 1 1 2 4 7 3 5 6 8 10 9\n"
        "$EndElements\n";
    static const uint32_t numbers[] = {0, 1, 3, 6};
    const vox_io_source source = {"b.msh", text, sizeof text - 1};
    vox_io_mesh* mesh = NULL;
    ck_ok(vox_io_read(&source, 1, NULL, &mesh));
    vox_io_mesh_view view;
    ck_ok(vox_io_mesh_get_arrays(mesh, &view));
    ck_assert_uint_eq(view.vertex_count, 4);
    ck_assert_mem_eq(view.file_vertices, numbers, sizeof numbers);
    ck_assert_uint_eq(report_of(mesh).left_out_vertices, 6);
    ck_assert_uint_eq(contacts_at_rest(mesh), 0);
    vox_io_mesh_destroy(mesh);
}
END_TEST

/* Where nothing is left out there is no map, and arrays of the caller's are taken as they are. */
START_TEST(whole_meshes) {
    vox_io_mesh *mesh = NULL, *copy = NULL;
    vox_io_mesh_view view, again;
    ck_ok(vox_io_load(VOX_TEST_DATA "/box.mesh", NULL, &mesh));
    ck_ok(vox_io_mesh_get_arrays(mesh, &view));
    ck_assert_ptr_null(view.file_vertices);
    vox_io_mesh_destroy(mesh);
    mesh = load(0, 0);
    ck_ok(vox_io_mesh_get_arrays(mesh, &view));
    ck_ok(vox_io_mesh_create(&view, &copy));
    vox_io_mesh_destroy(mesh);
    ck_ok(vox_io_mesh_get_arrays(copy, &again));
    ck_assert_uint_eq(again.file_vertices[3], 4);
    vox_io_mesh_destroy(copy);

    static const double points[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 7, 7, 7};
    static const uint32_t tet[] = {0, 1, 2, 3};
    const vox_io_mesh_view arrays = {points, 5, tet, 1, NULL, 0, NULL, NULL, NULL};
    ck_ok(vox_io_mesh_create(&arrays, &mesh));
    ck_assert_uint_eq(report_of(mesh).vertices, 5);
    vox_io_mesh_destroy(mesh);
}
END_TEST

SUITE(io_unused) {
    TCase* tests = add_case(suite, "unused");
    const int formats = (int)(sizeof files / sizeof *files);
    tcase_add_loop_test(tests, left_out, 0, formats);
    tcase_add_loop_test(tests, kept, 0, formats);
    tcase_add_loop_test(tests, contacts, 0, formats);
    tcase_add_test(tests, ten_nodes);
    tcase_add_test(tests, whole_meshes);
}
