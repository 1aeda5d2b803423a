/* Positions that are bound again, in another format too, and positions that the library owns. */
#include "support/solids_of_doubles.h"

START_TEST(bound_in_another_format) {
    solid a = make_solid(3), b = make_solid(3);
    state = 4;
    place(&a, &kinds[1], 0, 0, 0);
    place(&b, &kinds[1], 0.5, 0.25, 0.1);
    write_solid(&a, VOX_FORMAT_DOUBLE, 24);
    write_solid(&b, VOX_FORMAT_DOUBLE, 24);
    solid rounded = make_solid(3);
    memcpy(rounded.positions, a.positions, 3 * sizeof(double) * a.vertex_count);
    write_solid(&rounded, VOX_FORMAT_FLOAT, 12);
    vox_grid* grid = new_grid(1);
    const vox_body ids[2] = {insert(grid, &a, 0), insert(grid, &b, 0)};
    solid solids[2] = {a, b};
    for (int round = 0; round < 12;
         ++round) { /* 0: doubles, 1: floats, of 0 again: at rest for a step or two */
        solid* bound = round / 2 % 2 ? &rounded : &a;
        ck_ok(bind_array(grid, ids[0], bound->bytes, bound->format, round % 3 ? 0 : bound->stride, 0));
        solids[0].positions = bound->positions;
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_gt(check_contacts(grid, solids, 2, ids, 0), 0);
    }
    vox_grid_destroy(grid);
    free_solid(&a);
    free_solid(&b);
    free_solid(&rounded);
}
END_TEST

START_TEST(refused) {
    solid s = make_solid(1);
    write_solid(&s, VOX_FORMAT_DOUBLE, 24);
    vox_grid* grid = new_grid(1);
    const vox_body mesh = insert(grid, &s, 0);
    vox_mesh_desc desc = solid_desc(&s);
    vox_body out = 0;
    desc.positions.byte_stride = 23;
    ck_fails(vox_mesh_insert(grid, &desc, &out), VOX_ERROR_INVALID_ARGUMENT,
             "is 23, expected 0 or at least 24");
    desc.positions.byte_stride = 0;
    desc.positions.format = (vox_format)2;
    ck_fails(vox_mesh_insert(grid, &desc, &out), VOX_ERROR_INVALID_ARGUMENT, "positions.format is 2");
    ck_fails(bind_array(grid, mesh, s.bytes, VOX_FORMAT_DOUBLE, 12, 0), VOX_ERROR_INVALID_ARGUMENT,
             "is 12, expected 0 or at least 24");
    ck_fails(bind_array(grid, mesh, s.bytes, (vox_format)7, 0, 0), VOX_ERROR_INVALID_ARGUMENT, "format is 7");
    const vox_positions one_less = {s.bytes, s.vertex_count - 1, VOX_FORMAT_DOUBLE, 0, 0, 0},
                        reserved = {s.bytes, s.vertex_count, VOX_FORMAT_DOUBLE, 9, 0, 0};
    ck_fails(vox_mesh_bind_positions(grid, mesh, &one_less), VOX_ERROR_INVALID_ARGUMENT,
             "positions.count is 7, expected 8");
    ck_fails(vox_mesh_bind_positions(grid, mesh, &reserved), VOX_ERROR_INVALID_ARGUMENT,
             "positions.reserved is 9");
    ck_fails(vox_mesh_bind_positions(grid, mesh, NULL), VOX_ERROR_INVALID_ARGUMENT, "positions is null");
    desc = solid_desc(&s);
    desc.rest_positions = one_less;
    ck_fails(vox_mesh_insert(grid, &desc, &out), VOX_ERROR_INVALID_ARGUMENT,
             "rest_positions.count is 7, expected 8");
    void* mapped = NULL;
    ck_fails(vox_mesh_map_positions(NULL, mesh, &mapped), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_mesh_map_positions(grid, mesh, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_positions");
    ck_fails(vox_mesh_map_positions(grid, 0, &mapped), VOX_ERROR_INVALID_HANDLE, "0");
    ck_assert_ptr_null(mapped);
    vox_grid_destroy(grid);
    free_solid(&s);
}
END_TEST

/* Null is an array of no positions. Both functions bind it, and vertices that are added later have none. */
START_TEST(no_positions_of_no_vertices) {
    const vox_mesh_desc empty = vox_default_mesh_desc();
    for (int columns = 0; columns < 2; ++columns) {
        vox_grid* grid = new_grid(1);
        solid s = make_solid(1);
        write_solid(&s, VOX_FORMAT_FLOAT, 12);
        insert(grid, &s, 0);
        vox_body mesh = 0;
        ck_ok(vox_mesh_insert(grid, &empty, &mesh));
        const uint64_t stride = columns ? 8 : 24, component = columns ? 64 : 8;
        ck_ok(bind_array(grid, mesh, NULL, VOX_FORMAT_FLOAT, 0, 0));
        ck_ok(bind_array(grid, mesh, NULL, VOX_FORMAT_DOUBLE, stride, component));
        ck_fails(bind_array(grid, mesh, NULL, (vox_format)7, 0, 0), VOX_ERROR_INVALID_ARGUMENT,
                 "format is 7");
        vox_body_info info = {.struct_size = sizeof info};
        ck_ok(vox_body_get_info(grid, mesh, &info));
        ck_assert_ptr_null(info.positions.data);
        ck_assert_int_eq(info.positions.format, VOX_FORMAT_DOUBLE);
        ck_ok(vox_grid_step(grid));
        /* One that had positions of its own, and vertices that have none. */
        void* mapped = &info;
        ck_ok(vox_mesh_map_positions(grid, mesh, &mapped));
        ck_assert_ptr_null(mapped);
        ck_ok(bind_array(grid, mesh, NULL, VOX_FORMAT_FLOAT, 0, 0));
        vox_vertices_desc vertices = vox_default_vertices_desc();
        vertices.count = 1;
        uint32_t first = 7;
        ck_ok(vox_mesh_append_vertices(grid, mesh, &vertices, &first));
        ck_assert_uint_eq(first, 0);
        ck_fails(vox_grid_step(grid), VOX_ERROR_INVALID_STATE, "has no positions");
        ck_fails(bind_array(grid, mesh, NULL, VOX_FORMAT_FLOAT, 0, 0), VOX_ERROR_INVALID_ARGUMENT,
                 "positions.data is null");
        ck_fails(bind_array(grid, mesh, NULL, VOX_FORMAT_FLOAT, 0, 0), VOX_ERROR_INVALID_ARGUMENT,
                 "positions.data is null");
        const float position[3] = {0, 0, 0};
        ck_ok(vox_mesh_bind_floats(grid, mesh, position, 1));
        ck_ok(vox_grid_step(grid));
        vox_grid_destroy(grid);
        free_solid(&s);
    }
}
END_TEST

START_TEST(mapped_positions) {
    for (int floats = 0; floats < 2; ++floats) {
        const size_t size = floats ? 12 : 24;
        solid a = make_solid(2), b = make_solid(2);
        state = 5;
        place(&a, &kinds[1], 0, 0, 0);
        place(&b, &kinds[1], 0.25, 0.5, 0.1);
        write_solid(&a, floats ? VOX_FORMAT_FLOAT : VOX_FORMAT_DOUBLE, size + 8);
        write_solid(&b, floats ? VOX_FORMAT_FLOAT : VOX_FORMAT_DOUBLE, size);
        vox_grid *grid = new_grid(1), *copy = new_grid(1), *late = new_grid(1);
        const vox_body ids[2] = {insert(grid, &a, 0), insert(grid, &b, 0)};
        const uint64_t hash = hash_of_step(grid);
        ck_assert_uint_gt(contacts_of(grid).count, 0);

        /* What was borrowed is there, and counts from now on alone. */
        void *mapped = NULL, *again = NULL;
        ck_ok(vox_mesh_map_positions(grid, ids[0], &mapped));
        ck_assert_uint_eq((uintptr_t)mapped % 8, 0);
        for (uint32_t v = 0; v < a.vertex_count; ++v)
            ck_assert_int_eq(memcmp((char*)mapped + v * size, a.bytes + v * a.stride, size), 0);
        memset(a.bytes, 0xff, a.stride * a.vertex_count); /* NaN */
        ck_assert_uint_eq(hash_of_step(grid), hash);
        ck_ok(vox_mesh_map_positions(grid, ids[0], &again));
        ck_assert_ptr_eq(again, mapped);

        /* Written to: a step sees it, another one does, and the way back. */
        for (int step = 0; step < 4; ++step) {
            for (uint32_t i = 0; i < 3 * a.vertex_count; ++i) {
                a.positions[i] += step < 2 ? 0.0625 : -0.0625;
                if (floats)
                    a.positions[i] = (double)(((float*)mapped)[i] = (float)a.positions[i]);
                else
                    ((double*)mapped)[i] = a.positions[i];
            }
            const solid solids[2] = {a, b};
            ck_ok(vox_grid_step(grid));
            (void)check_contacts(grid, solids, 2, ids, 0);
        }

        /* A copy made at insertion is what is mapped; positions that are written before there were any. */
        write_solid(&a, a.format, size);
        const vox_body copied = insert(copy, &a, VOX_MESH_COPY_POSITIONS);
        (void)insert(copy, &b, 0);
        const uint64_t moved = hash_of_step(copy);
        ck_ok(vox_mesh_map_positions(copy, copied, &mapped));
        ck_assert_int_eq(memcmp(mapped, a.bytes, size * a.vertex_count), 0);
        ck_assert_uint_eq(hash_of_step(copy), moved);
        vox_mesh_desc desc = solid_desc(&a);
        desc.positions.data = NULL;
        vox_body mesh = insert_mesh(late, &desc);
        ck_fails(vox_grid_step(late), VOX_ERROR_INVALID_STATE, "no positions");
        ck_ok(vox_mesh_map_positions(late, mesh, &mapped));
        for (size_t i = 0; i < size * a.vertex_count; ++i) ck_assert_int_eq(((char*)mapped)[i], 0);
        memcpy(mapped, a.bytes, size * a.vertex_count);
        (void)insert(late, &b, 0);
        ck_assert_uint_eq(hash_of_step(late), moved);

        /* Bound again, they are gone. */
        ck_ok(bind_array(copy, copied, a.bytes, a.format, 0, 0));
        ck_assert_uint_eq(hash_of_step(copy), moved);
        vox_grid_destroy(grid);
        vox_grid_destroy(copy);
        vox_grid_destroy(late);
        free_solid(&a);
        free_solid(&b);
    }
}
END_TEST

START_TEST(mapped_positions_of_nothing) {
    vox_grid* grid = new_grid(1);
    vox_mesh_desc desc = vox_default_mesh_desc();
    vox_body mesh = 0;
    void* mapped = &mesh;
    ck_ok(vox_mesh_insert(grid, &desc, &mesh));
    ck_ok(vox_mesh_map_positions(grid, mesh, &mapped));
    ck_assert_ptr_null(mapped);
    ck_ok(vox_grid_step(grid));
    vox_grid_destroy(grid);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, bound_in_another_format, refused, no_positions_of_no_vertices, mapped_positions,
                   mapped_positions_of_nothing);
}

SUITE(mesh_positions) { add_for_each_engine(suite, add_tests); }
