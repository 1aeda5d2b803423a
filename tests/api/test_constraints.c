/* Constraints of all kinds: stencils and gaps, of which pairs there are some, `previous`, and that they are
 * the same however they are found. */
#include "support/constraint_scenes.h"

static const double margin = 0.2;

/* A grid that finds all kinds, with the bodies of a world. */
static vox_grid* grid_for(world* w, engine_kind engine, uint32_t flags, uint32_t workers) {
    vox_grid* grid = new_grid(engine, VOX_GRID_EDGES | flags, workers);
    ck_ok(vox_grid_set_margin(grid, margin));
    insert_models(grid, w);
    return grid;
}

static void find(vox_grid* grid, vox_depth_method method) {
    vox_constraint_desc desc = vox_default_constraint_desc();
    desc.method = method;
    ck_ok(vox_grid_find_constraints(grid, &desc));
}

/* ---- what each of them is ----------------------------------------------------------------------- */

START_TEST(formula_stencils_and_order) {
    uint64_t random = 11, by_kind[4] = {0}, by_state[7] = {0}, with_itself = 0, times = 0;
    for (int scene = 0; scene < 40; ++scene) {
        world w = moving_world(&random);
        w.grid = grid_for(&w, suite_engine, VOX_GRID_CONSTRAINTS, 1);
        for (int step = 0; step < 8; ++step) {
            move_world(&w, &random);
            ck_ok(vox_grid_step(w.grid));
            const vox_constraint_view view = check_depths(w.grid);
            for (uint64_t i = 0; i < view.count; ++i) {
                const vox_constraint* c = &view.data[i];
                double sums[2] = {0, 0};
                for (uint32_t v = 0; v < c->count; ++v) sums[v >= c->count_a] += c->weights[v];
                ck_assert_double_eq_tol(sums[0], 1, 1e-15);
                ck_assert_double_eq_tol(sums[1], -1, 1e-15);
                ++by_kind[c->kind];
                ++by_state[c->state];
                with_itself += c->body_a == c->body_b;
                times += c->kind == VOX_CONSTRAINT_INSIDE && c->time < 1;
            }
        }
        end_world(&w);
    }
    for (int kind = 0; kind < 4; ++kind) ck_assert_uint_gt(by_kind[kind], 500);
    for (int state = 0; state < 7; ++state)
        ck_assert(state == VOX_DEPTH_UNKNOWN ? by_state[state] == 0 : by_state[state] > 20);
    ck_assert_uint_gt(with_itself, 100);
    ck_assert_uint_gt(times, 100);
}
END_TEST

/* Without depths all else is the same. */
START_TEST(method_none) {
    uint64_t random = 29, by_kind[4] = {0}, unknown = 0;
    for (int scene = 0; scene < 12; ++scene) {
        world w = moving_world(&random);
        w.grid = grid_for(&w, suite_engine, VOX_GRID_CONSTRAINTS, 1);
        for (int step = 0; step < 3; ++step) {
            move_world(&w, &random);
            ck_ok(vox_grid_step(w.grid));
            kept_constraints all = keep_constraints(w.grid);
            find(w.grid, VOX_DEPTH_METHOD_NONE);
            const vox_constraint_view view = check_depths(w.grid);
            ck_assert_uint_eq(view.count, all.count);
            for (uint64_t i = 0; i < view.count; ++i) {
                vox_constraint* c = &all.data[i];
                const int is_vertex = c->kind == VOX_CONSTRAINT_INSIDE;
                const int crosses = c->kind == VOX_CONSTRAINT_EDGE && view.data[i].state == VOX_DEPTH_UNKNOWN;
                if (is_vertex || crosses) {
                    c->state = VOX_DEPTH_UNKNOWN;
                    c->gap = c->offset = c->normal[0] = c->normal[1] = c->normal[2] = 0;
                    ++unknown;
                }
                ck_assert_mem_eq(&view.data[i], c, sizeof *c);
                ++by_kind[c->kind];
            }
            free(all.data);
        }
        end_world(&w);
    }
    for (int kind = 0; kind < 4; ++kind) ck_assert_uint_gt(by_kind[kind], 100);
    ck_assert_uint_gt(unknown, by_kind[VOX_CONSTRAINT_INSIDE] + 500);
}
END_TEST

/* ---- however they are found --------------------------------------------------------------------- */

static void check_same(const vox_grid* a, const vox_grid* b) {
    const vox_constraint_view x = constraints_of(a), y = constraints_of(b);
    ck_assert_uint_eq(x.count, y.count);
    if (x.count) ck_assert_mem_eq(x.data, y.data, x.count * sizeof *x.data);
    ck_assert_uint_eq(x.pair_count, y.pair_count);
    ck_assert_mem_eq(x.pair_offsets, y.pair_offsets, (x.pair_count + 1) * sizeof *x.pair_offsets);
}

/* The flag is a step and a call: while bodies move and rest, for both engines and several workers, whatever
 * else was asked for between the two. */
START_TEST(flag_or_call) {
    enum { others = 4 };
    uint64_t random = 31, carried = 0;
    for (int scene = 0; scene < 12; ++scene) {
        world w = moving_world(&random);
        vox_grid* grids[others];
        w.grid = grid_for(&w, suite_engine, VOX_GRID_CONSTRAINTS, 1);
        for (uint32_t g = 0; g < others; ++g)
            grids[g] = grid_for(&w, g == 1 ? ENGINE_REFERENCE : ENGINE_FAST, g == 3, 1 + 2 * g);
        for (int step = 0; step < 9; ++step) {
            if (step % 3 == 0) move_world(&w, &random);
            if (step % 3 == 1) /* all but one at rest */
                for (uint32_t i = 0; i < 3 * w.models[0].shape.vertex_count; ++i) {
                    w.models[0].shape.positions[i] += 0.03125f;
                    if (w.models[0].doubles) w.models[0].doubles[i] += 0.03125;
                }
            ck_ok(vox_grid_step(w.grid));
            carried += counters_of(w.grid).carried_penetrations;
            for (uint32_t g = 0; g < others; ++g) {
                ck_ok(vox_grid_step(grids[g]));
                if ((uint32_t)step % others >= g) find(grids[g], VOX_DEPTH_METHOD_CLOSEST);
                if ((uint32_t)step % 2 == g % 2) find(grids[g], VOX_DEPTH_METHOD_NONE);
                ck_ok(vox_grid_find_constraints(grids[g], NULL));
                check_same(w.grid, grids[g]);
            }
            find(w.grid, VOX_DEPTH_METHOD_CLOSEST);
            for (uint32_t g = 0; g < others; ++g) {
                find(grids[g], VOX_DEPTH_METHOD_CLOSEST);
                check_same(w.grid, grids[g]);
                ck_ok(vox_grid_find_constraints(grids[g], NULL));
            }
            ck_ok(vox_grid_find_constraints(w.grid, NULL)); /* for `previous` of the next step */
        }
        for (uint32_t g = 0; g < others; ++g) vox_grid_destroy(grids[g]);
        end_world(&w);
    }
    if (suite_engine == ENGINE_FAST) ck_assert_uint_gt(carried, 100);
}
END_TEST

/* Enough bodies that workers share them. */
START_TEST(many_bodies_and_workers) {
    enum { n = 27 };
    body bodies[n];
    kept_constraints expected[2] = {{NULL, 0}, {NULL, 0}};
    for (int b = 0; b < n; ++b)
        bodies[b] = make_box(4, 1, 3.9f * (float)(b % 3), 3.8f * (float)(b / 3 % 3), 3.7f * (float)(b / 9));
    for (uint32_t workers = 1; workers <= 8; workers += workers < 4 ? 1 : 4) {
        vox_grid* grid = new_grid(suite_engine, VOX_GRID_EDGES, workers);
        for (int b = 0; b < n; ++b) {
            const vox_mesh_desc desc = body_desc(&bodies[b]);
            insert_mesh(grid, &desc);
        }
        ck_ok(vox_grid_step(grid));
        for (int m = 0; m < 2; ++m) {
            find(grid, m == 0 ? VOX_DEPTH_METHOD_CONSISTENT : VOX_DEPTH_METHOD_CLOSEST);
            if (workers == 1) {
                expected[m] = keep_constraints(grid);
                ck_assert_uint_gt(expected[m].count, 4096);
            }
            same_constraints(grid, &expected[m]);
        }
        vox_grid_destroy(grid);
    }
    for (int m = 0; m < 2; ++m) free(expected[m].data);
    for (int b = 0; b < n; ++b) free_body(&bodies[b]);
}
END_TEST

/* ---- some pairs alone --------------------------------------------------------------------------- */

static int is_chosen(const world* w, const vox_pair* pair, const vox_constraint_desc* desc) {
    const vox_body a = pair->body_a, b = pair->body_b;
    if (desc->body_a && a != desc->body_a && b != desc->body_a) return 0;
    if (desc->body_b && !(a == desc->body_a && b == desc->body_b) &&
        !(a == desc->body_b && b == desc->body_a))
        return 0;
    const uint64_t categories =
        w->models[index_of(w, a)].filter.category | w->models[index_of(w, b)].filter.category;
    return desc->mask == 0 || (desc->mask & categories) != 0;
}

/* Those of the chosen pairs are those of `all` that the chosen pairs have, and there are no others. */
static uint64_t check_chosen(const world* w, kept_constraints all, const vox_constraint_desc* desc) {
    const vox_constraint_view view = checked_constraints(w->grid);
    const vox_pair_view pairs = pairs_of(w->grid);
    uint64_t n = 0;
    ck_assert_uint_eq(view.pair_count, pairs.count);
    for (uint64_t i = 0; i < all.count; ++i) {
        if (!is_chosen(w, &pairs.data[all.data[i].pair], desc)) continue;
        ck_assert_uint_lt(n, view.count);
        ck_assert_mem_eq(&view.data[n++], &all.data[i], sizeof *all.data);
    }
    ck_assert_uint_eq(n, view.count);
    return n;
}

START_TEST(chosen_pairs) {
    static const vox_depth_method methods[] = {VOX_DEPTH_METHOD_CONSISTENT, VOX_DEPTH_METHOD_CLOSEST,
                                               VOX_DEPTH_METHOD_NONE};
    uint64_t random = 61, of_bodies = 0, of_pairs = 0, of_masks = 0, with_itself = 0;
    for (int scene = 0; scene < 16; ++scene) {
        world w = moving_world(&random);
        w.grid = grid_for(&w, suite_engine, scene % 2, 1);
        for (int step = 0; step < 3; ++step) {
            move_world(&w, &random);
            ck_ok(vox_grid_step(w.grid));
            vox_constraint_desc desc = vox_default_constraint_desc();
            desc.method = methods[(scene + step) % 3];
            ck_ok(vox_grid_find_constraints(w.grid, &desc));
            kept_constraints all = keep_constraints(w.grid);
            for (int a = 0; a < w.count; ++a) {
                desc.body_a = w.models[a].id;
                desc.body_b = VOX_NULL_BODY;
                ck_ok(vox_grid_find_constraints(w.grid, &desc));
                of_bodies += check_chosen(&w, all, &desc);
                for (int b = 0; b < w.count; ++b) {
                    desc.body_b = w.models[b].id;
                    ck_ok(vox_grid_find_constraints(w.grid, &desc));
                    *(a == b ? &with_itself : &of_pairs) += check_chosen(&w, all, &desc);
                }
                desc.body_b = VOX_NULL_BODY;
                desc.mask = (uint64_t)1 << random_below(&random, most_bodies);
                ck_ok(vox_grid_find_constraints(w.grid, &desc));
                of_masks += check_chosen(&w, all, &desc);
                desc.body_a = VOX_NULL_BODY;
                ck_ok(vox_grid_find_constraints(w.grid, &desc));
                of_masks += check_chosen(&w, all, &desc);
                desc.mask = 0;
            }
            /* All of them again, by another way. */
            desc.mask = UINT64_MAX;
            ck_ok(vox_grid_find_constraints(w.grid, &desc));
            ck_assert_uint_eq(check_chosen(&w, all, &desc), all.count);
            free(all.data);
        }
        end_world(&w);
    }
    ck_assert_uint_gt(of_bodies, 5000);
    ck_assert_uint_gt(of_pairs, 5000);
    ck_assert_uint_gt(of_masks, 5000);
    ck_assert_uint_gt(with_itself, 10);
}
END_TEST

/* A budget is for the pairs that were asked for. */
START_TEST(budget_of_chosen_pairs) {
    vox_grid_desc settings = engine_desc();
    world w = two_in_each_other(3, &settings);
    body third = make_box(3, 1, 0.4f, -1.2f, 0.3f);
    vox_mesh_desc mesh = body_desc(&third);
    mesh.filter.category = 2;
    const vox_body other = insert_mesh(w.grid, &mesh);
    ck_ok(vox_grid_step(w.grid));
    for (int by_mask = 0; by_mask < 2; ++by_mask) {
        vox_constraint_desc desc = vox_default_constraint_desc();
        desc.method = VOX_DEPTH_METHOD_CLOSEST;
        if (by_mask)
            desc.mask = 2;
        else
            desc.body_a = other, desc.body_b = w.models[1].id;
        ck_ok(vox_grid_find_constraints(w.grid, &desc));
        const uint64_t count = constraints_of(w.grid).count;
        ck_assert_uint_gt(count, 10);
        for (desc.closest_budget = 1; desc.closest_budget < count + 3; ++desc.closest_budget) {
            ck_ok(vox_grid_find_constraints(w.grid, &desc));
            const vox_constraint_view view = checked_constraints(w.grid);
            uint64_t unknown = 0;
            for (uint64_t i = 0; i < view.count; ++i) unknown += view.data[i].state == VOX_DEPTH_UNKNOWN;
            ck_assert_uint_eq(view.count, count);
            ck_assert_uint_eq(unknown, desc.closest_budget < count ? count - desc.closest_budget : 0);
            ck_assert_uint_eq(counters_of(w.grid).unknown_penetrations, unknown);
        }
    }
    end_world(&w);
    free_body(&third);
}
END_TEST

/* ---- `previous` --------------------------------------------------------------------------------- */

/* Bodies come and go, or move far, or rest. */
static void change_world(world* w, uint64_t* random) {
    const int b = (int)random_below(random, (uint32_t)w->count);
    model* m = &w->models[b];
    switch (random_below(random, 8)) {
    case 0: /* in the slot of another, perhaps */
        if (m->id) ck_ok(vox_body_remove(w->grid, m->id));
        m->id = m->id ? VOX_NULL_BODY : insert_model(w->grid, w, b);
        break;
    case 1:
        if (m->id) ck_ok(vox_body_set_enabled(w->grid, m->id, random_below(random, 2)));
        break;
    case 2:
        break;
    default:
        move_world(w, random);
    }
}

/* A step that fails in between changes nothing. */
static void fail_step(world* w) {
    for (int b = 0; b < w->count; ++b) {
        model* m = &w->models[b];
        vox_body_info info;
        info.struct_size = sizeof info;
        if (!m->id || m->doubles) continue;
        ck_ok(vox_body_get_info(w->grid, m->id, &info));
        if (!info.enabled) continue;
        const float was = m->shape.positions[0];
        m->shape.positions[0] = NAN;
        ck_fails(vox_grid_step(w->grid), VOX_ERROR_NON_FINITE, "not finite");
        m->shape.positions[0] = was;
    }
}

START_TEST(previous_by_definition) {
    uint64_t random = 71, same = 0, changed = 0, fresh = 0;
    for (int scene = 0; scene < 24; ++scene) {
        kept_constraints kept = {NULL, 0};
        world w = moving_world(&random);
        w.grid = grid_for(&w, suite_engine, scene % 2, 1 + (uint32_t)scene % 3);
        for (int step = 0; step < 12; ++step) {
            change_world(&w, &random);
            if (step % 5 == 4) fail_step(&w);
            ck_ok(vox_grid_step(w.grid));
            if (scene % 2 == 0) ck_ok(vox_grid_find_constraints(w.grid, NULL));
            const vox_constraint_view view = checked_constraints(w.grid);
            check_previous(w.grid, &kept);
            for (uint64_t i = 0; i < view.count; ++i) {
                const vox_constraint* c = &view.data[i];
                if (c->previous == VOX_NONE)
                    ++fresh;
                else
                    ++*(kept.data[c->previous].kind == c->kind ? &same : &changed);
            }
            /* Those that were found last are what the next step compares with. */
            vox_constraint_desc desc = vox_default_constraint_desc();
            desc.mask = random_below(&random, 3) ? 0 : (uint64_t)1 << random_below(&random, most_bodies);
            if (step % 3 == 2) {
                ck_ok(vox_grid_find_constraints(w.grid, &desc));
                check_previous(w.grid, &kept);
            }
            free(kept.data);
            kept = keep_constraints(w.grid);
        }
        free(kept.data);
        end_world(&w);
    }
    ck_assert_uint_gt(same, 5000);
    ck_assert_uint_gt(changed, 200);
    ck_assert_uint_gt(fresh, 5000);
}
END_TEST

/* At first and after clearing, all are new. */
START_TEST(new_ones) {
    vox_grid_desc desc = depth_desc();
    world w = two_in_each_other(2, &desc);
    for (int round = 0; round < 2; ++round) {
        for (int step = 0; step < 2; ++step) {
            ck_ok(vox_grid_step(w.grid));
            const vox_constraint_view view = constraints_of(w.grid);
            ck_assert_uint_gt(view.count, 5);
            for (uint64_t i = 0; i < view.count; ++i)
                ck_assert_uint_eq(view.data[i].previous, step == 0 ? VOX_NONE : (uint32_t)i);
        }
        ck_ok(vox_grid_clear(w.grid));
        insert_models(w.grid, &w);
    }
    end_world(&w);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, formula_stencils_and_order, method_none, flag_or_call, many_bodies_and_workers,
                   chosen_pairs, budget_of_chosen_pairs, previous_by_definition, new_ones);
}

SUITE(constraints) { add_for_each_engine(suite, add_tests); }
