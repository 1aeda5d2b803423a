/* A pair that may have only some constraints (vox_grid_desc.max_constraints_per_pair): which of them stay, by
 * definition, from all of them, which a grid without a limit finds. */
#include "support/constraint_scenes.h"
#include "support/shape_checks.h"
#include "support/snapshot_checks.h"

enum { shape_count = 4 };

static vox_grid* grid_with(engine_kind engine, uint32_t flags, uint32_t workers, uint32_t most) {
    vox_grid_desc desc = vox_default_grid_desc();
    use_engine(&desc, engine);
    desc.flags = VOX_GRID_EDGES | flags;
    desc.worker_count = workers;
    desc.margin = 0.2;
    desc.max_constraints_per_pair = most;
    return grid_of(&desc);
}

static void insert_shapes(vox_grid* grid) {
    const vox_shape_desc all[shape_count] = {shape_desc(VOX_SHAPE_HALF_SPACE),
                                             round_shape(VOX_SHAPE_SPHERE, 0.8, 0), box_shape(0.5, 0.6, 0.7),
                                             cube_solid()};
    for (int i = 0; i < shape_count; ++i) {
        const double at[12] = {1, 0, 0, 0.5 * i, 0, 1, 0, 0.3, 0, 0, 1, 0.4 * i - 0.5};
        const vox_body shape = insert_shape(grid, &all[i]);
        ck_ok(vox_body_set_transform(grid, shape, at));
    }
}

static double apart(const vox_constraint* a, const vox_constraint* b) {
    const double x = a->position[0] - b->position[0], y = a->position[1] - b->position[1],
                 z = a->position[2] - b->position[2];
    return x * x + y * y + z * z;
}

/* Of candidate i: how far from the nearest one that stays; or, if none does yet, how deep. */
static double merit(const vox_constraint* all, uint64_t count, const char* stays, uint64_t i) {
    double least = INFINITY;
    for (uint64_t k = 0; k < count; ++k)
        if (stays[k] && apart(&all[i], &all[k]) < least) least = apart(&all[i], &all[k]);
    return least < INFINITY ? least : -all[i].gap;
}

static void choose(const vox_constraint* all, uint64_t count, uint32_t most, char* stays) {
    memset(stays, most < count ? 0 : 1, (size_t)count);
    for (uint32_t n = 0; n < most && most < count; ++n) {
        uint64_t best = count;
        for (int near = 0; near < 2 && best == count; ++near)
            for (uint64_t i = 0; i < count; ++i)
                if (!stays[i] && (all[i].kind == VOX_CONSTRAINT_PROXIMITY) == near &&
                    (best == count || merit(all, count, stays, i) > merit(all, count, stays, best)))
                    best = i;
        stays[best] = 1;
    }
}

/* The constraints of `grid` are those of `whole` that stay, in their order. Returns how many were left out.
 */
static uint64_t check_limit(const vox_grid* grid, const vox_grid* whole, uint32_t most, uint64_t* by_kind) {
    const vox_constraint_view now = constraints_of(grid), all = constraints_of(whole);
    uint64_t at = 0, left_out = 0;
    ck_assert_uint_eq(now.pair_count, all.pair_count);
    for (uint64_t p = 0; p < all.pair_count; ++p) {
        const vox_constraint* const of = all.data + all.pair_offsets[p];
        const uint64_t count = all.pair_offsets[p + 1] - all.pair_offsets[p];
        char* const stays = (char*)malloc((size_t)count + 1);
        choose(of, count, most, stays);
        ck_assert_uint_eq(now.pair_offsets[p], at);
        for (uint64_t i = 0; i < count; ++i) {
            if (!stays[i]) continue;
            ck_assert_uint_lt(at, now.count);
            vox_constraint expected = of[i];
            expected.previous = now.data[at].previous;
            expected.left_out = count > most ? count - most : 0;
            if (expected.left_out) ++by_kind[expected.kind];
            ck_assert_mem_eq(&expected, &now.data[at++], sizeof expected);
        }
        left_out += count > most ? count - most : 0;
        free(stays);
    }
    ck_assert_uint_eq(now.count, at);
    ck_assert_uint_eq(now.pair_offsets[now.pair_count], at);
    ck_assert_uint_eq(counter_of(grid, "constraints"), at);
    ck_assert_uint_eq(counter_of(grid, "constraints_left_out"), left_out);
    ck_assert_uint_eq(counter_of(whole, "constraints_left_out"), 0);
    return left_out;
}

static void check_pairs(const vox_grid* grid, const vox_grid* whole) {
    const vox_pair_view a = pairs_of(grid), b = pairs_of(whole);
    ck_assert_uint_eq(a.count, b.count);
    if (a.count) ck_assert_mem_eq(a.data, b.data, a.count * sizeof *a.data);
    const vox_contact_view x = contacts_of(grid), y = contacts_of(whole);
    ck_assert_uint_eq(x.count, y.count);
    if (x.count) ck_assert_mem_eq(x.data, y.data, x.count * sizeof *x.data);
}

/* Bodies move, some rest, and all rest; with shapes among them, for any number of workers, and after a
 * snapshot. */
START_TEST(by_definition) {
    static const uint32_t limits[6] = {1, 2, 4, 8, 30, VOX_MAX_CONSTRAINTS_PER_PAIR};
    uint64_t random = 5, left_out[6] = {0}, by_kind[4] = {0}, carried = 0, same = 0;
    for (int scene = 0; scene < 18; ++scene) {
        const uint32_t most = limits[scene % 6], in_step = scene % 3 != 0;
        world w = moving_world(&random);
        w.grid = grid_with(suite_engine, VOX_GRID_CONSTRAINTS, 1, 0);
        vox_grid* grid = grid_with(suite_engine, in_step, 1 + (uint32_t)scene % 4, most);
        vox_grid* const grids[2] = {w.grid, grid};
        for (int g = 0; g < 2; ++g) {
            insert_models(grids[g], &w);
            if (scene % 2) insert_shapes(grids[g]);
        }
        kept_constraints kept = {NULL, 0};
        for (int step = 0; step < 8; ++step) {
            if (step % 4 < 2) move_world(&w, &random);
            if (step % 4 == 2)
                for (uint32_t i = 0; i < 3 * w.models[0].shape.vertex_count; ++i)
                    w.models[0].shape.positions[i] += 0.03125f;
            for (int g = 0; g < 2; ++g) ck_ok(vox_grid_step(grids[g]));
            if (!in_step) ck_ok(vox_grid_find_constraints(grid, NULL));
            check_pairs(grid, w.grid);
            left_out[scene % 6] += check_limit(grid, w.grid, most, by_kind);
            check_previous(grid, &kept);
            free(kept.data);
            kept = keep_constraints(grid);
            for (uint64_t i = 0; i < kept.count; ++i)
                same += kept.data[i].left_out && kept.data[i].previous != VOX_NONE;
            carried += counter_of(grid, "carried_penetrations");
            for (int m = VOX_DEPTH_METHOD_CLOSEST; step % 4 == 1 && m <= VOX_DEPTH_METHOD_NONE; ++m) {
                vox_constraint_desc desc = vox_default_constraint_desc();
                desc.method = (vox_depth_method)m;
                for (int g = 0; g < 2; ++g) ck_ok(vox_grid_find_constraints(grids[g], &desc));
                check_limit(grid, w.grid, most, by_kind);
            }
            for (int g = 0; g < 2; ++g) ck_ok(vox_grid_find_constraints(grids[g], NULL));
        }
        free(kept.data);
        vox_grid_destroy(grid);
        end_world(&w);
    }
    for (int i = 0; i < 6; ++i) ck_assert(i == 5 || left_out[i] > 100);
    for (int kind = 0; kind < 4; ++kind) ck_assert_uint_gt(by_kind[kind], 10);
    ck_assert_uint_gt(same, 500);
    if (suite_engine == ENGINE_FAST) ck_assert_uint_gt(carried, 100);
}
END_TEST

/* A snapshot keeps the limit. */
START_TEST(in_snapshots) {
    vox_grid_desc desc = depth_desc();
    desc.max_constraints_per_pair = 5;
    world w = two_in_each_other(3, &desc);
    ck_ok(vox_grid_step(w.grid));
    kept_constraints kept = keep_constraints(w.grid);
    ck_assert_uint_eq(kept.count, 5);
    const file f = save(w.grid);
    vox_grid* loaded = load(f, suite_engine);
    ck_ok(vox_grid_step(loaded));
    ck_assert_uint_eq(pairs_of(loaded).count, 1);
    same_constraints(loaded, &kept);
    put(payload(f, "GRID", 0) + 84, 4, VOX_MAX_CONSTRAINTS_PER_PAIR + 1);
    seal(f);
    refused(f, VOX_ERROR_FORMAT, "max_constraints_per_pair is 257, expected at most 256");
    free(f.bytes);
    free(kept.data);
    vox_grid_destroy(loaded);
    end_world(&w);
}
END_TEST

static void add_tests(TCase* tests) { tcase_add_each(tests, by_definition, in_snapshots); }

SUITE(constraint_limit) { add_for_each_engine(suite, add_tests); }
