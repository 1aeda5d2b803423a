/* Edge contacts of a grid: what bars laid across each other give, their life, memory and errors. Which there
 * are in random scenes: tests/internal/test_edge_definition.cpp. */
#include <math.h>
#include <string.h>

#include "scenes/bodies.h"
#include "support/ledger.h"
#include "support/snapshot_checks.h"
#include "support/suite.h"

static vox_edge_contact_view edges_of(const vox_grid* grid) {
    vox_edge_contact_view view = {NULL, 0, 99, 0}; /* a count that is not written shows */
    ck_ok(vox_grid_edge_contacts(grid, &view));
    ck_assert_uint_eq(view.byte_stride, sizeof(vox_edge_contact));
    return view;
}

static uint64_t edge_hash_of(const vox_grid* grid) {
    uint64_t hash = 0;
    ck_ok(vox_grid_edge_hash(grid, &hash));
    return hash;
}

static vox_touch_view events_of(const vox_grid* grid) {
    vox_touch_view view;
    memset(&view, 0, sizeof view);
    ck_ok(vox_grid_touch_events(grid, &view));
    return view;
}

static vox_grid* edge_grid(uint32_t more_flags) {
    vox_grid_desc desc = engine_desc();
    desc.flags = VOX_GRID_EDGE_CONTACTS | more_flags;
    return grid_of(&desc);
}

/* A bar of 9 * 1 * 1 along x, or of 1 * 9 * 1 along y, with its middle at (0, 0, z + 0.5). It has no vertex
 * within 1.5 of that along its length. */
static body make_bar(int along_y, double z) {
    body b = make_block(&five_cut, along_y ? 1 : 3, along_y ? 3 : 1, 1);
    for (uint32_t v = 0; v < b.vertex_count; ++v) b.positions[3 * v + (along_y ? 1 : 0)] *= 3;
    move_body(&b, along_y ? -0.5 : -4.5, along_y ? -4.5 : -0.5, z);
    return b;
}

/* ---- what there is ------------------------------------------------------------------------------ */

/* Like a plus sign: no vertex of one is in the other. */
START_TEST(crossed_bars) {
    const double overlaps[] = {0.25, 0.125};
    for (int i = 0; i < 2; ++i) {
        const double overlap = overlaps[i]; /* exact as a float */
        body below = make_bar(0, 0), above = make_bar(1, 1 - overlap);
        vox_grid* grid = edge_grid(VOX_GRID_PENETRATIONS);
        const vox_mesh_desc descs[2] = {body_desc(&below), body_desc(&above)};
        const vox_body ids[2] = {insert_mesh(grid, &descs[0]), insert_mesh(grid, &descs[1])};
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_eq(contacts_of(grid).count, 0);
        const vox_edge_contact_view view = edges_of(grid);
        ck_assert_uint_gt(view.count, 0);

        /* The two are a pair without contacts, whose touch began. */
        vox_pair_view pairs;
        ck_ok(vox_grid_get_pairs(grid, &pairs));
        ck_assert_uint_eq(pairs.count, 1);
        ck_assert_uint_eq(pairs.data[0].body_a, ids[0]);
        ck_assert_uint_eq(pairs.data[0].body_b, ids[1]);
        ck_assert_uint_eq(pairs.data[0].a_in_b + pairs.data[0].b_in_a + pairs.data[0].first, 0);
        ck_assert_uint_eq(events_of(grid).began, 1);

        /* The way out is up or down, as deep as they overlap, wherever an edge passes through. */
        ck_ok(vox_grid_prepare_edge_depths(grid));
        vox_depth_view depths;
        ck_ok(vox_grid_edge_depths(grid, &depths));
        ck_assert_uint_eq(depths.count, view.count);
        int through = 0;
        for (uint64_t k = 0; k < view.count; ++k) {
            const vox_edge_contact* c = &view.data[k];
            ck_assert(c->position[2] >= 1 - overlap && c->position[2] <= 1);
            if (c->kind != VOX_CROSSING_THROUGH) continue;
            const body* of = c->body_a == ids[0] ? &below : &above;
            const float *p = of->positions + 3 * c->edge[0], *q = of->positions + 3 * c->edge[1];
            if (p[2] != q[2]) continue; /* a diagonal */
            ++through;
            const double up = c->body_a == ids[1] ? 1 : -1;
            ck_assert_double_eq_tol(depths.data[k].depth, overlap, 1e-12);
            ck_assert_double_eq_tol(depths.data[k].direction[2], up, 1e-12);
        }
        ck_assert_int_ge(through, 4);

        /* At rest all is carried over; moved out by the depth and a little more, they touch no longer. */
        const uint64_t hash = edge_hash_of(grid);
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_eq(edge_hash_of(grid), hash);
        ck_assert_uint_eq(events_of(grid).persisted, 1);
        if (suite_engine == ENGINE_FAST)
            ck_assert_uint_eq(counters_of(grid).carried_edge_contacts, edges_of(grid).count);
        move_body(&above, 0, 0, overlap);
        ck_ok(vox_grid_step(grid));
        for (uint64_t k = 0; k < edges_of(grid).count; ++k) /* surface on surface */
            ck_assert_int_ne(edges_of(grid).data[k].kind, VOX_CROSSING_THROUGH);
        move_body(&above, 0, 0, 0.01);
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_eq(edges_of(grid).count, 0);
        ck_assert_uint_eq(events_of(grid).ended, 1);
        vox_grid_destroy(grid);
        free_body(&below);
        free_body(&above);
    }
}
END_TEST

/* A bar with one end in another: the part of an edge inside ends with the edge. */
START_TEST(depth_of_an_edge_that_ends_inside) {
    const float tall[12] = {0, 0, -10, 1, 0, 10, 0, 1, 10, -1, -1, 10}; /* its tip is at z = -10 */
    body block = make_block(&five_cut, 3, 3, 3);
    move_body(&block, -1.3, -1.4, -11);
    vox_grid* grid = edge_grid(0);
    const vox_mesh_desc of_block = body_desc(&block);
    vox_mesh_desc of_tet = vox_mesh_desc_floats(tall, 4, unit_tet, 1);
    const vox_body b = insert_mesh(grid, &of_block), a = insert_mesh(grid, &of_tet);
    ck_ok(vox_grid_step(grid));
    ck_ok(vox_grid_prepare_edge_depths(grid));
    const vox_edge_contact_view view = edges_of(grid);
    vox_depth_view depths;
    ck_ok(vox_grid_edge_depths(grid, &depths));
    int count = 0;
    for (uint64_t k = 0; k < view.count; ++k) {
        const vox_edge_contact* c = &view.data[k];
        if (c->body_a != a || c->kind != VOX_CROSSING_THROUGH) continue;
        ++count;
        ck_assert_uint_eq(c->body_b, b);
        ck_assert_double_eq(c->normal[2], 1);
        /* The block reaches from -11 to -8 along z; the middle of the part is at z = -9, 1 below its top. */
        ck_assert_double_eq_tol(c->position[2], -8, 1e-12);
        ck_assert_double_eq_tol(depths.data[k].depth, 1, 0.5);
        ck_assert_double_le(depths.data[k].depth, 1 + 1e-12);
    }
    ck_assert_int_ge(count, 3); /* its three long edges */
    vox_grid_destroy(grid);
    free_body(&block);
}
END_TEST

START_TEST(contacts_stay_the_same) {
    body bodies[2] = {make_box(4, 0.25f, 0, 0, 0), make_box(3, 0.3f, 0.41f, 0.32f, 0.53f)};
    uint64_t hashes[2], depth_counts[2];
    for (uint32_t with = 0; with < 2; ++with) {
        vox_grid_desc desc = engine_desc();
        if (with) desc.flags |= VOX_GRID_EDGE_CONTACTS;
        vox_grid* grid = grid_of(&desc);
        for (int i = 0; i < 2; ++i) {
            const vox_mesh_desc of = body_desc(&bodies[i]);
            insert_mesh(grid, &of);
        }
        hashes[with] = hash_of_step(grid);
        vox_depth_view depths;
        ck_ok(vox_grid_depths(grid, &depths));
        depth_counts[with] = depths.count;
        ck_assert_uint_eq(counters_of(grid).edge_contacts > 0, with);
        vox_grid_destroy(grid);
    }
    ck_assert_uint_eq(hashes[0], hashes[1]);
    ck_assert_uint_eq(depth_counts[0], depth_counts[1]);
    for (int i = 0; i < 2; ++i) free_body(&bodies[i]);
}
END_TEST

/* ---- arguments and states ----------------------------------------------------------------------- */

START_TEST(arguments) {
    vox_grid *grid = edge_grid(0), *without = engine_grid();
    vox_edge_contact_view view = {NULL, 7, 7, 7};
    vox_depth_view depths = {NULL, 7, 7, 7};
    uint64_t hash = 7;
    ck_fails(vox_grid_edge_contacts(NULL, &view), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_edge_contacts(grid, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_view is null");
    ck_fails(vox_grid_edge_hash(NULL, &hash), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_edge_hash(grid, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_hash is null");
    ck_fails(vox_grid_prepare_edge_depths(NULL), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_edge_depths(NULL, &depths), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_edge_depths(grid, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_view is null");
    ck_fails(vox_grid_edge_depths(grid, &depths), VOX_ERROR_INVALID_STATE, "vox_grid_prepare_edge_depths");
    ck_fails(vox_grid_edge_contacts(without, &view), VOX_ERROR_INVALID_STATE, "lack VOX_GRID_EDGE_CONTACTS");
    ck_fails(vox_grid_edge_hash(without, &hash), VOX_ERROR_INVALID_STATE, "lack VOX_GRID_EDGE_CONTACTS");
    ck_fails(vox_grid_prepare_edge_depths(without), VOX_ERROR_INVALID_STATE, "lack VOX_GRID_EDGE_CONTACTS");
    ck_fails(vox_grid_edge_depths(without, &depths), VOX_ERROR_INVALID_STATE, "lack VOX_GRID_EDGE_CONTACTS");
    ck_assert_uint_eq(view.count + depths.count + hash, 21);
    ck_assert_uint_eq(edges_of(grid).count, 0); /* before the first step */
    ck_ok(vox_grid_step(grid));                 /* without meshes */
    ck_assert_uint_eq(edges_of(grid).count, 0);
    ck_ok(vox_grid_prepare_edge_depths(grid));
    ck_ok(vox_grid_edge_depths(grid, &depths));
    ck_assert_uint_eq(depths.count, 0);
    vox_grid_destroy(grid);
    vox_grid_destroy(without);
}
END_TEST

START_TEST(states_of_depths) {
    body below = make_bar(0, 0), above = make_bar(1, 0.75);
    vox_grid* grid = edge_grid(VOX_GRID_PENETRATIONS);
    const vox_mesh_desc descs[2] = {body_desc(&below), body_desc(&above)};
    vox_body ids[2] = {insert_mesh(grid, &descs[0]), insert_mesh(grid, &descs[1])};
    vox_depth_view depths;
    ck_ok(vox_grid_step(grid));
    ck_ok(vox_grid_prepare_edge_depths(grid));
    ck_ok(vox_grid_step(grid)); /* nothing moved, but depths are of one step */
    ck_fails(vox_grid_edge_depths(grid, &depths), VOX_ERROR_INVALID_STATE, "vox_grid_prepare_edge_depths");
    /* A position that has become bad since; the depths of before stay. */
    ck_ok(vox_grid_prepare_edge_depths(grid));
    const float kept = above.positions[4];
    above.positions[4] = NAN;
    ck_fails(vox_grid_prepare_edge_depths(grid), VOX_ERROR_NON_FINITE, "vertex 1");
    ck_ok(vox_grid_edge_depths(grid, &depths));
    above.positions[4] = kept;
    /* A step that fails has none. */
    above.positions[4] = NAN;
    ck_fails(vox_grid_step(grid), VOX_ERROR_NON_FINITE, "vertex 1");
    ck_assert_uint_eq(edges_of(grid).count, 0);
    above.positions[4] = kept;
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_gt(edges_of(grid).count, 0);
    /* An edit, a removal. */
    const uint32_t tets[1] = {0};
    ck_ok(vox_mesh_set_tets_enabled(grid, ids[1], tets, 1, 0));
    ck_fails(vox_grid_prepare_edge_depths(grid), VOX_ERROR_INVALID_STATE, "was edited since the step");
    ck_ok(vox_grid_step(grid));
    ck_ok(vox_grid_prepare_edge_depths(grid));
    ck_ok(vox_body_remove(grid, ids[0]));
    ck_fails(vox_grid_prepare_edge_depths(grid), VOX_ERROR_INVALID_STATE, "was removed since the step");
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(edges_of(grid).count, 0);
    ck_assert_uint_eq(events_of(grid).ended, 1);
    ck_ok(vox_grid_clear(grid));
    ck_assert_uint_eq(edges_of(grid).count, 0);
    vox_grid_destroy(grid);
    free_body(&below);
    free_body(&above);
}
END_TEST

/* ---- flags, memory, snapshots ------------------------------------------------------------------- */

START_TEST(on_and_off) {
    body below = make_bar(0, 0), above = make_bar(1, 0.75);
    const uint32_t others[] = {0, VOX_GRID_PENETRATIONS};
    for (int o = 0; o < 2; ++o) {
        vox_grid_desc desc = engine_desc();
        desc.flags = others[o];
        vox_grid* grid = grid_of(&desc);
        const vox_mesh_desc descs[2] = {body_desc(&below), body_desc(&above)};
        insert_mesh(grid, &descs[0]);
        insert_mesh(grid, &descs[1]);
        ck_ok(vox_grid_step(grid));
        uint64_t bytes = 0, hash = 0;
        for (int round = 0; round < 3; ++round) {
            uint32_t flags = 0;
            ck_ok(vox_grid_set_flags(grid, others[o] | VOX_GRID_EDGE_CONTACTS));
            flags = grid_info(grid).flags;
            ck_assert_uint_eq(flags, others[o] | VOX_GRID_EDGE_CONTACTS);
            ck_assert_uint_eq(edges_of(grid).count, 0); /* before the next step */
            ck_ok(vox_grid_step(grid));
            ck_assert_uint_gt(edges_of(grid).count, 0);
            ck_assert_uint_eq(events_of(grid).began, 1);
            if (round == 0) hash = edge_hash_of(grid);
            ck_assert_uint_eq(edge_hash_of(grid), hash);
            /* Penetrations on and off meanwhile. */
            ck_ok(vox_grid_set_flags(grid, (VOX_GRID_PENETRATIONS - others[o]) | VOX_GRID_EDGE_CONTACTS));
            ck_ok(vox_grid_step(grid));
            ck_assert_uint_eq(edge_hash_of(grid), hash);
            ck_ok(vox_grid_set_flags(grid, others[o]));
            ck_ok(vox_grid_step(grid));
            ck_assert_uint_eq(events_of(grid).ended, 1);
            if (round == 1) bytes = counters_of(grid).bytes;
            if (round == 2) ck_assert_uint_eq(counters_of(grid).bytes, bytes);
        }
        vox_grid_destroy(grid);
    }
    free_body(&below);
    free_body(&above);
}
END_TEST

/* Two balls that go through each other, then the same way again: the second time takes no memory. */
START_TEST(steady_state_allocates_nothing) {
    const uint32_t workers[] = {1, 3};
    for (int w = 0; w < 2; ++w) {
        if (suite_engine == ENGINE_REFERENCE && w > 0) break;
        ledger l = {0};
        vox_grid_desc desc = engine_desc();
        desc.allocator = ledger_allocator(&l);
        desc.flags |= VOX_GRID_EDGE_CONTACTS;
        desc.worker_count = workers[w];
        vox_grid* grid = grid_of(&desc);
        body balls[2] = {make_lattice_ball(&five_cut, 8, 8), make_lattice_ball(&five_cut, 8, 8)};
        for (int i = 0; i < 2; ++i) {
            jitter_body(&balls[i], 0.1, (uint64_t)i + 1);
            const vox_mesh_desc of = body_desc(&balls[i]);
            insert_mesh(grid, &of);
        }
        move_body(&balls[1], 17, 0.3, 0.4);
        float* start = malloc(3 * sizeof(float) * balls[1].vertex_count);
        memcpy(start, balls[1].positions, 3 * sizeof(float) * balls[1].vertex_count);
        uint64_t calls = 0, hashes[16];
        for (int round = 0; round < 4; ++round) {
            if (round == 3) calls = l.calls;
            memcpy(balls[1].positions, start, 3 * sizeof(float) * balls[1].vertex_count);
            for (int step = 0; step < 16; ++step) {
                move_body(&balls[1], -1.1, 0, 0);
                ck_ok(vox_grid_step(grid));
                if (round == 0) hashes[step] = edge_hash_of(grid);
                ck_assert_uint_eq(edge_hash_of(grid), hashes[step]);
            }
        }
        ck_assert_uint_eq(l.calls, calls);
        vox_grid_destroy(grid);
        ck_assert_uint_eq(l.bytes, 0);
        free(start);
        for (int i = 0; i < 2; ++i) free_body(&balls[i]);
    }
}
END_TEST

/* Every allocation of a step and of the depths fails once; the grid stays usable. */
START_TEST(without_memory) {
    ledger l = {0};
    vox_grid_desc desc = engine_desc();
    desc.allocator = ledger_allocator(&l);
    body below = make_bar(0, 0), above = make_bar(1, 0.75);
    const vox_mesh_desc descs[2] = {body_desc(&below), body_desc(&above)};
    uint64_t hash = 0;
    int failures = 0, depth_failures = 0;
    for (uint64_t n = 1;; ++n) {
        desc.flags = VOX_GRID_EDGE_CONTACTS;
        vox_grid* grid = grid_of(&desc);
        insert_mesh(grid, &descs[0]);
        insert_mesh(grid, &descs[1]);
        l.calls = 0;
        l.fail_at = n;
        vox_result result = vox_grid_step(grid);
        const int stepped = result == VOX_OK;
        if (stepped) {
            hash = edge_hash_of(grid);
            result = vox_grid_prepare_edge_depths(grid);
            depth_failures += result != VOX_OK;
        } else {
            ck_assert_uint_eq(edges_of(grid).count, 0);
            ++failures;
        }
        l.fail_at = 0;
        const int is_last = l.calls < n;
        if (result != VOX_OK) ck_assert_int_eq(result, VOX_ERROR_OUT_OF_MEMORY);
        ck_ok(vox_grid_step(grid));
        ck_ok(vox_grid_prepare_edge_depths(grid));
        if (stepped) ck_assert_uint_eq(edge_hash_of(grid), hash);
        vox_grid_destroy(grid);
        ck_assert_uint_eq(l.bytes, 0);
        if (is_last) break;
    }
    ck_assert_int_gt(failures, 20);
    ck_assert_int_gt(depth_failures, 3);
    free_body(&below);
    free_body(&above);
}
END_TEST

START_TEST(budget) {
    body below = make_bar(0, 0), above = make_bar(1, 0.75);
    const vox_mesh_desc descs[2] = {body_desc(&below), body_desc(&above)};
    uint64_t peak = 0;
    for (int limited = 0; limited < 2; ++limited) {
        vox_grid_desc desc = engine_desc();
        desc.flags = VOX_GRID_EDGE_CONTACTS;
        if (limited) desc.byte_budget = peak - 1;
        vox_grid* grid = grid_of(&desc);
        insert_mesh(grid, &descs[0]);
        insert_mesh(grid, &descs[1]);
        if (limited) {
            ck_assert_int_eq(vox_grid_step(grid), VOX_ERROR_BUDGET);
            ck_assert_uint_eq(edges_of(grid).count, 0);
            ck_ok(vox_grid_set_flags(grid, 0));
        }
        ck_ok(vox_grid_step(grid));
        peak = counters_of(grid).peak_bytes;
        vox_grid_destroy(grid);
    }
    free_body(&below);
    free_body(&above);
}
END_TEST

/* A snapshot keeps the flag and which pairs touch. */
START_TEST(snapshots) {
    body below = make_bar(0, 0), above = make_bar(1, 0.75);
    const vox_mesh_desc descs[2] = {body_desc(&below), body_desc(&above)};
    vox_grid* grid = edge_grid(VOX_GRID_PENETRATIONS);
    insert_mesh(grid, &descs[0]);
    insert_mesh(grid, &descs[1]);
    ck_ok(vox_grid_step(grid));
    uint64_t size = 0, written = 0;
    ck_ok(vox_grid_save(grid, NULL, 0, &size));
    void* bytes = malloc(size);
    ck_ok(vox_grid_save(grid, bytes, size, &written));
    vox_grid* loaded = NULL;
    ck_ok(vox_grid_load(bytes, size, NULL, &loaded));
    uint32_t flags = 0;
    flags = grid_info(loaded).flags;
    ck_assert_uint_eq(flags, VOX_GRID_EDGE_CONTACTS | VOX_GRID_PENETRATIONS);
    ck_assert_uint_eq(edges_of(loaded).count, 0); /* results are not saved */
    ck_ok(vox_grid_step(loaded));
    ck_assert_uint_eq(edge_hash_of(loaded), edge_hash_of(grid));
    ck_assert_uint_eq(events_of(loaded).persisted, 1);
    ck_assert_uint_eq(events_of(loaded).began, 0);
    vox_grid_destroy(loaded);
    vox_grid_destroy(grid);
    free(bytes);
    free_body(&below);
    free_body(&above);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, crossed_bars, depth_of_an_edge_that_ends_inside, contacts_stay_the_same, arguments,
                   states_of_depths, on_and_off, steady_state_allocates_nothing, without_memory, budget,
                   snapshots);
}

SUITE(edge_contacts) { add_for_each_engine(suite, add_tests); }
