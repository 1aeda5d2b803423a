/* Filters of whole pairs, and what a filter may be. Those of single vertices and tetrahedra:
 * test_mesh_self_filters.c. */
#include <math.h>

#include "scenes/random.h"
#include "support/filter_checks.h"

/* ---- whole pairs ------------------------------------------------------------------------------ */

START_TEST(category_mask_and_group) {
    static const struct {
        int32_t group_a, group_b;
        uint64_t category_a, mask_a, category_b, mask_b;
        int collide;
    } rows[] = {
        {0, 0, 1, UINT64_MAX, 1, UINT64_MAX, 1},
        {0, 0, 1, 2, 2, 1, 1},
        {0, 0, 1, 2, 2, 2, 0}, /* one way is not enough */
        {0, 0, 1, 1, 2, 1, 0},
        {0, 0, 0, 0, 1, 1, 1}, /* 0: the defaults */
        {0, 0, 0, 0, 2, 2, 0},
        {0, 0, 1ull << 63, 1ull << 63, 1ull << 63, 1ull << 63, 1},
        {3, 3, 1, 2, 1, 2, 1}, /* the same positive group, whatever the masks */
        {-3, -3, 1, UINT64_MAX, 1, UINT64_MAX, 0},
        {3, -3, 1, UINT64_MAX, 1, UINT64_MAX, 1}, /* different groups: the masks */
        {3, 4, 1, 2, 1, UINT64_MAX, 0},
        {-3, 0, 1, UINT64_MAX, 1, UINT64_MAX, 1},
        {INT32_MIN, INT32_MIN, 1, UINT64_MAX, 1, UINT64_MAX, 0},
    };
    body box = make_box(2, 1, 0, 0, 0), other = make_box(2, 1, 0.5f, 0.5f, 0.5f);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i)
        for (int at_insertion = 0; at_insertion < 2; ++at_insertion) {
            vox_grid* grid = new_grid();
            vox_mesh_desc descs[2] = {body_desc(&box), body_desc(&other)};
            vox_filter filters[2] = {plain_filter(), plain_filter()};
            filters[0].group = rows[i].group_a;
            filters[0].category = rows[i].category_a;
            filters[0].mask = rows[i].mask_a;
            filters[1].group = rows[i].group_b;
            filters[1].category = rows[i].category_b;
            filters[1].mask = rows[i].mask_b;
            vox_body meshes[2];
            for (int m = 0; m < 2; ++m) {
                if (at_insertion) descs[m].filter = filters[m];
                meshes[m] = insert(grid, &descs[m]);
            }
            if (!at_insertion) {
                ck_assert_uint_gt(stepped(grid).count, 0);
                for (int m = 0; m < 2; ++m) ck_ok(vox_body_set_filter(grid, meshes[m], &filters[m]));
            }
            const vox_contact_view view = stepped(grid);
            ck_assert_msg((view.count > 0) == rows[i].collide, "row %zu: %llu contacts", i,
                          (unsigned long long)view.count);
            const vox_filter back = filter_of(grid, meshes[1]);
            if (filters[1].category == 0) filters[1].category = 1;
            if (filters[1].mask == 0) filters[1].mask = UINT64_MAX;
            ck_assert_mem_eq(&back, &filters[1], sizeof back);
            if (!rows[i].collide) { /* nothing was looked at for it */
                const grid_counts counters = counters_of(grid);
                ck_assert_uint_eq(counters.candidates, 0);
                ck_assert_uint_eq(counters.exact_tests, 0);
                if (suite_engine == ENGINE_FAST) ck_assert_uint_eq(counters.entries, 0);
            }
            vox_grid_destroy(grid);
        }
    free_body(&box);
    free_body(&other);
}
END_TEST

/* Copies of a scene in one grid: each finds what it finds alone, whatever groups and categories say. */
START_TEST(worlds) {
    enum { copies = 3 };
    body box = make_box(2, 1, 0, 0, 0), other = make_box(2, 1, 0.5f, 0.5f, 0.5f);
    vox_grid *grid = new_grid(), *alone = new_grid();
    const vox_mesh_desc descs[2] = {body_desc(&box), body_desc(&other)};
    vox_body meshes[copies][2];
    for (int m = 0; m < 2; ++m) (void)insert(alone, &descs[m]);
    const uint64_t expected = stepped(alone).count;
    ck_assert_uint_gt(expected, 0);
    for (uint32_t world = 0; world < copies; ++world)
        for (int m = 0; m < 2; ++m) {
            vox_mesh_desc desc = descs[m];
            desc.filter.world = world == 2 ? UINT32_MAX : world;
            desc.filter.group = 5; /* which would make all of them collide */
            meshes[world][m] = insert(grid, &desc);
        }
    const vox_contact_view view = stepped(grid);
    ck_assert_uint_eq(view.count, copies * expected);
    for (int world = 0; world < copies; ++world)
        ck_assert_uint_eq(contacts_between(view, meshes[world][0], meshes[world][1]), expected);
    vox_filter filter = filter_of(grid, meshes[2][0]);
    ck_assert_uint_eq(filter.world, UINT32_MAX);
    filter.world = 1; /* it leaves its own world, and meets the other's two */
    ck_ok(vox_body_set_filter(grid, meshes[2][0], &filter));
    ck_assert_uint_eq(contacts_between(stepped(grid), meshes[2][0], meshes[2][1]), 0);
    ck_assert_uint_eq(contacts_between(contacts_of(grid), meshes[2][0], meshes[1][1]), expected);
    vox_grid_destroy(grid);
    vox_grid_destroy(alone);
    free_body(&box);
    free_body(&other);
}
END_TEST

START_TEST(pair_exceptions) {
    enum { n = 5 };
    vox_grid* grid = new_grid();
    body boxes[n];
    vox_body meshes[n];
    int excepted[n][n] = {{0}};
    uint64_t random = 5;
    for (int i = 0; i < n; ++i) {
        boxes[i] = make_box(2, 1, 0.25f * (float)i, 0.125f * (float)i, 0.25f * (float)i);
        const vox_mesh_desc desc = body_desc(&boxes[i]);
        meshes[i] = insert(grid, &desc);
    }
    for (int round = 0; round < 60; ++round) {
        const uint32_t i = random_below(&random, n), j = random_below(&random, n),
                       on = random_below(&random, 2);
        if (i == j) { /* a new mesh in the place of another has no exceptions */
            const vox_mesh_desc desc = body_desc(&boxes[i]);
            ck_ok(vox_body_remove(grid, meshes[i]));
            meshes[i] = insert(grid, &desc);
            for (int k = 0; k < n; ++k) excepted[i][k] = excepted[k][i] = 0;
        } else {
            ck_ok(vox_grid_set_pair_enabled(grid, meshes[i], meshes[j], on));
            excepted[i][j] = excepted[j][i] = !on;
        }
        const vox_contact_view view = stepped(grid);
        for (int a = 0; a < n; ++a)
            for (int b = 0; b < a; ++b)
                ck_assert_int_eq(contacts_between(view, meshes[a], meshes[b]) == 0, excepted[a][b]);
    }
    vox_grid_destroy(grid);
    for (int i = 0; i < n; ++i) free_body(&boxes[i]);
}
END_TEST

START_TEST(disabled_bodies) {
    vox_grid* grid = new_grid();
    body box = make_box(2, 1, 0, 0, 0), other = make_box(2, 1, 0.5f, 0.5f, 0.5f);
    const vox_mesh_desc desc = body_desc(&box);
    vox_mesh_desc later = body_desc(&other);
    later.positions.data = NULL;
    insert(grid, &desc);
    const vox_body mesh = insert(grid, &later);
    ck_fails(vox_grid_step(grid), VOX_ERROR_INVALID_STATE, "has no positions");
    ck_ok(vox_body_set_enabled(grid, mesh, 0));
    ck_assert_uint_eq(stepped(grid).count, 0); /* its positions are not missed */
    grid_counts counters = counters_of(grid);
    ck_assert_uint_eq(counters.bodies, 1);
    ck_assert_uint_eq(counters.disabled_bodies, 1);
    ck_assert_uint_eq(counters.tets, box.tet_count);
    ck_ok(bind_array(grid, mesh, other.positions, VOX_FORMAT_FLOAT, 0, 0));
    ck_ok(vox_body_set_enabled(grid, mesh, 1));
    const uint64_t count = stepped(grid).count;
    ck_assert_uint_gt(count, 0);
    ck_ok(vox_body_set_enabled(grid, mesh, 0));
    other.positions[0] = NAN; /* nor are they read */
    ck_assert_uint_eq(stepped(grid).count, 0);
    ck_assert_uint_eq(stepped(grid).count, 0);
    other.positions[0] = 0.5f;
    ck_ok(vox_body_set_enabled(grid, mesh, 1));
    ck_assert_uint_eq(stepped(grid).count, count);
    ck_assert_uint_eq(counters_of(grid).disabled_bodies, 0);
    vox_grid_destroy(grid);
    free_body(&box);
    free_body(&other);
}
END_TEST

/* Pairs that are filtered out take no memory, however many there are. */
START_TEST(many_bodies_in_one_place) {
    enum { bodies = 2000 };
    const engine_kind engines[] = {ENGINE_FAST, ENGINE_REFERENCE};
    for (int e = 0; e < 2; ++e)
        for (int masks = 0; masks < 2; ++masks) {
            vox_grid_desc grid_desc = vox_default_grid_desc();
            use_engine(&grid_desc, engines[e]);
            vox_grid* grid = NULL;
            ck_ok(vox_grid_create(&grid_desc, &grid));
            body tet = make_box(1, 1, 0, 0, 0);
            vox_filter filter = plain_filter();
            vox_mesh_desc desc = body_desc(&tet);
            for (uint32_t i = 0; i < bodies; ++i) {
                if (!masks) filter.group = -7;
                if (masks) filter.category = i % 2 + 1, filter.mask = 4;
                desc.filter = filter;
                insert(grid, &desc);
            }
            const uint64_t before = counters_of(grid).bytes;
            ck_ok(vox_grid_step(grid));
            const grid_counts counters = counters_of(grid);
            ck_assert_uint_eq(counters.contacts, 0);
            ck_assert_uint_lt((counters.peak_bytes - before) / bodies, 2000);
            vox_grid_destroy(grid);
            free_body(&tet);
        }
}
END_TEST

/* ---- arguments -------------------------------------------------------------------------------- */

START_TEST(arguments) {
    vox_grid* grid = new_grid();
    body box = make_box(1, 1, 0, 0, 0);
    vox_mesh_desc desc = body_desc(&box);
    const vox_body mesh = insert(grid, &desc), other = insert(grid, &desc);
    vox_filter filter = plain_filter();
    const vox_filter defaults = filter;
    ck_assert_uint_eq(filter_of(grid, mesh).category, 1);
    ck_assert_uint_eq(filter_of(grid, mesh).mask, UINT64_MAX);
    ck_fails(vox_body_set_filter(NULL, mesh, &filter), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_body_set_filter(grid, mesh, NULL), VOX_ERROR_INVALID_ARGUMENT, "filter is null");
    ck_fails(vox_body_set_filter(grid, 0, &filter), VOX_ERROR_INVALID_HANDLE, "body id is 0");
    filter.self_rings = VOX_MAX_RINGS;
    ck_ok(vox_body_set_filter(grid, mesh, &filter));
    filter.self_rings = VOX_MAX_RINGS + 1;
    ck_fails(vox_body_set_filter(grid, mesh, &filter), VOX_ERROR_LIMIT, "self_rings is 9");
    filter = defaults;
    filter.flags = 4;
    ck_fails(vox_body_set_filter(grid, mesh, &filter), VOX_ERROR_INVALID_ARGUMENT,
             "filter flags is 0x4, of which 0x4 is unknown");
    filter = defaults;
    const double bad[] = {-1, NAN, INFINITY};
    for (int i = 0; i < 3; ++i) {
        filter.self_rest_distance = bad[i];
        ck_fails(vox_body_set_filter(grid, mesh, &filter), VOX_ERROR_INVALID_ARGUMENT, "self_rest_distance");
        desc.filter = filter;
        vox_body untouched = 77;
        ck_fails(vox_mesh_insert(grid, &desc, &untouched), VOX_ERROR_INVALID_ARGUMENT, "self_rest_distance");
        ck_assert_uint_eq(untouched, 77);
    }
    ck_assert_uint_eq(filter_of(grid, mesh).self_rings, VOX_MAX_RINGS); /* of the last that was taken */

    /* The rest pose: none to be had, or not finite. */
    desc = body_desc(&box);
    desc.positions.data = NULL;
    const vox_body bare = insert(grid, &desc);
    filter.self_rest_distance = 1;
    ck_fails(vox_body_set_filter(grid, bare, &filter), VOX_ERROR_INVALID_STATE, "rest_positions");
    desc.rest_positions = vox_float_positions(box.positions, box.vertex_count);
    desc.rest_positions.byte_stride = 4;
    vox_body mesh_with_rest = 0;
    ck_fails(vox_mesh_insert(grid, &desc, &mesh_with_rest), VOX_ERROR_INVALID_ARGUMENT,
             "rest_positions.byte_stride is 4");
    desc.rest_positions.byte_stride = 12;
    mesh_with_rest = insert(grid, &desc);
    ck_ok(vox_body_set_filter(grid, mesh_with_rest, &filter));
    box.positions[4] = NAN;
    ck_fails(vox_mesh_insert(grid, &desc, &mesh_with_rest), VOX_ERROR_NON_FINITE, "vertex 1");
    ck_fails(vox_body_set_filter(grid, other, &filter), VOX_ERROR_NON_FINITE, "vertex 1");

    ck_fails(vox_body_set_enabled(NULL, mesh, 1), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_body_set_enabled(grid, mesh, 2), VOX_ERROR_INVALID_ARGUMENT, "enabled is 2");
    ck_fails(vox_body_set_enabled(grid, 0, 1), VOX_ERROR_INVALID_HANDLE, "body id is 0");
    ck_fails(vox_grid_set_pair_enabled(NULL, mesh, other, 0), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_set_pair_enabled(grid, mesh, other, 7), VOX_ERROR_INVALID_ARGUMENT, "enabled is 7");
    ck_fails(vox_grid_set_pair_enabled(grid, mesh, mesh, 0), VOX_ERROR_INVALID_ARGUMENT, "self-collision");
    ck_fails(vox_grid_set_pair_enabled(grid, mesh, 0, 0), VOX_ERROR_INVALID_HANDLE, "body id is 0");
    ck_ok(vox_body_remove(grid, other));
    ck_fails(vox_grid_set_pair_enabled(grid, mesh, other, 0), VOX_ERROR_INVALID_HANDLE, "stale");
    vox_grid_destroy(grid);
    free_body(&box);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, category_mask_and_group, worlds, pair_exceptions, disabled_bodies,
                   many_bodies_in_one_place, arguments);
}

SUITE(mesh_filters) { add_for_each_engine(suite, add_tests); }
