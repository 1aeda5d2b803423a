/* Queries between steps against brute force over every tetrahedron: exact where the answer is exact. */
#include <pthread.h>

#include "support/oracle.h"
#include "support/query_checks.h"

/* The hits of one point by definition; returns how many. */
static size_t hits_by_definition(const world* w, const float p[3], uint64_t mask, vox_point_hit* hits) {
    size_t count = 0;
    for (int b = 0; b < w->count; ++b) {
        if (!(mask >> b & 1)) continue;
        const size_t begin = count;
        int interior = 0;
        for (uint32_t t = 0; t < w->bodies[b].tet_count; ++t) {
            const float* corners[4];
            corners_of(&w->bodies[b], t, corners);
            if (apart(p, p, corners, 4)) continue;
            const oracle_containment where = oracle_locate(p, corners);
            if (where != ORACLE_INTERIOR && (where != ORACLE_BOUNDARY || interior || count > begin)) continue;
            if (where == ORACLE_INTERIOR && !interior)
                count = begin; /* what was on a boundary does not count */
            interior |= where == ORACLE_INTERIOR;
            double weights[4];
            oracle_barycentric(p, corners, weights);
            vox_point_hit hit = {0, w->meshes[b], t, {0}};
            for (int c = 0; c < 4; ++c) hit.barycentric[c] = (float)weights[c];
            hits[count++] = hit;
        }
    }
    return count;
}

static void check_hits(const vox_point_hit* found, const vox_point_hit* expected, size_t count,
                       uint32_t point) {
    for (size_t i = 0; i < count; ++i) {
        ck_assert_uint_eq(found[i].point, point);
        ck_assert_uint_eq(found[i].mesh, expected[i].mesh);
        ck_assert_uint_eq(found[i].tet, expected[i].tet);
        for (int c = 0; c < 4; ++c)
            ck_assert_float_le(fabsf(found[i].barycentric[c] - expected[i].barycentric[c]), 1e-5f);
    }
}

START_TEST(points_by_definition) {
    enum { n = 200 };
    uint64_t random = 3, all = 0;
    static vox_point_hit expected[4096], found[4096], together[16384];
    for (int scene = 0; scene < 24; ++scene) {
        const int coarse = scene % 2;
        world w = new_world(&random, coarse);
        const uint64_t mask = scene % 3 ? UINT64_MAX : random_next(&random);
        float points[n][4]; /* three and a hole */
        double exact[n][3];
        for (int i = 0; i < n; ++i) {
            random_point(&random, coarse, points[i]);
            for (int axis = 0; axis < 3; ++axis) exact[i][axis] = (double)points[i][axis];
        }
        uint64_t total = 0, count = 0, next = 0;
        ck_ok(vox_grid_query_points(w.grid, points, VOX_FORMAT_FLOAT, sizeof points[0], n, mask, together,
                                    16384, &total));
        ck_assert_uint_le(total, 16384);
        for (uint32_t i = 0; i < n; ++i) {
            const size_t wanted = hits_by_definition(&w, points[i], mask, expected);
            ck_ok(vox_grid_query_point(w.grid, exact[i], mask, found, 4096, &count));
            ck_assert_uint_eq(count, wanted);
            check_hits(found, expected, wanted, 0);
            ck_assert_uint_le(next + wanted, total);
            check_hits(together + next, expected, wanted, i);
            for (size_t h = 0; h < wanted; ++h) /* the same bits */
                ck_assert_mem_eq(together[next + h].barycentric, found[h].barycentric,
                                 sizeof found[h].barycentric);
            next += wanted;
        }
        ck_assert_uint_eq(next, total);
        all += total;
        /* The same as doubles, and with room for some. */
        vox_point_hit* some = (vox_point_hit*)calloc(total + 1, sizeof *some);
        ck_ok(vox_grid_query_points(w.grid, exact, VOX_FORMAT_DOUBLE, 0, n, mask, some, total / 2, &count));
        ck_assert_uint_eq(count, total);
        ck_assert_mem_eq(some, together, total / 2 * sizeof *some);
        ck_assert_uint_eq(some[total / 2].mesh, 0);
        free(some);
        end_world(&w);
    }
    ck_assert_uint_gt(all, 200);
}
END_TEST

/* Points that no float is: between a facet and the next float on either side. */
START_TEST(points_in_double) {
    const double in[3] = {0.25, 0.25, 1e-300}, out[3] = {0.25, 0.25, -1e-300}, on[3] = {0.25, 0.25, 0};
    vox_grid_desc desc = engine_desc();
    vox_grid* grid = grid_of(&desc);
    const vox_mesh_desc tet = vox_mesh_desc_floats(unit_tet_positions, 4, unit_tet, 1);
    insert_mesh(grid, &tet);
    ck_ok(vox_grid_prepare_queries(grid));
    uint64_t count = 9;
    ck_ok(vox_grid_query_point(grid, in, UINT64_MAX, NULL, 0, &count));
    ck_assert_uint_eq(count, 1);
    ck_ok(vox_grid_query_point(grid, on, UINT64_MAX, NULL, 0, &count));
    ck_assert_uint_eq(count, 1);
    ck_ok(vox_grid_query_point(grid, out, UINT64_MAX, NULL, 0, &count));
    ck_assert_uint_eq(count, 0);
    vox_grid_destroy(grid);
}
END_TEST

START_TEST(boxes_by_definition) {
    uint64_t random = 4, all = 0;
    static vox_tet_hit found[8192];
    for (int scene = 0; scene < 40; ++scene) {
        world w = new_world(&random, scene % 2);
        for (int i = 0; i < 40; ++i) {
            float p[3], q[3];
            double min[3], max[3];
            const uint64_t mask = i % 3 ? UINT64_MAX : random_next(&random);
            random_point(&random, scene % 2, p);
            random_point(&random, scene % 2, q);
            for (int axis = 0; axis < 3; ++axis) {
                min[axis] =
                    (double)(i % 5 == 0 ? p[axis] : fminf(p[axis], q[axis])); /* a point now and then */
                max[axis] = (double)(i % 5 == 0 ? p[axis] : fmaxf(p[axis], q[axis]));
                if (i % 7 == 0) min[axis] = -INFINITY;
                if (i % 11 == 0) max[axis] = INFINITY;
            }
            uint64_t count = 0, next = 0;
            ck_ok(vox_grid_query_box(w.grid, min, max, mask, found, 8192, &count));
            for (int b = 0; b < w.count; ++b)
                for (uint32_t t = 0; t < w.bodies[b].tet_count && (mask >> b & 1); ++t) {
                    const float* corners[4];
                    int meets = 1;
                    corners_of(&w.bodies[b], t, corners);
                    for (int axis = 0; axis < 3; ++axis) {
                        float lo = corners[0][axis], hi = lo;
                        for (int c = 1; c < 4; ++c) {
                            lo = fminf(lo, corners[c][axis]);
                            hi = fmaxf(hi, corners[c][axis]);
                        }
                        meets &= (double)lo <= max[axis] && (double)hi >= min[axis];
                    }
                    if (!meets) continue;
                    ck_assert_uint_lt(next, count);
                    ck_assert_uint_eq(found[next].mesh, w.meshes[b]);
                    ck_assert_uint_eq(found[next++].tet, t);
                }
            ck_assert_uint_eq(next, count);
            all += count;
        }
        end_world(&w);
    }
    ck_assert_uint_gt(all, 5000);
}
END_TEST

static uint64_t count_at(const vox_grid* grid, const double p[3]) {
    uint64_t count = 0;
    ck_ok(vox_grid_query_point(grid, p, UINT64_MAX, NULL, 0, &count));
    return count;
}

/* Answers are about the moment of preparing. */
START_TEST(as_it_was_when_prepared) {
    const double inside[3] = {0.3, 0.4, 0.6}, far_away[3] = {10.3, 0.4, 0.6};
    body box = make_box(2, 1, 0, 0, 0);
    vox_grid_desc desc = engine_desc();
    vox_body other;
    uint64_t count = 77;
    vox_grid* grid = grid_of(&desc);
    ck_fails(vox_grid_query_point(grid, inside, 1, NULL, 0, &count), VOX_ERROR_INVALID_STATE,
             "prepare_queries");
    ck_assert_uint_eq(count, 77);
    ck_ok(vox_grid_prepare_queries(grid)); /* of nothing */
    ck_assert_uint_eq(count_at(grid, inside), 0);
    const vox_mesh_desc body = body_desc(&box);
    vox_body mesh = insert_mesh(grid, &body);
    ck_assert_uint_eq(count_at(grid, inside), 0);
    ck_ok(vox_grid_prepare_queries(grid)); /* before the first step */
    ck_assert_uint_eq(count_at(grid, inside), 1);
    for (uint32_t v = 0; v < box.vertex_count; ++v) box.positions[3 * v] += 10;
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(count_at(grid, inside), 1);
    ck_assert_uint_eq(count_at(grid, far_away), 0);
    ck_ok(vox_grid_prepare_queries(grid));
    ck_assert_uint_eq(count_at(grid, inside), 0);
    ck_assert_uint_eq(count_at(grid, far_away), 1);
    box.positions[0] = NAN; /* what fails leaves what was there */
    ck_fails(vox_grid_prepare_queries(grid), VOX_ERROR_NON_FINITE, "not finite");
    ck_assert_uint_eq(count_at(grid, far_away), 1);
    ck_ok(vox_body_remove(grid, mesh));
    ck_assert_uint_eq(count_at(grid, far_away), 1);
    box.positions[0] = 10;
    ck_ok(vox_mesh_insert(grid, &body, &other));
    ck_ok(vox_body_set_enabled(grid, other, 0));
    ck_ok(vox_grid_prepare_queries(grid));
    ck_assert_uint_eq(count_at(grid, far_away), 0);
    ck_ok(vox_grid_clear(grid));
    ck_fails(vox_grid_query_point(grid, inside, 1, NULL, 0, &count), VOX_ERROR_INVALID_STATE,
             "prepare_queries");
    vox_mesh_desc bare = body;
    bare.positions.data = NULL;
    ck_ok(vox_mesh_insert(grid, &bare, &mesh));
    ck_fails(vox_grid_prepare_queries(grid), VOX_ERROR_INVALID_STATE, "has no positions");
    vox_grid_destroy(grid);
    free_body(&box);
}
END_TEST

/* Many threads at once: queries and suggestions, of which the first look at the meshes, are reads. */
typedef struct asker {
    const world* w;
    uint64_t seed;
    uint64_t sum;
} asker;

static void* ask(void* context) {
    asker* a = (asker*)context;
    uint64_t random = a->seed;
    vox_suggestion suggestion;
    suggestion.struct_size = sizeof suggestion;
    if (vox_grid_suggest_cell_size(a->w->grid, NULL, &suggestion)) return NULL;
    a->sum = (uint64_t)(suggestion.cell_size * 1e9);
    for (int i = 0; i < 300; ++i) {
        float p[3], q[3];
        random_point(&random, 0, p);
        random_point(&random, 0, q);
        const double from[3] = {(double)p[0], (double)p[1], (double)p[2]},
                     to[3] = {(double)q[0], (double)q[1], (double)q[2]};
        vox_point_hit hits[8];
        vox_surface_hit closest;
        vox_ray_hit ray;
        uint64_t count = 0, boxes = 0;
        if (vox_grid_query_point(a->w->grid, from, UINT64_MAX, hits, 8, &count) ||
            vox_grid_query_box(a->w->grid, from, from, UINT64_MAX, NULL, 0, &boxes) ||
            vox_grid_query_closest(a->w->grid, from, 1, UINT64_MAX, &closest) ||
            vox_grid_query_ray(a->w->grid, from, to, UINT64_MAX, &ray))
            return NULL;
        a->sum = a->sum * 31 + count + boxes + closest.tet + ray.tet + ray.surface_tet;
    }
    return context;
}

START_TEST(many_threads) {
    uint64_t random = 8;
    world w = new_world(&random, 0);
    asker askers[4];
    pthread_t threads[4];
    for (int i = 0; i < 4; ++i) {
        askers[i] = (asker){&w, 17, 0};
        ck_assert_int_eq(pthread_create(&threads[i], NULL, ask, &askers[i]), 0);
    }
    for (int i = 0; i < 4; ++i) {
        void* done = NULL;
        ck_assert_int_eq(pthread_join(threads[i], &done), 0);
        ck_assert_ptr_nonnull(done);
    }
    for (int i = 1; i < 4; ++i) ck_assert_uint_eq(askers[i].sum, askers[0].sum);
    ck_assert_uint_ne(askers[0].sum, 0);
    end_world(&w);
}
END_TEST

START_TEST(arguments) {
    uint64_t random = 9, count = 77;
    world w = new_world(&random, 0);
    const double p[3] = {1, 1, 1}, q[3] = {0, 2, 2}, nan_point[3] = {0, NAN, 0}, huge[3] = {0, 0, 4e38};
    vox_point_hit hit;
    vox_tet_hit tet;
    vox_surface_hit surface;
    vox_ray_hit ray;
    const float floats[3] = {1, 1, INFINITY};
    ck_fails(vox_grid_prepare_queries(NULL), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_query_point(NULL, p, 1, &hit, 1, &count), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_query_point(w.grid, NULL, 1, &hit, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "point is null");
    ck_fails(vox_grid_query_point(w.grid, p, 1, NULL, 1, &count), VOX_ERROR_INVALID_ARGUMENT, "hits is null");
    ck_fails(vox_grid_query_point(w.grid, p, 1, &hit, 1, NULL), VOX_ERROR_INVALID_ARGUMENT,
             "out_count is null");
    ck_fails(vox_grid_query_point(w.grid, nan_point, 1, &hit, 1, &count), VOX_ERROR_NON_FINITE,
             "point is (0, nan, 0)");
    ck_fails(vox_grid_query_point(w.grid, huge, 1, &hit, 1, &count), VOX_ERROR_LIMIT, "4e+38");
    ck_fails(vox_grid_query_points(NULL, p, VOX_FORMAT_DOUBLE, 0, 1, 1, &hit, 1, &count),
             VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_query_points(w.grid, NULL, VOX_FORMAT_DOUBLE, 0, 1, 1, &hit, 1, &count),
             VOX_ERROR_INVALID_ARGUMENT, "points is null");
    ck_fails(vox_grid_query_points(w.grid, p, VOX_FORMAT_DOUBLE, 0, 1, 1, NULL, 1, &count),
             VOX_ERROR_INVALID_ARGUMENT, "hits is null");
    ck_fails(vox_grid_query_points(w.grid, p, VOX_FORMAT_DOUBLE, 0, 1, 1, &hit, 1, NULL),
             VOX_ERROR_INVALID_ARGUMENT, "out_count is null");
    ck_fails(vox_grid_query_points(w.grid, p, (vox_format)7, 0, 1, 1, &hit, 1, &count),
             VOX_ERROR_INVALID_ARGUMENT, "7");
    ck_fails(vox_grid_query_points(w.grid, p, VOX_FORMAT_DOUBLE, 23, 1, 1, &hit, 1, &count),
             VOX_ERROR_INVALID_ARGUMENT, "23");
    ck_fails(vox_grid_query_points(w.grid, p, VOX_FORMAT_DOUBLE, 24, 1ull << 32, 1, &hit, 1, &count),
             VOX_ERROR_LIMIT, "4294967296");
    ck_fails(vox_grid_query_points(w.grid, floats, VOX_FORMAT_FLOAT, 0, 1, 1, &hit, 1, &count),
             VOX_ERROR_NON_FINITE, "point 0 is (1, 1, inf)");
    ck_ok(vox_grid_query_points(w.grid, NULL, VOX_FORMAT_FLOAT, 0, 0, 1, NULL, 0, &count));
    ck_assert_uint_eq(count, 0);
    count = 77;
    ck_fails(vox_grid_query_box(NULL, p, p, 1, &tet, 1, &count), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_query_box(w.grid, NULL, p, 1, &tet, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "min is null");
    ck_fails(vox_grid_query_box(w.grid, p, NULL, 1, &tet, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "max is null");
    ck_fails(vox_grid_query_box(w.grid, p, p, 1, NULL, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "hits is null");
    ck_fails(vox_grid_query_box(w.grid, p, p, 1, &tet, 1, NULL), VOX_ERROR_INVALID_ARGUMENT,
             "out_count is null");
    ck_fails(vox_grid_query_box(w.grid, p, q, 1, &tet, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "[1, 0] on axis 0");
    ck_fails(vox_grid_query_box(w.grid, nan_point, q, 1, &tet, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "on axis 1");
    ck_fails(vox_grid_query_closest(NULL, p, 1, 1, &surface), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_query_closest(w.grid, NULL, 1, 1, &surface), VOX_ERROR_INVALID_ARGUMENT,
             "point is null");
    ck_fails(vox_grid_query_closest(w.grid, p, 1, 1, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_hit is null");
    ck_fails(vox_grid_query_closest(w.grid, p, -1, 1, &surface), VOX_ERROR_INVALID_ARGUMENT, "radius is -1");
    ck_fails(vox_grid_query_closest(w.grid, p, NAN, 1, &surface), VOX_ERROR_INVALID_ARGUMENT, "radius is");
    ck_fails(vox_grid_query_ray(NULL, p, q, 1, &ray), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_query_ray(w.grid, NULL, q, 1, &ray), VOX_ERROR_INVALID_ARGUMENT, "from is null");
    ck_fails(vox_grid_query_ray(w.grid, p, NULL, 1, &ray), VOX_ERROR_INVALID_ARGUMENT, "to is null");
    ck_fails(vox_grid_query_ray(w.grid, p, q, 1, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_hit is null");
    ck_fails(vox_grid_query_ray(w.grid, p, nan_point, 1, &ray), VOX_ERROR_NON_FINITE, "to is");
    ck_assert_uint_eq(count, 77);
    end_world(&w);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, points_by_definition, points_in_double, boxes_by_definition,
                   as_it_was_when_prepared, many_threads, arguments);
}

SUITE(queries) { add_for_each_engine(suite, add_tests); }
