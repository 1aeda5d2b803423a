/* What a grid tells about its meshes: enough to go on with a grid that was loaded. */
#include <stddef.h>
#include <string.h>

#include "scenes/bodies.h"
#include "support/suite.h"

static vox_body_info info_of(const vox_grid* grid, vox_body mesh) {
    vox_body_info info;
    memset(&info, 0x55, sizeof info);
    info.struct_size = sizeof info;
    ck_ok(vox_body_get_info(grid, mesh, &info));
    return info;
}

/* Also that copies of fewer meshes are the first ones. */
static uint64_t meshes_of(const vox_grid* grid, vox_body ids[8]) {
    uint64_t count = 99, same = 99;
    ck_ok(vox_grid_get_bodies(grid, NULL, 0, &count));
    ck_assert_uint_le(count, 8);
    ck_ok(vox_grid_get_bodies(grid, ids, 8, &same));
    ck_assert_uint_eq(same, count);
    vox_body first[2] = {77, 77};
    ck_ok(vox_grid_get_bodies(grid, first, 1, &same));
    ck_assert_uint_eq(same, count);
    ck_assert_uint_eq(first[0], count > 0 ? ids[0] : 77);
    ck_assert_uint_eq(first[1], 77);
    return count;
}

START_TEST(meshes) {
    vox_grid* grid = grid_of(NULL);
    vox_body ids[8], found[8];
    body box = make_box(1, 1, 0, 0, 0);
    const vox_mesh_desc desc = body_desc(&box);
    ck_assert_uint_eq(meshes_of(grid, found), 0);
    for (int i = 0; i < 4; ++i) ids[i] = insert_mesh(grid, &desc);
    ck_assert_uint_eq(meshes_of(grid, found), 4);
    ck_assert_mem_eq(found, ids, 4 * sizeof *ids);
    ck_ok(vox_body_remove(grid, ids[1]));
    ck_ok(vox_body_set_enabled(grid, ids[2], 0));
    ck_assert_uint_eq(meshes_of(grid, found), 3);
    ck_assert_uint_eq(found[0], ids[0]);
    ck_assert_uint_eq(found[1], ids[2]);
    ck_assert_uint_eq(found[2], ids[3]);
    ck_assert_uint_eq(info_of(grid, ids[2]).enabled, 0);
    ck_assert_uint_eq(info_of(grid, ids[3]).enabled, 1);
    ck_assert_uint_eq(vox_body_slot(ids[3]), 3);
    ids[1] = insert_mesh(grid, &desc); /* in the slot that is free */
    ck_assert_uint_eq(meshes_of(grid, found), 4);
    ck_assert_uint_eq(found[1], ids[1]);
    ck_assert_uint_eq(vox_body_slot(ids[1]), 1);
    ck_ok(vox_grid_clear(grid));
    ck_assert_uint_eq(meshes_of(grid, found), 0);
    vox_grid_destroy(grid);
    free_body(&box);
}
END_TEST

static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

START_TEST(fields) {
    vox_grid* grid = grid_of(NULL);
    body box = make_box(2, 0.5f, 0, 0, 0);
    vox_mesh_desc desc = body_desc(&box);
    desc.user_data = 0x123456789abcdefull;
    desc.flags = VOX_MESH_BORROW_TETS;
    const vox_body mesh = insert_mesh(grid, &desc);
    vox_body_info info = info_of(grid, mesh);
    ck_assert_uint_eq(info.struct_size, sizeof info);
    ck_assert_uint_eq(info.user_data, desc.user_data);
    ck_assert_uint_eq(info.positions.count, box.vertex_count);
    ck_assert_uint_eq(info.tet_count, box.tet_count);
    ck_assert_uint_eq(info.enabled_tet_count, box.tet_count);
    ck_assert_uint_eq(info.flags, VOX_MESH_BORROW_TETS);
    ck_assert_int_eq(info.positions.format, VOX_FORMAT_FLOAT);
    ck_assert_ptr_eq(info.positions.data, box.positions);
    ck_assert_uint_eq(info.positions.byte_stride, 12);
    ck_assert_uint_eq(info.positions.component_byte_stride, 4);
    ck_assert_mem_eq(info.transform, identity, sizeof identity);

    /* Columns of doubles, a transform, a filter. */
    const uint64_t n = box.vertex_count;
    double* columns = (double*)calloc(3 * n, sizeof *columns);
    const double matrix[12] = {2, 0, 0, 1, 0, 3, 0, 2, 0, 0, 4, 3};
    ck_ok(bind_array(grid, mesh, columns, VOX_FORMAT_DOUBLE, 8, 8 * n));
    ck_ok(vox_body_set_transform(grid, mesh, matrix));
    vox_filter filter = plain_filter();
    filter.flags = VOX_FILTER_SELF_COLLISION;
    ck_ok(vox_body_set_filter(grid, mesh, &filter));
    info = info_of(grid, mesh);
    ck_assert_int_eq(info.positions.format, VOX_FORMAT_DOUBLE);
    ck_assert_ptr_eq(info.positions.data, columns);
    ck_assert_uint_eq(info.positions.byte_stride, 8);
    ck_assert_uint_eq(info.positions.component_byte_stride, 8 * n);
    ck_assert_mem_eq(info.transform, matrix, sizeof matrix);
    ck_assert_uint_eq(info.flags, VOX_MESH_BORROW_TETS);
    ck_assert_uint_eq(info.filter.flags, VOX_FILTER_SELF_COLLISION);
    ck_assert_uint_eq(info.filter.mask, UINT64_MAX);

    /* Positions and tetrahedra of its own. */
    void* mapped = NULL;
    const uint32_t some[2] = {1, 3};
    ck_ok(vox_mesh_map_positions(grid, mesh, &mapped));
    ck_ok(vox_mesh_set_tets_enabled(grid, mesh, some, 2, 0));
    ck_ok(vox_mesh_remove_tets(grid, mesh, some, 1));
    info = info_of(grid, mesh);
    ck_assert_uint_eq(info.flags, VOX_MESH_COPY_POSITIONS);
    ck_assert_ptr_eq(info.positions.data, mapped);
    ck_assert_uint_eq(info.positions.byte_stride, 24);
    ck_assert_uint_eq(info.positions.component_byte_stride, 8);
    ck_assert_uint_eq(info.tet_count, box.tet_count);
    ck_assert_uint_eq(info.enabled_tet_count, box.tet_count - 2);

    /* None yet. */
    desc.positions.data = NULL;
    info = info_of(grid, insert_mesh(grid, &desc));
    ck_assert_ptr_null(info.positions.data);
    ck_assert_uint_eq(info.positions.byte_stride, 0);
    ck_assert_uint_eq(info.positions.component_byte_stride, 0);
    vox_grid_destroy(grid);
    free(columns);
    free_body(&box);
}
END_TEST

START_TEST(tets) {
    vox_grid* grid = grid_of(NULL);
    body box = make_box(2, 0.5f, 0, 0, 0);
    const vox_mesh_desc desc = body_desc(&box);
    const vox_body mesh = insert_mesh(grid, &desc);
    const uint32_t off[2] = {2, 5}, removed = 5;
    ck_ok(vox_mesh_set_tets_enabled(grid, mesh, off, 2, 0));
    ck_ok(vox_mesh_remove_tets(grid, mesh, &removed, 1));
    const uint64_t n = box.tet_count;
    uint32_t* corners = (uint32_t*)calloc(4 * n, sizeof *corners);
    uint8_t* enabled = (uint8_t*)calloc(n, 1);
    uint64_t count = 0;
    ck_ok(vox_mesh_get_tets(grid, mesh, corners, enabled, n, &count));
    ck_assert_uint_eq(count, n);
    ck_assert_mem_eq(corners, box.tets, 4 * n * sizeof *corners);
    for (uint64_t t = 0; t < n; ++t) ck_assert_uint_eq(enabled[t], t != 2 && t != 5);
    /* One of the arrays, and a part. */
    memset(corners, 0, 4 * n * sizeof *corners);
    memset(enabled, 7, n);
    ck_ok(vox_mesh_get_tets(grid, mesh, NULL, enabled, 3, &count));
    ck_assert_uint_eq(count, n);
    ck_assert_mem_eq(enabled, "\1\1\0\7", 4);
    ck_ok(vox_mesh_get_tets(grid, mesh, corners, NULL, 3, &count));
    ck_assert_mem_eq(corners, box.tets, 12 * sizeof *corners);
    ck_assert_uint_eq(corners[12] | corners[13] | corners[14] | corners[15], 0);
    ck_ok(vox_mesh_get_tets(grid, mesh, NULL, NULL, 0, &count));
    ck_assert_uint_eq(count, n);
    vox_grid_destroy(grid);
    free(corners);
    free(enabled);
    free_body(&box);
}
END_TEST

/* A stranger who has only the bytes builds the same scene of what the loaded grid tells. */
START_TEST(loaded) {
    vox_grid* grid = grid_of(NULL);
    body boxes[2] = {make_box(3, 0.3f, 0, 0, 0), make_box(2, 0.4f, 0.3f, 0.2f, 0.1f)};
    for (int b = 0; b < 2; ++b) {
        vox_mesh_desc desc = body_desc(&boxes[b]);
        desc.user_data = 10 + (uint64_t)b;
        insert_mesh(grid, &desc);
    }
    uint64_t size = 0;
    ck_ok(vox_grid_save(grid, NULL, 0, &size));
    void* bytes = malloc(size);
    ck_ok(vox_grid_save(grid, bytes, size, &size));
    const uint64_t hash = hash_of_step(grid);
    ck_assert_uint_gt(contacts_of(grid).count, 0);
    vox_grid_destroy(grid);

    vox_grid *loaded = NULL, *copy = grid_of(NULL);
    ck_ok(vox_grid_load(bytes, size, NULL, &loaded));
    vox_body ids[8];
    ck_assert_uint_eq(meshes_of(loaded, ids), 2);
    for (int b = 0; b < 2; ++b) {
        const vox_body_info info = info_of(loaded, ids[b]);
        uint32_t* corners = (uint32_t*)calloc(4 * info.tet_count, sizeof *corners);
        uint64_t count = 0;
        ck_ok(vox_mesh_get_tets(loaded, ids[b], corners, NULL, info.tet_count, &count));
        vox_mesh_desc desc = vox_default_mesh_desc();
        desc.positions = info.positions;
        desc.positions.format = info.positions.format;
        desc.positions.byte_stride = info.positions.byte_stride;
        desc.positions.component_byte_stride = info.positions.component_byte_stride;
        desc.positions.count = info.positions.count;
        desc.tets = corners;
        desc.tet_count = info.tet_count;
        desc.user_data = info.user_data;
        ck_assert_uint_eq(info.user_data, 10 + (uint64_t)b);
        ck_assert_uint_eq(info.flags, VOX_MESH_COPY_POSITIONS);
        insert_mesh(copy, &desc);
        free(corners);
    }
    ck_assert_uint_eq(hash_of_step(copy), hash);
    ck_assert_uint_eq(hash_of_step(loaded), hash);
    vox_grid_destroy(copy);
    vox_grid_destroy(loaded);
    free(bytes);
    for (int b = 0; b < 2; ++b) free_body(&boxes[b]);
}
END_TEST

START_TEST(arguments) {
    vox_grid* grid = grid_of(NULL);
    vox_body_info info;
    uint64_t count = 99;
    uint32_t corners[4];
    memset(&info, 0x55, sizeof info);
    info.struct_size = sizeof info;
    ck_fails(vox_grid_get_bodies(NULL, NULL, 0, &count), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_get_bodies(grid, NULL, 0, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_count is null");
    ck_fails(vox_grid_get_bodies(grid, NULL, 1, &count), VOX_ERROR_INVALID_ARGUMENT, "bodies is null");
    ck_fails(vox_body_get_info(NULL, 1, &info), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_body_get_info(grid, 1, &info), VOX_ERROR_INVALID_HANDLE, "");
    ck_fails(vox_mesh_get_tets(grid, 1, corners, NULL, 1, &count), VOX_ERROR_INVALID_HANDLE, "");
    const vox_mesh_desc desc = vox_mesh_desc_floats(unit_tet_positions, 4, unit_tet, 1);
    const vox_body mesh = insert_mesh(grid, &desc);
    ck_fails(vox_body_get_info(grid, mesh, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_info is null");
    ck_fails(vox_mesh_get_tets(grid, mesh, corners, NULL, 1, NULL), VOX_ERROR_INVALID_ARGUMENT,
             "out_count is null");
    ck_assert_uint_eq(count, 99);
    info.struct_size = 3;
    ck_fails(vox_body_get_info(grid, mesh, &info), VOX_ERROR_INVALID_ARGUMENT, "struct_size is 3");
    ck_assert_uint_eq(info.enabled, 0x55555555);
    /* An older program's struct ends before the transform. */
    info.struct_size = offsetof(vox_body_info, transform);
    info.transform[0] = 17;
    ck_ok(vox_body_get_info(grid, mesh, &info));
    ck_assert_uint_eq(info.positions.count, 4);
    ck_assert_double_eq(info.transform[0], 17);
    vox_grid_destroy(grid);
}
END_TEST

SUITE(mesh_info) { tcase_add_each(add_case(suite, "info"), meshes, fields, tets, loaded, arguments); }
