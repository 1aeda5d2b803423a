/* Snapshots: the loaded grid is the saved one. */
#include "support/ledger.h"
#include "support/snapshot_checks.h"

/* ---- the loaded grid is the saved one ---- */

START_TEST(loaded_grid_goes_on_as_the_saved_one) {
    static const double cell_sizes[] = {0, 0.2};
    for (int i = 0; i < 2; ++i) {
        scene s;
        make_scene(&s, suite_engine, cell_sizes[i]);
        const file f = save(s.grid);
        vox_grid* again = load(f, ENGINE_FAST);

        double before = 1, after = 2;
        before = grid_info(s.grid).cell_size;
        after = grid_info(again).cell_size;
        ck_assert_double_eq(before, after);
        for (int m = 0; m < 8; ++m) {
            ck_assert_uint_eq(vox_body_is_valid(again, s.ids[m]), m != removed_body);
            if (m == removed_body) continue;
            uint64_t user_data = 0;
            vox_filter x = plain_filter(), y = plain_filter();
            ck_ok(vox_body_get_user_data(again, s.ids[m], &user_data));
            ck_assert_uint_eq(user_data, m < scene_bodies ? 1000u + (unsigned)m : 0u);
            ck_ok(get_filter(s.grid, s.ids[m], &x));
            ck_ok(get_filter(again, s.ids[m], &y));
            ck_assert_int_eq(memcmp(&x, &y, sizeof x), 0);
        }
        vox_contact_view none = contacts_of(again);
        ck_assert_uint_eq(none.count, 0);

        ck_ok(vox_grid_step(s.grid));
        ck_ok(vox_grid_step(again));
        same_results(s.grid, again);
        ck_ok(vox_grid_get_contacts(again, &none));
        ck_assert_uint_gt(none.count, 10);
        ck_assert_uint_gt(constraints_of(again).count, 5);
        ck_assert_uint_gt(count_pairs(again, VOX_PAIR_PERSISTED), 0); /* it knew what touched before */
        ck_assert_uint_gt(count_pairs(again, VOX_PAIR_ENDED),
                          0); /* of the mesh that was removed, and of the disabled one */

        /* What comes later is the same as well: ids, a mesh that comes back, a pair that is allowed again. */
        vox_grid* const both[2] = {s.grid, again};
        vox_body fresh[2][3];
        for (int g = 0; g < 2; ++g) {
            const vox_mesh_desc mesh = body_desc(&s.bodies[removed_body]);
            for (int n = 0; n < 3; ++n) ck_ok(vox_mesh_insert(both[g], &mesh, &fresh[g][n]));
            ck_ok(vox_body_set_enabled(both[g], s.ids[disabled_body], 1));
            ck_ok(vox_grid_set_pair_enabled(both[g], s.ids[0], s.ids[5], 1));
            ck_ok(vox_grid_step(both[g]));
        }
        ck_assert_int_eq(memcmp(fresh[0], fresh[1], sizeof fresh[0]), 0);
        same_results(s.grid, again);
        vox_grid_destroy(again);
        free_scene(&s);
        free(f.bytes);
    }
}
END_TEST

START_TEST(saving_the_loaded_grid_gives_the_same_bytes) {
    scene s;
    make_scene(&s, suite_engine, 0);
    const file f = save(s.grid);
    vox_grid* again = load(f, ENGINE_FAST);
    const file g = save(again);
    ck_assert_uint_eq(f.size, g.size);
    ck_assert_int_eq(memcmp(f.bytes, g.bytes, f.size), 0);
    vox_grid_destroy(again);
    free_scene(&s);
    free(f.bytes);
    free(g.bytes);
}
END_TEST

/* Flags that were changed. */
START_TEST(changed_flags) {
    scene s;
    make_scene(&s, suite_engine, 0);
    for (uint32_t flags = 0; flags < 8; ++flags) {
        ck_ok(vox_grid_set_flags(s.grid, flags));
        const file f = save(s.grid);
        vox_grid* again = load(f, ENGINE_FAST);
        ck_assert_uint_eq(grid_info(again).flags, flags);
        ck_ok(vox_grid_step(s.grid));
        ck_ok(vox_grid_step(again));
        if (flags & VOX_GRID_CONSTRAINTS) same_results(s.grid, again);
        vox_grid_destroy(again);
        free(f.bytes);
    }
    free_scene(&s);
}
END_TEST

START_TEST(every_engine_takes_it) {
    scene s;
    make_scene(&s, suite_engine, 0);
    const file f = save(s.grid);
    ck_ok(vox_grid_step(s.grid));
    for (int engine = ENGINE_REFERENCE; engine <= ENGINE_FAST; ++engine) {
        vox_grid* again = load(f, (engine_kind)engine);
        ck_ok(vox_grid_step(again));
        same_results(s.grid, again);
        const file g = save(again);
        /* The reference engine where it was asked for, else the one that was saved. */
        ck_assert_uint_eq(get(payload(g, "GRID", 0), 4),
                          engine == ENGINE_REFERENCE || suite_engine == ENGINE_REFERENCE ? 1 : 2);
        vox_grid_destroy(again);
        free(g.bytes);
    }
    free_scene(&s);
    free(f.bytes);
}
END_TEST

START_TEST(generations_and_retired_slots) {
    enum { most_uses = 4095 }; /* of a slot */
    vox_grid_desc desc = engine_desc();
    vox_body mesh = 0;
    const vox_mesh_desc tet = vox_mesh_desc_floats(unit_tet_positions, 4, unit_tet, 1);
    vox_grid* grid = grid_of(&desc);
    vox_body kept = insert_mesh(grid, &tet);
    vox_body first = insert_mesh(grid, &tet);
    ck_ok(vox_body_remove(grid, first));
    for (uint32_t use = 1; use < most_uses; ++use) {
        ck_ok(vox_mesh_insert(grid, &tet, &mesh));
        ck_ok(vox_body_remove(grid, mesh));
    }
    const file f = save(grid);
    vox_grid* again = load(f, ENGINE_FAST);
    vox_body y = 1;
    vox_body x = insert_mesh(grid, &tet);
    ck_ok(vox_mesh_insert(again, &tet, &y));
    ck_assert_uint_eq(x, y);
    ck_assert_uint_ne(x, first); /* the slot is used up */
    ck_assert_uint_eq(vox_body_is_valid(again, kept), 1);
    ck_assert_uint_eq(vox_body_is_valid(again, mesh), 0);
    vox_grid_destroy(grid);
    vox_grid_destroy(again);
    free(f.bytes);
}
END_TEST

START_TEST(positions_keep_their_bits) {
    /* -0, the smallest denormal and a NaN with a payload. */
    static const uint32_t bits[12] = {0x80000000u, 1,           0x7fc12345u, 0x3f800000u, 0, 0,
                                      0,           0x3f800000u, 0,           0,           0, 0x3f800000u};
    float positions[12];
    memcpy(positions, bits, sizeof bits);
    const vox_mesh_desc desc = vox_mesh_desc_floats(positions, 4, unit_tet, 1);
    vox_grid_desc settings = engine_desc();
    vox_grid* grid = grid_of(&settings);
    insert_mesh(grid, &desc);
    const file f = save(grid);
    const unsigned char* chunk = find_chunk(f, "MESH", 0);
    const unsigned char* end = chunk + chunk_header_bytes + get(chunk + 8, 8);
    for (int i = 0; i < 12; ++i) ck_assert_uint_eq(get(end - 48 + 4 * i, 4), bits[i]);
    vox_grid* again = load(f, ENGINE_FAST);
    ck_fails(vox_grid_step(again), VOX_ERROR_NON_FINITE, "vertex 0");
    memset(positions, 0, sizeof positions); /* the loaded grid has its own */
    const file g = save(again);
    ck_assert_uint_eq(f.size, g.size);
    ck_assert_int_eq(memcmp(find_chunk(f, "MESH", 0), find_chunk(g, "MESH", 0), (size_t)(end - chunk)), 0);
    vox_grid_destroy(grid);
    vox_grid_destroy(again);
    free(f.bytes);
    free(g.bytes);
}
END_TEST

START_TEST(an_empty_grid_and_one_without_positions) {
    vox_grid_desc settings = engine_desc();
    vox_grid* grid = grid_of(&settings);
    file f = save(grid);
    vox_grid* again = load(f, ENGINE_FAST);
    ck_ok(vox_grid_step(again));
    vox_grid_destroy(again);
    free(f.bytes);

    const vox_mesh_desc desc = vox_mesh_desc_floats(NULL, 4, unit_tet, 1);
    vox_body mesh = insert_mesh(grid, &desc);
    f = save(grid);
    again = load(f, ENGINE_FAST);
    ck_fails(vox_grid_step(again), VOX_ERROR_INVALID_STATE, "no positions");
    ck_ok(bind_array(again, mesh, unit_tet_positions, VOX_FORMAT_FLOAT, 0, 0));
    ck_ok(vox_grid_step(again));
    vox_grid_destroy(again);
    vox_grid_destroy(grid);
    free(f.bytes);
}
END_TEST

START_TEST(arguments) {
    uint64_t size = 77;
    unsigned char bytes[16];
    vox_grid* grid = grid_of(NULL);
    ck_fails(vox_grid_save(NULL, NULL, 0, &size), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_save(grid, NULL, 0, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_size is null");
    memset(bytes, 7, sizeof bytes);
    ck_fails(vox_grid_save(grid, bytes, sizeof bytes, &size), VOX_ERROR_INVALID_ARGUMENT, "capacity is 16");
    ck_assert_uint_eq(size, 77);
    for (size_t i = 0; i < sizeof bytes; ++i) ck_assert_uint_eq(bytes[i], 7);

    const file f = save(grid);
    vox_grid* again = NULL;
    vox_grid_desc desc = vox_default_grid_desc();
    ck_fails(vox_grid_load(NULL, 9, NULL, &again), VOX_ERROR_INVALID_ARGUMENT, "bytes is null");
    ck_fails(vox_grid_load(f.bytes, f.size, NULL, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_grid is null");
    desc.worker_count = VOX_MAX_WORKERS + 1;
    ck_fails(vox_grid_load(f.bytes, f.size, &desc, &again), VOX_ERROR_INVALID_ARGUMENT,
             "worker_count is 257");
    desc = vox_default_grid_desc();
    vox_reference_desc odd = vox_default_reference_desc();
    odd.flags = 99;
    desc.reference = &odd;
    ck_fails(vox_grid_load(f.bytes, f.size, &desc, &again), VOX_ERROR_INVALID_ARGUMENT, "flags is 0x63");
    desc = vox_default_grid_desc();
    desc.byte_budget = 1;
    ck_fails(vox_grid_load(f.bytes, f.size, &desc, &again), VOX_ERROR_BUDGET, "byte budget is 1");
    desc.struct_size = 2;
    ck_fails(vox_grid_load(f.bytes, f.size, &desc, &again), VOX_ERROR_INVALID_ARGUMENT, "struct_size is 2");
    ck_assert_ptr_null(again);
    vox_grid_destroy(grid);
    free(f.bytes);
}
END_TEST

/* ---- memory ---- */

START_TEST(allocation_n_fails) {
    scene s;
    make_scene(&s, suite_engine, 0);
    const file f = save(s.grid);
    ck_ok(vox_grid_step(s.grid));
    ledger l = {0};
    vox_grid_desc desc = vox_default_grid_desc();
    desc.allocator = ledger_allocator(&l);
    vox_grid* grid = NULL;
    uint64_t n = 0;
    while (!grid) {
        l.calls = 0;
        l.fail_at = ++n;
        if (vox_grid_load(f.bytes, f.size, &desc, &grid) == VOX_OK) break;
        ck_assert_ptr_null(grid);
        ck_assert_str_eq(vox_last_error(), "out of memory");
        ck_assert_uint_eq(l.bytes, 0);
    }
    ck_assert_uint_gt(n, 20); /* there were allocations to fail */
    ck_ok(vox_grid_step(grid));
    same_results(s.grid, grid);
    const uint64_t calls = l.calls;
    const file g = save(grid);
    ck_assert_uint_eq(l.calls, calls); /* saving allocates nothing */
    vox_grid_destroy(grid);
    ck_assert_uint_eq(l.bytes, 0);
    free_scene(&s);
    free(f.bytes);
    free(g.bytes);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, loaded_grid_goes_on_as_the_saved_one, saving_the_loaded_grid_gives_the_same_bytes,
                   changed_flags, every_engine_takes_it, generations_and_retired_slots,
                   positions_keep_their_bits, an_empty_grid_and_one_without_positions, arguments,
                   allocation_n_fails);
}

SUITE(snapshots) { add_for_each_engine(suite, add_tests); }
