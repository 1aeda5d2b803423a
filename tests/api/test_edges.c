/* Edges through faces: what bars laid across each other give, their life, memory and errors. Which there are
 * in random scenes: tests/internal/test_edge_definition.cpp. */
#include <math.h>
#include <string.h>

#include "scenes/bodies.h"
#include "support/constraint_checks.h"
#include "support/ledger.h"
#include "support/snapshot_checks.h"
#include "support/turns.h"

static uint64_t count_edges(const vox_grid* grid) { return count_constraints(grid, VOX_CONSTRAINT_EDGE); }

static vox_grid_desc edge_desc(void) {
    vox_grid_desc desc = engine_desc();
    desc.flags = VOX_GRID_EDGES | VOX_GRID_CONSTRAINTS;
    return desc;
}

/* A bar of 9 * 1 * 1 along x, or of 1 * 9 * 1 along y, with its middle at (0, 0, z + 0.5). It has no vertex
 * within 1.5 of that along its length. */
static body make_bar(int along_y, double z) {
    body b = make_block(&five_cut, along_y ? 1 : 3, along_y ? 3 : 1, 1);
    for (uint32_t v = 0; v < b.vertex_count; ++v) b.positions[3 * v + (along_y ? 1 : 0)] *= 3;
    move_body(&b, along_y ? -0.5 : -4.5, along_y ? -4.5 : -0.5, z);
    return b;
}

typedef struct bars {
    vox_grid* grid;
    body below, above;
    vox_body ids[2];
} bars;

/* Like a plus sign: no vertex of one is in the other. */
static bars new_bars(double overlap, const vox_grid_desc* desc) {
    bars s;
    s.below = make_bar(0, 0);
    s.above = make_bar(1, 1 - overlap);
    s.grid = grid_of(desc);
    const vox_mesh_desc descs[2] = {body_desc(&s.below), body_desc(&s.above)};
    for (int i = 0; i < 2; ++i) s.ids[i] = insert_mesh(s.grid, &descs[i]);
    return s;
}

static void free_bars(bars* s) {
    vox_grid_destroy(s->grid);
    free_body(&s->below);
    free_body(&s->above);
}

/* The bars touch, by edges alone. */
static void check_pair(const bars* s, vox_pair_state state) {
    const vox_pair_view pairs = pairs_of(s->grid);
    ck_assert_uint_eq(contacts_of(s->grid).count, 0);
    ck_assert_uint_eq(pairs.count, 1);
    ck_assert_int_eq(pairs.data[0].state, state);
    ck_assert_uint_eq(pairs.data[0].body_a, s->ids[0]);
    ck_assert_uint_eq(pairs.data[0].body_b, s->ids[1]);
    ck_assert_uint_eq(pairs.data[0].contact_count + pairs.data[0].first_contact, 0);
}

/* ---- what there is ------------------------------------------------------------------------------ */

START_TEST(crossed_bars) {
    const double overlaps[] = {0.25, 0.125}; /* exact as floats */
    const vox_grid_desc desc = edge_desc();
    for (int i = 0; i < 2; ++i) {
        const double overlap = overlaps[i];
        bars s = new_bars(overlap, &desc);
        ck_ok(vox_grid_step(s.grid));
        check_pair(&s, VOX_PAIR_BEGAN);

        /* The way out is up or down, as deep as they overlap, wherever an edge passes through. */
        const vox_constraint_view view = checked_constraints(s.grid);
        ck_assert_uint_gt(view.count, 0);
        int through = 0;
        for (uint64_t k = 0; k < view.count; ++k) {
            const vox_constraint* c = &view.data[k];
            ck_assert_int_eq(c->kind, VOX_CONSTRAINT_EDGE);
            ck_assert_uint_eq(c->previous, VOX_NONE);
            ck_assert(c->position[2] >= 1 - overlap && c->position[2] <= 1);
            if (c->state != VOX_DEPTH_CLOSEST) continue;
            const body* of = c->body_a == s.ids[0] ? &s.below : &s.above;
            if (of->positions[3 * c->vertices[0] + 2] != of->positions[3 * c->vertices[1] + 2])
                continue; /* a diagonal */
            ++through;
            ck_assert_double_eq_tol(c->gap, -overlap, 1e-12);
            ck_assert_double_eq_tol(c->normal[2], c->body_a == s.ids[1] ? 1 : -1, 1e-12);
        }
        ck_assert_int_ge(through, 4);

        /* The gap follows the bars. */
        placed_body now[2] = {place_body(s.grid, s.ids[0]), place_body(s.grid, s.ids[1])};
        for (uint64_t v = 0; v < now[1].vertex_count; ++v) now[1].x[3 * v + 2] += 0.5;
        for (uint64_t k = 0; k < view.count; ++k) {
            const vox_constraint* c = &view.data[k];
            const int up = c->body_a == s.ids[1];
            ck_assert_double_eq_tol(vox_constraint_gap(c, now[up].x, now[!up].x),
                                    c->gap + (up ? 0.5 : -0.5) * c->normal[2], 1e-12);
        }
        for (int b = 0; b < 2; ++b) free_placed(&now[b]);

        /* At rest all is carried over; moved out by the depth and a little more, they touch no longer. */
        kept_constraints before = keep_constraints(s.grid);
        ck_ok(vox_grid_step(s.grid));
        same_constraints(s.grid, &before);
        check_previous(s.grid, &before);
        check_pair(&s, VOX_PAIR_PERSISTED);
        if (suite_engine == ENGINE_FAST)
            ck_assert_uint_eq(counters_of(s.grid).carried_edge_contacts, before.count);
        move_body(&s.above, 0.03, 0, overlap);
        ck_ok(vox_grid_step(s.grid));
        check_previous(s.grid, &before);
        (void)checked_constraints(s.grid);
        ck_assert_uint_gt(count_edges(s.grid), 0);
        for (uint64_t k = 0; k < count_edges(s.grid); ++k) /* surface on surface */
            ck_assert_int_eq(constraints_of(s.grid).data[k].state, VOX_DEPTH_TOUCHING);
        move_body(&s.above, 0, 0, 0.01);
        ck_ok(vox_grid_step(s.grid));
        ck_assert_uint_eq(constraints_of(s.grid).count, 0);
        check_pair(&s, VOX_PAIR_ENDED);
        free(before.data);
        free_bars(&s);
    }
}
END_TEST

/* A bar with one end in another: the part of an edge inside ends with the edge. */
START_TEST(depth_of_an_edge_that_ends_inside) {
    const float tall[12] = {0, 0, -10, 1, 0, 10, 0, 1, 10, -1, -1, 10}; /* its tip is at z = -10 */
    body block = make_block(&five_cut, 3, 3, 3);
    move_body(&block, -1.3, -1.4, -11);
    const vox_grid_desc desc = edge_desc();
    vox_grid* grid = grid_of(&desc);
    const vox_mesh_desc of_block = body_desc(&block);
    vox_mesh_desc of_tet = vox_mesh_desc_floats(tall, 4, unit_tet, 1);
    const vox_body b = insert_mesh(grid, &of_block), a = insert_mesh(grid, &of_tet);
    ck_ok(vox_grid_step(grid));
    const vox_constraint_view view = checked_constraints(grid);
    int count = 0;
    for (uint64_t k = 0; k < view.count; ++k) {
        const vox_constraint* c = &view.data[k];
        if (c->body_a != a || c->kind != VOX_CONSTRAINT_EDGE) continue;
        ++count;
        ck_assert_uint_eq(c->body_b, b);
        ck_assert_int_eq(c->state, VOX_DEPTH_CLOSEST);
        /* The block reaches from -11 to -8 along z; the middle of the part is at z = -9, 1 below its top. */
        ck_assert_double_eq_tol(c->position[2], -8, 1e-12);
        ck_assert_double_eq_tol(c->gap, -1, 0.5);
        ck_assert_double_ge(c->gap, -1 - 1e-12);
    }
    ck_assert_int_eq(count, 3); /* its three long edges */
    vox_grid_destroy(grid);
    free_body(&block);
}
END_TEST

/* A mesh that passes through itself: the way out is out of the face. */
START_TEST(of_a_mesh_with_itself) {
    body pair[2] = {make_bar(0, 0), make_bar(1, 0.75)}, both = {NULL, NULL, 0, 0};
    for (int i = 0; i < 2; ++i) {
        const uint32_t vertices = both.vertex_count + pair[i].vertex_count,
                       tets = both.tet_count + pair[i].tet_count;
        both.positions = realloc(both.positions, 3 * sizeof(float) * vertices);
        both.tets = realloc(both.tets, 4 * sizeof(uint32_t) * tets);
        memcpy(both.positions + 3 * both.vertex_count, pair[i].positions,
               3 * sizeof(float) * pair[i].vertex_count);
        for (uint32_t k = 0; k < 4 * pair[i].tet_count; ++k)
            both.tets[4 * both.tet_count + k] = both.vertex_count + pair[i].tets[k];
        both.vertex_count = vertices;
        both.tet_count = tets;
    }
    const vox_grid_desc desc = edge_desc();
    vox_grid* grid = grid_of(&desc);
    vox_mesh_desc of = body_desc(&both);
    of.filter.flags = VOX_FILTER_SELF_COLLISION;
    const vox_body id = insert_mesh(grid, &of);
    ck_ok(vox_grid_step(grid));
    const vox_constraint_view view = checked_constraints(grid);
    ck_assert_uint_eq(pairs_of(grid).count, 1);
    int through = 0;
    for (uint64_t k = 0; k < view.count; ++k) {
        const vox_constraint* c = &view.data[k];
        ck_assert(c->kind == VOX_CONSTRAINT_EDGE && c->body_a == id && c->body_b == id);
        ck_assert(c->state == VOX_DEPTH_PLANE || c->state == VOX_DEPTH_TOUCHING);
        through += c->state == VOX_DEPTH_PLANE;
    }
    ck_assert_int_ge(through, 4);
    vox_grid_destroy(grid);
    free_body(&both);
    for (int i = 0; i < 2; ++i) free_body(&pair[i]);
}
END_TEST

/* Also that a step without the flag has none, and that one without constraints has the pair all the same. */
START_TEST(contacts_stay_the_same) {
    body bodies[2] = {make_box(4, 0.25f, 0, 0, 0), make_box(3, 0.3f, 0.41f, 0.32f, 0.53f)};
    uint64_t hashes[2], inside[2];
    for (uint32_t with = 0; with < 2; ++with) {
        vox_grid_desc desc = engine_desc();
        desc.flags = with ? VOX_GRID_EDGES : 0;
        vox_grid* grid = grid_of(&desc);
        for (int i = 0; i < 2; ++i) {
            const vox_mesh_desc of = body_desc(&bodies[i]);
            insert_mesh(grid, &of);
        }
        hashes[with] = hash_of_step(grid);
        ck_assert_uint_eq(count_pairs(grid, VOX_PAIR_BEGAN), 1);
        ck_ok(vox_grid_find_constraints(grid, NULL));
        (void)checked_constraints(grid);
        inside[with] = count_constraints(grid, VOX_CONSTRAINT_INSIDE);
        ck_assert_uint_eq(count_edges(grid) > 0, with);
        ck_assert_uint_eq(counters_of(grid).edge_contacts, count_edges(grid));
        vox_grid_destroy(grid);
    }
    ck_assert_uint_eq(hashes[0], hashes[1]);
    ck_assert_uint_eq(inside[0], inside[1]);
    for (int i = 0; i < 2; ++i) free_body(&bodies[i]);
}
END_TEST

/* ---- constraints after the step ------------------------------------------------------------------ */

START_TEST(found_on_demand) {
    vox_grid_desc desc = engine_desc();
    desc.flags = VOX_GRID_EDGES;
    bars s = new_bars(0.25, &desc);
    vox_constraint_view view = {NULL, 7, NULL, 7};
    vox_constraint_desc none = vox_default_constraint_desc();
    none.method = VOX_DEPTH_METHOD_NONE;
    ck_ok(vox_grid_step(s.grid));
    check_pair(&s, VOX_PAIR_BEGAN);
    ck_fails(vox_grid_get_constraints(s.grid, &view), VOX_ERROR_INVALID_STATE, "vox_grid_find_constraints");
    ck_assert_uint_eq(view.count, 7);
    ck_ok(vox_grid_find_constraints(s.grid, &none));
    const uint64_t count = checked_constraints(s.grid).count;
    ck_assert_uint_gt(count, 0);
    uint64_t unknown = 0;
    for (uint64_t k = 0; k < count; ++k) {
        const vox_constraint* c = &constraints_of(s.grid).data[k];
        ck_assert(c->state == VOX_DEPTH_UNKNOWN || c->state == VOX_DEPTH_TOUCHING);
        unknown += c->state == VOX_DEPTH_UNKNOWN;
    }
    ck_ok(vox_grid_find_constraints(s.grid, NULL));
    ck_assert_uint_eq(checked_constraints(s.grid).count, count);
    uint64_t known = 0;
    for (uint64_t k = 0; k < count; ++k) known += constraints_of(s.grid).data[k].state == VOX_DEPTH_CLOSEST;
    ck_assert_uint_eq(known, unknown);
    ck_assert_uint_ge(known, 4);
    free_bars(&s);
}
END_TEST

START_TEST(after_failures_and_edits) {
    const vox_grid_desc desc = edge_desc();
    bars s = new_bars(0.25, &desc);
    vox_constraint_view view;
    ck_ok(vox_grid_step(s.grid));
    /* A position that has become bad since; the constraints of before stay. */
    const uint64_t count = constraints_of(s.grid).count;
    const float kept = s.above.positions[4];
    s.above.positions[4] = NAN;
    ck_fails(vox_grid_find_constraints(s.grid, NULL), VOX_ERROR_NON_FINITE, "vertex 1");
    ck_assert_uint_eq(constraints_of(s.grid).count, count);
    /* A step that fails has none. */
    ck_fails(vox_grid_step(s.grid), VOX_ERROR_NON_FINITE, "vertex 1");
    ck_fails(vox_grid_get_constraints(s.grid, &view), VOX_ERROR_INVALID_STATE,
             "no constraints were looked for");
    s.above.positions[4] = kept;
    ck_ok(vox_grid_step(s.grid));
    ck_assert_uint_eq(count_edges(s.grid), count);
    check_pair(&s, VOX_PAIR_PERSISTED);
    /* An edit, a removal. */
    const uint32_t tets[1] = {0};
    ck_ok(vox_mesh_set_tets_enabled(s.grid, s.ids[1], tets, 1, 0));
    ck_fails(vox_grid_find_constraints(s.grid, NULL), VOX_ERROR_INVALID_STATE, "was edited since the step");
    ck_ok(vox_grid_step(s.grid));
    ck_ok(vox_grid_find_constraints(s.grid, NULL));
    ck_ok(vox_body_remove(s.grid, s.ids[0]));
    ck_fails(vox_grid_find_constraints(s.grid, NULL), VOX_ERROR_INVALID_STATE, "was removed since the step");
    ck_ok(vox_grid_step(s.grid));
    ck_assert_uint_eq(constraints_of(s.grid).count, 0);
    check_pair(&s, VOX_PAIR_ENDED);
    free_bars(&s);
}
END_TEST

/* ---- flags, memory, snapshots ------------------------------------------------------------------- */

START_TEST(on_and_off) {
    const uint32_t others[] = {0, VOX_GRID_CONSTRAINTS};
    for (int o = 0; o < 2; ++o) {
        vox_grid_desc desc = engine_desc();
        desc.flags = others[o];
        bars s = new_bars(0.25, &desc);
        ck_ok(vox_grid_step(s.grid));
        kept_constraints first = {NULL, 0};
        uint64_t bytes = 0;
        for (int round = 0; round < 3; ++round) {
            ck_ok(vox_grid_set_flags(s.grid, others[o] | VOX_GRID_EDGES));
            ck_assert_uint_eq(grid_info(s.grid).flags, others[o] | VOX_GRID_EDGES);
            ck_ok(vox_grid_step(s.grid));
            check_pair(&s, VOX_PAIR_BEGAN);
            ck_ok(vox_grid_find_constraints(s.grid, NULL));
            ck_assert_uint_gt(count_edges(s.grid), 0);
            if (round == 0) first = keep_constraints(s.grid);
            same_constraints(s.grid, &first);
            /* Constraints on and off meanwhile. */
            ck_ok(vox_grid_set_flags(s.grid, (VOX_GRID_CONSTRAINTS - others[o]) | VOX_GRID_EDGES));
            ck_ok(vox_grid_step(s.grid));
            ck_ok(vox_grid_find_constraints(s.grid, NULL));
            same_constraints(s.grid, &first);
            ck_ok(vox_grid_set_flags(s.grid, others[o]));
            ck_ok(vox_grid_step(s.grid));
            check_pair(&s, VOX_PAIR_ENDED);
            if (round == 1) bytes = counters_of(s.grid).bytes;
            if (round == 2) ck_assert_uint_eq(counters_of(s.grid).bytes, bytes);
        }
        free(first.data);
        free_bars(&s);
    }
}
END_TEST

/* Two balls that go through each other, then the same way again: the second time takes no memory, also where
 * the work is shared in another way. */
START_TEST(steady_state_allocates_nothing) {
    const uint32_t workers[] = {1, 3};
    for (int w = 0; w < 2; ++w) {
        if (suite_engine == ENGINE_REFERENCE && w > 0) break;
        ledger l = {0};
        vox_grid_desc desc = edge_desc();
        desc.allocator = ledger_allocator(&l);
        desc.worker_count = workers[w];
        turns t = {workers[w], 0};
        const vox_task_system tasks = {take_turns, taken, &t};
        desc.tasks = &tasks;
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
        uint64_t calls = 0, counts[16], found = 0;
        for (int round = 0; round < 4; ++round) {
            if (round == 3) calls = l.calls;
            t.in_turn = round == 3;
            memcpy(balls[1].positions, start, 3 * sizeof(float) * balls[1].vertex_count);
            for (int step = 0; step < 16; ++step) {
                move_body(&balls[1], -1.1, 0, 0);
                ck_ok(vox_grid_step(grid));
                if (round == 0) counts[step] = count_edges(grid);
                ck_assert_uint_eq(count_edges(grid), counts[step]);
                found += counts[step];
            }
        }
        ck_assert_uint_gt(found, 1000);
        ck_assert_uint_eq(l.calls, calls);
        vox_grid_destroy(grid);
        ck_assert_uint_eq(l.bytes, 0);
        free(start);
        for (int i = 0; i < 2; ++i) free_body(&balls[i]);
    }
}
END_TEST

/* Every allocation of a step and of finding constraints fails once; the grid stays usable. */
START_TEST(without_memory) {
    ledger l = {0};
    vox_grid_desc desc = engine_desc();
    kept_constraints expected = {NULL, 0};
    int failures = 0, constraint_failures = 0;
    desc.allocator = ledger_allocator(&l);
    desc.flags = VOX_GRID_EDGES;
    for (uint64_t n = 0, is_last = 0; !is_last; ++n) { /* 0: none fails */
        bars s = new_bars(0.25, &desc);
        l.calls = 0;
        l.fail_at = n;
        vox_result result = vox_grid_step(s.grid);
        failures += result != VOX_OK;
        if (result == VOX_OK) {
            result = vox_grid_find_constraints(s.grid, NULL);
            constraint_failures += result != VOX_OK;
        } else {
            ck_assert_uint_eq(pairs_of(s.grid).count, 0);
        }
        l.fail_at = 0;
        is_last = n > 0 && l.calls < n;
        if (result != VOX_OK) ck_assert_int_eq(result, VOX_ERROR_OUT_OF_MEMORY);
        ck_ok(vox_grid_step(s.grid));
        ck_ok(vox_grid_find_constraints(s.grid, NULL));
        if (n == 0) expected = keep_constraints(s.grid);
        same_constraints(s.grid, &expected);
        free_bars(&s);
        ck_assert_uint_eq(l.bytes, 0);
    }
    ck_assert_int_gt(failures, 20);
    ck_assert_int_gt(constraint_failures, 3);
    free(expected.data);
}
END_TEST

START_TEST(budget) {
    uint64_t peak = 0;
    for (int limited = 0; limited < 2; ++limited) {
        vox_grid_desc desc = engine_desc();
        desc.flags = VOX_GRID_EDGES;
        if (limited) desc.byte_budget = peak - 1;
        bars s = new_bars(0.25, &desc);
        if (limited) {
            ck_assert_int_eq(vox_grid_step(s.grid), VOX_ERROR_BUDGET);
            ck_assert_uint_eq(pairs_of(s.grid).count, 0);
            ck_ok(vox_grid_set_flags(s.grid, 0));
        }
        ck_ok(vox_grid_step(s.grid));
        peak = counters_of(s.grid).peak_bytes;
        free_bars(&s);
    }
}
END_TEST

/* A snapshot keeps the flags and which pairs touch. */
START_TEST(snapshots) {
    const vox_grid_desc desc = edge_desc();
    bars s = new_bars(0.25, &desc);
    ck_ok(vox_grid_step(s.grid));
    const file f = save(s.grid);
    vox_grid* grid = s.grid;
    kept_constraints expected = keep_constraints(grid);
    s.grid = load(f, suite_engine);
    ck_assert_uint_eq(grid_info(s.grid).flags, VOX_GRID_EDGES | VOX_GRID_CONSTRAINTS);
    ck_ok(vox_grid_step(s.grid));
    same_constraints(s.grid, &expected);
    check_pair(&s, VOX_PAIR_PERSISTED);
    vox_grid_destroy(grid);
    free(expected.data);
    free(f.bytes);
    free_bars(&s);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, crossed_bars, depth_of_an_edge_that_ends_inside, of_a_mesh_with_itself,
                   contacts_stay_the_same, found_on_demand, after_failures_and_edits, on_and_off,
                   steady_state_allocates_nothing, without_memory, budget, snapshots);
}

SUITE(edges) { add_for_each_engine(suite, add_tests); }
