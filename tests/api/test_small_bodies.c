/* Many bodies of a few tetrahedra. */
#include <math.h>
#include <string.h>

#include "scenes/bodies.h"
#include "scenes/random.h"
#include "support/constraint_checks.h"

enum { corners = 4 };
static const uint32_t one_tet[4] = {0, 1, 2, 3};

static void place_tet(float* p, float x, float y, float z) {
    const float at[12] = {x, y, z, x + 1, y, z, x, y + 1, z, x, y, z + 1};
    memcpy(p, at, sizeof at);
}

static vox_mesh_desc tet_desc(const float* positions) {
    vox_mesh_desc desc = vox_default_mesh_desc();
    desc.positions.data = positions;
    desc.positions.count = corners;
    desc.tets = one_tet;
    desc.tet_count = 1;
    return desc;
}

/* A million bodies of one tetrahedron fit in the default byte budget. */
START_TEST(bytes_of_a_body) {
    enum { count = 20000 };
    float* positions = malloc(sizeof(float) * 12 * count);
    vox_grid* grid = engine_grid();
    const uint64_t before = counters_of(grid).bytes;
    for (int i = 0; i < count; ++i) {
        place_tet(positions + 12 * i, 2 * (float)i, 0, 0);
        const vox_mesh_desc desc = tet_desc(positions + 12 * i);
        insert_mesh(grid, &desc);
    }
    ck_ok(vox_grid_step(grid));
    const grid_counts counters = counters_of(grid);
    ck_assert_uint_eq(counters.bodies, count);
    ck_assert_uint_eq(counters.vertices, 4 * count);
    ck_assert_uint_eq(counters.tets, count);
    ck_assert_uint_eq(counters.contacts, 0);
    if (suite_engine == ENGINE_FAST)
        ck_assert_uint_le((counters.peak_bytes - before) / count, (4ull << 30) / 1000000);
    vox_grid_destroy(grid);
    free(positions);
}
END_TEST

/* Bodies that wander, rest, meet and part, are cut, grow, turn into doubles, and get transforms and filters,
 * beside large ones: the same contacts as from a grid that has forgotten all it knew, and as by the reference
 * engine. */
START_TEST(contacts_of_wandering_bodies) {
    enum { count = 400, steps = 60 };
    uint64_t random = 7;
    static float at[count][15];
    static double as_doubles[count][15];
    vox_grid_desc desc = engine_desc(), reference_desc = vox_default_grid_desc();
    use_engine(&reference_desc, ENGINE_REFERENCE);
    desc.flags = reference_desc.flags = VOX_GRID_CONSTRAINTS;
    vox_grid *grid = grid_of(&desc), *reference = grid_of(&reference_desc);
    vox_grid* grids[2] = {grid, reference};
    vox_body meshes[2][count + 1];
    int grown[count] = {0}, has_doubles[count] = {0};
    body floor = make_box(4, 1, -2, -2, -2);
    const vox_mesh_desc of_floor = body_desc(&floor);
    for (int i = 0; i < count; ++i) {
        place_tet(at[i], (float)(20 * random_unit(&random)), (float)(20 * random_unit(&random)),
                  (float)(4 * random_unit(&random)));
        memcpy(at[i] + 12, at[i], 3 * sizeof(float));
    }
    for (int g = 0; g < 2; ++g) {
        for (int i = 0; i < count; ++i) {
            if (i == count / 2) meshes[g][count] = insert_mesh(grids[g], &of_floor);
            const vox_mesh_desc of_tet = tet_desc(at[i]);
            meshes[g][i] = insert_mesh(grids[g], &of_tet);
        }
    }
    uint64_t contacts = 0, rested = 0;
    for (int step = 0; step < steps; ++step) {
        const int rests = step % 4 == 1 || step % 4 == 2; /* in the second of these that is known */
        for (int i = 0; i < count; ++i) {
            if (rests || random_below(&random, 3) > 0) continue;
            const float by[3] = {(float)(random_unit(&random) - 0.5), (float)(random_unit(&random) - 0.5),
                                 (float)(random_unit(&random) - 0.5)};
            for (int k = 0; k < 15; ++k) at[i][k] += by[k % 3], as_doubles[i][k] = at[i][k];
        }
        if (!rests) {
            const int i = (int)random_below(&random, count), other = (int)random_below(&random, count);
            uint32_t first = 0;
            const uint32_t tet = 0, kind = random_below(&random, 8);
            for (int k = 0; k < 15; ++k) as_doubles[i][k] = at[i][k];
            const double turn[12] = {0, 1, 0, 0.25, 1, 0, 0, 0, 0, 0, 1, 0};
            vox_filter filter = plain_filter();
            filter.group = -(int32_t)random_below(&random, 2);
            vox_vertices_desc more = vox_default_vertices_desc();
            more.count = 1;
            more.positions = has_doubles[i] ? vox_double_positions(as_doubles[i], corners + 1)
                                            : vox_float_positions(at[i], corners + 1);
            for (int g = 0; g < 2; ++g) {
                if (kind == 0) ck_ok(vox_mesh_set_tets_enabled(grids[g], meshes[g][i], &tet, 1, 0));
                if (kind == 1) ck_ok(vox_mesh_set_tets_enabled(grids[g], meshes[g][i], &tet, 1, 1));
                if (kind == 2) ck_ok(vox_body_set_transform(grids[g], meshes[g][i], step % 2 ? turn : NULL));
                if (kind == 3 && !grown[i])
                    ck_ok(vox_mesh_append_vertices(grids[g], meshes[g][i], &more, &first));
                if (kind == 4) ck_ok(vox_body_set_filter(grids[g], meshes[g][i], &filter));
                if (kind == 5)
                    ck_ok(bind_array(grids[g], meshes[g][i], as_doubles[i], VOX_FORMAT_DOUBLE, 24, 0));
                if (kind == 6 && i != other)
                    ck_ok(vox_grid_set_pair_enabled(grids[g], meshes[g][i], meshes[g][other],
                                                    (uint32_t)step % 2));
                if (kind == 7) ck_ok(vox_body_set_enabled(grids[g], meshes[g][i], (uint32_t)step % 2));
            }
            if (kind == 3) grown[i] = 1;
            if (kind == 5) has_doubles[i] = 1;
            if (step == 20) {
                ck_ok(vox_body_remove(grids[0], meshes[0][i]));
                ck_ok(vox_body_remove(grids[1], meshes[1][i]));
                for (int g = 0; g < 2; ++g) {
                    const vox_mesh_desc of_tet = tet_desc(at[i]);
                    meshes[g][i] = insert_mesh(grids[g], &of_tet);
                }
                grown[i] = has_doubles[i] = 0;
            }
        }
        const uint64_t hash = hash_of_step(grid), expected = hash_of_step(reference);
        ck_assert_msg(hash == expected, "step %d", step);
        const grid_counts found = counters_of(grid), by_reference = counters_of(reference);
        ck_assert_uint_eq(found.bodies, by_reference.bodies);
        ck_assert_uint_eq(found.vertices, by_reference.vertices);
        ck_assert_uint_eq(found.tets, by_reference.tets);
        contacts += found.contacts;
        const kept_constraints kept = keep_constraints(reference);
        same_constraints(grid, &kept);
        ck_assert_uint_eq(kept.count > 0, found.contacts > 0);
        free(kept.data);
        if (step % 4 == 2 && suite_engine == ENGINE_FAST) {
            ck_assert_msg(found.moved_bodies == 0, "step %d: %llu moved", step,
                          (unsigned long long)found.moved_bodies);
            ck_assert_uint_eq(found.carried_contacts, found.contacts);
            ++rested;
        }
    }
    ck_assert_uint_gt(contacts, 1000);
    if (suite_engine == ENGINE_FAST) ck_assert_uint_gt(rested, 10);
    vox_grid_destroy(grid);
    vox_grid_destroy(reference);
    free_body(&floor);
}
END_TEST

/* A body that leaves, and comes back to where it was when a step last compared it, has moved. */
START_TEST(coming_back) {
    enum { count = 100 };
    static float at[count][12];
    vox_grid* grid = engine_grid();
    for (int i = 0; i < count; ++i) {
        place_tet(at[i], 5 * (float)i, 0, 0);
        const vox_mesh_desc desc = tet_desc(at[i]);
        insert_mesh(grid, &desc);
    }
    for (int round = 0; round < 4; ++round) {
        place_tet(at[0], 5.25f, 0.1f, 0.1f); /* in the second one */
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_gt(contacts_of(grid).count, 0);
        place_tet(at[0], -50.0f - (float)round, 0, 0);
        for (int steps = 0; steps < 1 + round; ++steps) {
            ck_ok(vox_grid_step(grid));
            ck_assert_uint_eq(contacts_of(grid).count, 0);
        }
    }
    vox_grid_destroy(grid);
}
END_TEST

/* A coordinate that is no number ends the step as ever, or leaves the body out. */
START_TEST(bad_positions) {
    enum { count = 100 };
    static float at[count][12];
    for (int skip = 0; skip < 2; ++skip) {
        vox_grid_desc grid_desc = engine_desc();
        if (skip) grid_desc.flags |= VOX_GRID_SKIP_BAD_BODIES;
        vox_grid* grid = grid_of(&grid_desc);
        vox_body bad = VOX_NULL_BODY;
        for (int i = 0; i < count; ++i) {
            place_tet(at[i], 5 * (float)i, 0, 0);
            const vox_mesh_desc desc = tet_desc(at[i]);
            const vox_body mesh = insert_mesh(grid, &desc);
            if (i == 70) bad = mesh;
        }
        ck_ok(vox_grid_step(grid));
        at[70][4] = NAN;
        const vox_result result = vox_grid_step(grid);
        vox_failure failure;
        failure.struct_size = sizeof failure;
        ck_ok(vox_grid_get_failure(grid, 0, &failure));
        ck_assert_uint_eq(failure.body, bad);
        ck_assert_uint_eq(failure.vertex, 1);
        ck_assert_int_eq(result, skip ? VOX_OK : VOX_ERROR_NON_FINITE);
        if (skip) ck_assert_uint_eq(counters_of(grid).bodies, count - 1);
        at[70][4] = 0;
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_eq(counters_of(grid).bodies, count);
        vox_grid_destroy(grid);
    }
}
END_TEST

/* What penetrations need goes with the flag. */
START_TEST(flags_give_memory_back) {
    static const uint32_t tets[8] = {0, 1, 2, 3, 3, 2, 1, 0};
    static float at[8][12];
    vox_grid_desc desc = engine_desc();
    desc.flags &= ~(uint32_t)VOX_GRID_CONSTRAINTS;
    vox_grid* grid = grid_of(&desc);
    for (int i = 0; i < 8; ++i) {
        place_tet(at[i], 3 * (float)i, 0, 0);
        const vox_mesh_desc of_tets = vox_mesh_desc_floats(at[i], corners, tets + 4 * (i / 4), 1);
        insert_mesh(grid, &of_tets);
    }
    const uint64_t before = counters_of(grid).bytes;
    for (int round = 0; round < 2; ++round) {
        ck_ok(vox_grid_set_flags(grid, VOX_GRID_CONSTRAINTS));
        ck_assert_uint_gt(counters_of(grid).bytes, before);
        ck_ok(vox_grid_set_flags(grid, 0));
        ck_assert_uint_eq(counters_of(grid).bytes, before);
    }
    /* And with the flag again, penetrations are found. */
    place_tet(at[0], 3.25f, 0.125f, 0.125f);
    ck_ok(vox_grid_set_flags(grid, VOX_GRID_CONSTRAINTS));
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_gt(counters_of(grid).penetrations, 0);
    vox_grid_destroy(grid);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, bytes_of_a_body, contacts_of_wandering_bodies, coming_back, bad_positions,
                   flags_give_memory_back);
}

SUITE(small_bodies) { add_for_each_engine(suite, add_tests); }
