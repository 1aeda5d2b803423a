/* From files to a grid: the description of a mesh, and meshes in the memory of the caller. */
#include "support/io_files.h"
#include "support/ledger.h"

#include <stddef.h>

static vox_io_mesh* box_of(const vox_io_load_desc* desc) {
    vox_io_mesh* mesh = NULL;
    ck_ok(vox_io_load(VOX_TEST_DATA "/box.mesh", desc, &mesh));
    return mesh;
}

/* What a grid finds of a mesh and its copy, moved. */
static uint64_t contacts_with_copy(const vox_mesh_desc* desc) {
    const double moved[12] = {1, 0, 0, 0.3, 0, 1, 0, 0.2, 0, 0, 1, 0.01};
    vox_grid* grid = grid_of(NULL);
    (void)insert_mesh(grid, desc);
    ck_ok(vox_body_set_transform(grid, insert_mesh(grid, desc), moved));
    ck_ok(vox_grid_step(grid));
    const uint64_t count = contacts_of(grid).count;
    vox_grid_destroy(grid);
    return count;
}

START_TEST(described) {
    vox_io_mesh* mesh = box_of(NULL);
    vox_io_mesh_view view;
    vox_filter filter = plain_filter();
    ck_ok(vox_io_mesh_get_arrays(mesh, &view));
    const vox_mesh_desc by_hand =
        vox_mesh_desc_doubles(view.positions, view.vertex_count, view.tets, view.tet_count);
    vox_mesh_desc desc = vox_default_mesh_desc();
    ck_ok(vox_io_mesh_describe(mesh, &desc));
    ck_assert_mem_eq(&desc, &by_hand, sizeof desc);
    const uint64_t count = contacts_with_copy(&desc);
    ck_assert_uint_gt(count, 0);
    ck_assert_uint_eq(count, contacts_with_copy(&by_hand));
    vox_cell_size_result suggestion;
    suggestion.struct_size = sizeof suggestion;
    ck_ok(vox_suggest_cell_size(NULL, &desc, 1, &suggestion));
    ck_assert_double_lt(suggestion.cell_size, 1);

    /* Whatever the geometry was before, and all else stays. */
    desc.positions.byte_stride = 99;
    desc.positions.component_byte_stride = 77;
    desc.positions.format = VOX_FORMAT_FLOAT;
    desc.user_data = 5;
    desc.flags = VOX_MESH_COPY_POSITIONS;
    desc.filter = filter;
    desc.rest_positions.data = view.positions;
    desc.rest_positions.byte_stride = 48;
    ck_ok(vox_io_mesh_describe(mesh, &desc));
    vox_mesh_desc expected = by_hand;
    expected.user_data = 5;
    expected.flags = VOX_MESH_COPY_POSITIONS;
    expected.filter = filter;
    expected.rest_positions.data = view.positions;
    expected.rest_positions.byte_stride = 48;
    ck_assert_mem_eq(&desc, &expected, sizeof desc);

    /* An older program's struct, and one that holds no tetrahedra. */
    memset(&desc, 0xaa, sizeof desc);
    desc.struct_size = offsetof(vox_mesh_desc, filter);
    ck_ok(vox_io_mesh_describe(mesh, &desc));
    ck_assert_uint_eq(desc.struct_size, offsetof(vox_mesh_desc, filter));
    ck_assert_ptr_eq(desc.positions.data, view.positions);
    ck_assert_int_eq(desc.positions.format, VOX_FORMAT_DOUBLE);
    ck_assert_uint_eq(desc.positions.component_byte_stride, 0);
    ck_assert_uint_eq(desc.user_data, 0xaaaaaaaaaaaaaaaau);
    desc.struct_size = offsetof(vox_mesh_desc, tet_count);
    ck_fails(vox_io_mesh_describe(mesh, &desc), VOX_ERROR_INVALID_ARGUMENT, "does not reach to tet_count");
    desc.struct_size = 0;
    ck_fails(vox_io_mesh_describe(mesh, &desc), VOX_ERROR_INVALID_ARGUMENT, "desc.struct_size is 0");
    ck_fails(vox_io_mesh_describe(mesh, NULL), VOX_ERROR_INVALID_ARGUMENT, "desc is null");
    ck_fails(vox_io_mesh_describe(NULL, &desc), VOX_ERROR_INVALID_ARGUMENT, "mesh is null");
    vox_io_mesh_destroy(mesh);
}
END_TEST

/* The trap that vox_io_mesh_describe is there for. */
START_TEST(doubles_of_a_file_as_floats) {
    vox_io_mesh* mesh = NULL;
    vox_io_mesh_view view;
    vox_mesh_desc desc = vox_default_mesh_desc();
    vox_cell_size_result suggestion;
    ck_ok(vox_io_make_lattice_ball(2000, 1, &mesh));
    ck_ok(vox_io_mesh_get_arrays(mesh, &view));
    desc.positions.data = view.positions;
    desc.positions.count = view.vertex_count;
    desc.tets = view.tets;
    desc.tet_count = view.tet_count;
    suggestion.struct_size = sizeof suggestion;
    ck_fails(vox_suggest_cell_size(NULL, &desc, 1, &suggestion), VOX_ERROR_INVALID_ARGUMENT,
             "positions are doubles");
    vox_grid* grid = grid_of(NULL);
    (void)insert_mesh(grid, &desc);
    ck_fails(vox_grid_step(grid), VOX_ERROR_INVALID_ARGUMENT, "positions are doubles");
    vox_grid_destroy(grid);
    vox_io_mesh_destroy(mesh);
}
END_TEST

static void check_same_report(const vox_io_mesh* a, const vox_io_mesh* b) {
    const vox_io_report r = report_of(a), s = report_of(b);
    ck_assert_uint_eq(r.boundary_facets, s.boundary_facets);
    ck_assert_double_eq(r.volume, s.volume);
    ck_assert_str_eq(vox_io_mesh_get_warnings(a), vox_io_mesh_get_warnings(b));
}

/* Loads, reads or fills a surface; `out` is untouched where that fails. */
static vox_result make(int how, const vox_allocator* allocator, vox_io_mesh** out) {
    vox_io_load_desc load = vox_default_io_load_desc();
    vox_io_tetrahedralize_desc fill = vox_default_io_tetrahedralize_desc();
    load.allocator = fill.allocator = allocator;
    if (how == 0) return vox_io_load(VOX_TEST_DATA "/box.mesh", &load, out);
    if (how == 1) {
        bytes file = read_file(VOX_TEST_DATA, "box_22.msh");
        const vox_io_source source = {"box.msh", file.data, file.size};
        const vox_result result = vox_io_read(&source, 1, &load, out);
        free(file.data);
        return result;
    }
    vox_io_mesh* surface = NULL;
    ck_ok(vox_io_load(VOX_TEST_DATA "/cube.off", NULL, &surface));
    fill.cell = 0.5;
    const vox_result result = vox_io_tetrahedralize(surface, &fill, out);
    vox_io_mesh_destroy(surface);
    return result;
}

START_TEST(in_memory_of_the_caller) {
    ledger memory = {0};
    const vox_allocator* const allocator = ledger_allocator(&memory);
    vox_io_mesh *usual = NULL, *mesh = NULL;
    vox_io_mesh_view view;
    ck_ok(make(_i, NULL, &usual));
    ck_ok(make(_i, allocator, &mesh));
    ck_ok(vox_io_mesh_get_arrays(mesh, &view));
    const uint64_t calls = memory.calls;
    ck_assert_uint_ge(memory.bytes, 24 * view.vertex_count + 16 * view.tet_count + 12 * view.triangle_count);
    check_same(usual, mesh);
    check_same_report(usual, mesh);
    vox_io_mesh_destroy(mesh);
    ck_assert_uint_eq(memory.bytes, 0);
    ck_assert_uint_ge(calls, 3);
    for (uint64_t n = 1; n <= calls; ++n) {
        vox_io_mesh* untouched = NULL;
        memory.calls = 0;
        memory.fail_at = n;
        ck_fails(make(_i, allocator, &untouched), VOX_ERROR_OUT_OF_MEMORY, "memory");
        ck_assert_ptr_null(untouched);
        ck_assert_uint_eq(memory.bytes, 0);
    }
    vox_allocator half = *allocator;
    half.release = NULL;
    ck_fails(make(_i, &half, &mesh), VOX_ERROR_INVALID_ARGUMENT, "one of allocate and release");
    vox_io_mesh_destroy(usual);
}
END_TEST

SUITE(io_to_grid) {
    TCase* tests = add_case(suite, "io_to_grid");
    tcase_add_each(tests, described, doubles_of_a_file_as_floats);
    tcase_add_loop_test(tests, in_memory_of_the_caller, 0, 3);
}
