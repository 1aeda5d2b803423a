/* Queries between steps against brute force over every tetrahedron: exact where the answer is exact. */
#include <math.h>
#include <pthread.h>
#include <string.h>

#include "bodies.h"
#include "oracle.h"
#include "random.h"
#include "suite.h"

enum { most_bodies = 4 };

typedef struct world {
    vox_grid* grid;
    body bodies[most_bodies];
    vox_mesh meshes[most_bodies];
    int count;
} world;

/* Boxes that overlap each other; by quarters of an edge when `coarse`, so that points fall on facets, edges, corners. */
static world new_world(uint64_t* random, int coarse) {
    world w;
    vox_grid_desc desc = vox_default_grid_desc();
    memset(&w, 0, sizeof w);
    desc.engine = suite_engine;
    desc.flags = 0;
    ck_ok(vox_grid_create(&desc, &w.grid));
    w.count = 1 + (int)random_below(random, most_bodies);
    for (int b = 0; b < w.count; ++b) {
        float at[3];
        for (int axis = 0; axis < 3; ++axis) at[axis] = 0.5f * (float)random_below(random, 6);
        const uint32_t cubes = 1 + random_below(random, 3);
        const float edge = coarse ? 1 : random_float(random, 0.5f, 1);
        w.bodies[b] = make_box(cubes, edge, at[0], at[1], at[2]);
        for (uint32_t i = 0; i < 3 * w.bodies[b].vertex_count; ++i) {
            const float moved = random_float(random, -0.25f, 0.25f);
            w.bodies[b].positions[i] += coarse ? 0.25f * roundf(4 * moved) * (float)(random_below(random, 4) == 0) : moved;
        }
        vox_mesh_desc mesh = body_desc(&w.bodies[b]);
        vox_filter filter = vox_default_filter();
        filter.category = 1u << b;
        mesh.filter = &filter;
        ck_ok(vox_mesh_insert(w.grid, &mesh, &w.meshes[b]));
    }
    ck_ok(vox_grid_prepare_queries(w.grid));
    return w;
}

static void end_world(world* w) {
    vox_grid_destroy(w->grid);
    for (int b = 0; b < w->count; ++b) free_body(&w->bodies[b]);
}

static void random_point(uint64_t* random, int coarse, float p[3]) {
    for (int axis = 0; axis < 3; ++axis)
        p[axis] = coarse ? 0.25f * (float)random_below(random, 28) - 0.5f : random_float(random, -0.5f, 6.5f);
}

static void corners_of(const body* b, uint32_t tet, const float* corners[4]) {
    for (int c = 0; c < 4; ++c) corners[c] = b->positions + 3 * b->tets[4 * tet + c];
}

/* Whether the boxes of a segment and of some points have nothing in common: a short cut for the exact arithmetic. */
static int apart(const float* from, const float* to, const float* const* points, int count) {
    for (int axis = 0; axis < 3; ++axis) {
        float lo = points[0][axis], hi = lo;
        for (int i = 1; i < count; ++i) {
            lo = fminf(lo, points[i][axis]);
            hi = fmaxf(hi, points[i][axis]);
        }
        if (fminf(from[axis], to[axis]) > hi || fmaxf(from[axis], to[axis]) < lo) return 1;
    }
    return 0;
}

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
            if (where == ORACLE_INTERIOR && !interior) count = begin; /* what was on a boundary does not count */
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

static void check_hits(const vox_point_hit* found, const vox_point_hit* expected, size_t count, uint32_t point) {
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
        ck_ok(vox_grid_query_points(w.grid, points, VOX_FORMAT_FLOAT3, sizeof points[0], n, mask, together, 16384, &total));
        ck_assert_uint_le(total, 16384);
        for (uint32_t i = 0; i < n; ++i) {
            const size_t wanted = hits_by_definition(&w, points[i], mask, expected);
            ck_ok(vox_grid_query_point(w.grid, exact[i], mask, found, 4096, &count));
            ck_assert_uint_eq(count, wanted);
            check_hits(found, expected, wanted, 0);
            ck_assert_uint_le(next + wanted, total);
            check_hits(together + next, expected, wanted, i);
            for (size_t h = 0; h < wanted; ++h) /* the same bits */
                ck_assert_mem_eq(together[next + h].barycentric, found[h].barycentric, sizeof found[h].barycentric);
            next += wanted;
        }
        ck_assert_uint_eq(next, total);
        all += total;
        /* The same as doubles, and with room for some. */
        vox_point_hit* some = (vox_point_hit*)calloc(total + 1, sizeof *some);
        ck_ok(vox_grid_query_points(w.grid, exact, VOX_FORMAT_DOUBLE3, 0, n, mask, some, total / 2, &count));
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
    vox_grid_desc desc = vox_default_grid_desc();
    vox_grid* grid = NULL;
    vox_mesh mesh;
    desc.engine = suite_engine;
    ck_ok(vox_grid_create(&desc, &grid));
    const vox_mesh_desc tet = array_desc(unit_tet_positions, 4, unit_tet, 1);
    ck_ok(vox_mesh_insert(grid, &tet, &mesh));
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
                min[axis] = (double)(i % 5 == 0 ? p[axis] : fminf(p[axis], q[axis])); /* a point now and then */
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

static const uint32_t facet_corners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

/* Whether a facet belongs to no other tetrahedron of the body. */
static int on_surface(const body* b, uint32_t tet, int facet) {
    for (uint32_t t = 0; t < b->tet_count; ++t) {
        int shared = 0;
        for (int i = 0; i < 3 && t != tet; ++i)
            for (int c = 0; c < 4; ++c) shared += b->tets[4 * t + c] == b->tets[4 * tet + facet_corners[facet][i]];
        if (shared == 3) return 0;
    }
    return 1;
}

/* The surface of each body, found once: bit i of a byte for facet i of a tetrahedron. */
static uint8_t* surface_of(const body* b) {
    uint8_t* bits = (uint8_t*)calloc(b->tet_count, 1);
    for (uint32_t t = 0; t < b->tet_count; ++t)
        for (int facet = 0; facet < 4; ++facet) bits[t] |= (uint8_t)(on_surface(b, t, facet) << facet);
    return bits;
}

static double distance_to_segment(const double p[3], const float* a, const float* b) {
    double along = 0, length = 0, squared = 0;
    for (int i = 0; i < 3; ++i) {
        const double e = (double)b[i] - (double)a[i];
        along += (p[i] - (double)a[i]) * e;
        length += e * e;
    }
    double t = length > 0 ? along / length : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    for (int i = 0; i < 3; ++i) {
        const double d = p[i] - ((double)a[i] + t * ((double)b[i] - (double)a[i]));
        squared += d * d;
    }
    return sqrt(squared);
}

/* By the edges, and the plane where p's foot has weights >= 0 (Cramer's rule on the edges' products). */
static double distance_to_triangle(const double p[3], const float* const v[3]) {
    double best = INFINITY, uu = 0, uv = 0, vv = 0, pu = 0, pv = 0, squared = 0;
    for (int i = 0; i < 3; ++i) best = fmin(best, distance_to_segment(p, v[i], v[(i + 1) % 3]));
    for (int i = 0; i < 3; ++i) {
        const double a = (double)v[0][i], e = (double)v[1][i] - a, f = (double)v[2][i] - a, d = p[i] - a;
        uu += e * e, uv += e * f, vv += f * f, pu += d * e, pv += d * f;
    }
    const double det = uu * vv - uv * uv, s = (pu * vv - pv * uv) / det, t = (pv * uu - pu * uv) / det;
    if (!(det > 0 && s >= 0 && t >= 0 && s + t <= 1)) return best;
    for (int i = 0; i < 3; ++i) {
        const double a = (double)v[0][i];
        const double d = p[i] - (a + s * ((double)v[1][i] - a) + t * ((double)v[2][i] - a));
        squared += d * d;
    }
    return fmin(best, sqrt(squared));
}

static int index_of(const world* w, vox_mesh mesh) {
    for (int b = 0; b < w->count; ++b)
        if (w->meshes[b] == mesh) return b;
    ck_abort_msg("mesh %u is none of the world's", mesh);
    return -1;
}

START_TEST(closest_by_definition) {
    uint64_t random = 5, found = 0, none = 0;
    for (int scene = 0; scene < 24; ++scene) {
        world w = new_world(&random, scene % 2);
        uint8_t* surfaces[most_bodies];
        for (int b = 0; b < w.count; ++b) surfaces[b] = surface_of(&w.bodies[b]);
        for (int i = 0; i < 60; ++i) {
            float at[3];
            random_point(&random, scene % 2, at);
            const uint64_t mask = i % 3 ? UINT64_MAX : random_next(&random);
            const double p[3] = {(double)at[0], (double)at[1], (double)at[2]};
            const double radius = i % 4 == 0 ? INFINITY : (double)random_float(&random, 0, 1);
            double best = INFINITY;
            for (int b = 0; b < w.count; ++b)
                for (uint32_t t = 0; t < w.bodies[b].tet_count && (mask >> b & 1); ++t)
                    for (int facet = 0; facet < 4; ++facet) {
                        if (!(surfaces[b][t] >> facet & 1)) continue;
                        const float* corners[4];
                        corners_of(&w.bodies[b], t, corners);
                        const float* const triangle[3] = {corners[facet_corners[facet][0]],
                                                          corners[facet_corners[facet][1]],
                                                          corners[facet_corners[facet][2]]};
                        best = fmin(best, distance_to_triangle(p, triangle));
                    }
            vox_surface_hit hit;
            memset(&hit, 0xaa, sizeof hit);
            ck_ok(vox_grid_query_closest(w.grid, p, radius, mask, &hit));
            if (fabs(best - radius) < 1e-9) continue; /* rounding decides */
            if (best > radius || best == INFINITY) {
                const vox_surface_hit zero = {0};
                ck_assert_mem_eq(&hit, &zero, sizeof hit);
                ++none;
                continue;
            }
            ++found;
            ck_assert_double_le(fabs(hit.distance - best), 1e-9);
            const int b = index_of(&w, hit.mesh);
            ck_assert_uint_eq(mask >> b & 1, 1);
            ck_assert_uint_eq(surfaces[b][hit.tet] >> hit.facet & 1, 1);
            const float* corners[4];
            corners_of(&w.bodies[b], hit.tet, corners);
            double squared = 0, sum = 0;
            for (int c = 0; c < 3; ++c) {
                ck_assert_double_ge(hit.barycentric[c], -1e-12);
                sum += hit.barycentric[c];
            }
            ck_assert_double_le(fabs(sum - 1), 1e-9);
            for (int axis = 0; axis < 3; ++axis) {
                double at_axis = 0;
                for (int c = 0; c < 3; ++c) at_axis += hit.barycentric[c] * (double)corners[facet_corners[hit.facet][c]][axis];
                ck_assert_double_le(fabs(at_axis - hit.position[axis]), 1e-9);
                squared += (at_axis - p[axis]) * (at_axis - p[axis]);
            }
            ck_assert_double_le(fabs(sqrt(squared) - best), 1e-9);
        }
        for (int b = 0; b < w.count; ++b) free(surfaces[b]);
        end_world(&w);
    }
    ck_assert_uint_gt(found, 200);
    ck_assert_uint_gt(none, 50);
}
END_TEST

/* t of where a segment meets a triangle that it is not in the plane of, or infinity; exact but for t. */
static double crossing(const float from[3], const float to[3], const float* const v[3]) {
    const int s = oracle_orientation(v[0], v[1], v[2], from), e = oracle_orientation(v[0], v[1], v[2], to);
    int positive = 0, negative = 0;
    if (s == e) return INFINITY;
    for (int i = 0; i < 3; ++i) {
        const int side = oracle_orientation(from, to, v[i], v[(i + 1) % 3]);
        positive |= side > 0;
        negative |= side < 0;
    }
    if (positive && negative) return INFINITY;
    double n[3], before = 0, after = 0;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        n[i] = ((double)v[1][j] - (double)v[0][j]) * ((double)v[2][k] - (double)v[0][k]) -
               ((double)v[1][k] - (double)v[0][k]) * ((double)v[2][j] - (double)v[0][j]);
    }
    for (int i = 0; i < 3; ++i) {
        before += n[i] * ((double)from[i] - (double)v[0][i]);
        after += n[i] * ((double)to[i] - (double)v[0][i]);
    }
    return before / (before - after);
}

START_TEST(rays_by_definition) {
    uint64_t random = 6, met = 0, missed = 0, crossed = 0;
    for (int scene = 0; scene < 24; ++scene) {
        world w = new_world(&random, scene % 2);
        uint8_t* surfaces[most_bodies];
        for (int b = 0; b < w.count; ++b) surfaces[b] = surface_of(&w.bodies[b]);
        for (int i = 0; i < 150; ++i) {
            float p[3], q[3];
            random_point(&random, scene % 2, p);
            random_point(&random, scene % 2, q);
            if (i % 10 == 0) memcpy(q, p, sizeof q); /* a point */
            if (i % 4 == 1) q[1] = p[1], q[2] = p[2]; /* along an axis */
            const uint64_t mask = i % 3 ? UINT64_MAX : random_next(&random);
            const double from[3] = {(double)p[0], (double)p[1], (double)p[2]};
            const double to[3] = {(double)q[0], (double)q[1], (double)q[2]};
            double first_tet = INFINITY, first_facet = INFINITY, of_hit = INFINITY, of_facet = INFINITY;
            vox_ray_hit hit;
            memset(&hit, 0xaa, sizeof hit);
            ck_ok(vox_grid_query_ray(w.grid, from, to, mask, &hit));
            for (int b = 0; b < w.count; ++b)
                for (uint32_t t = 0; t < w.bodies[b].tet_count && (mask >> b & 1); ++t) {
                    const float* corners[4];
                    corners_of(&w.bodies[b], t, corners);
                    if (apart(p, q, corners, 4)) continue;
                    const oracle_containment where = oracle_locate(p, corners);
                    double enters = where == ORACLE_INTERIOR || where == ORACLE_BOUNDARY ? 0 : INFINITY;
                    for (int facet = 0; facet < 4; ++facet) {
                        const float* const triangle[3] = {corners[facet_corners[facet][0]],
                                                          corners[facet_corners[facet][1]],
                                                          corners[facet_corners[facet][2]]};
                        const double at = crossing(p, q, triangle);
                        if (where != ORACLE_DEGENERATE) enters = fmin(enters, at);
                        if (!(surfaces[b][t] >> facet & 1)) continue;
                        first_facet = fmin(first_facet, at);
                        if (hit.surface_mesh == w.meshes[b] && hit.surface_tet == t && hit.surface_facet == (uint32_t)facet)
                            of_facet = at;
                    }
                    first_tet = fmin(first_tet, enters);
                    if (hit.mesh == w.meshes[b] && hit.tet == t) of_hit = enters;
                }
            if (first_tet == INFINITY) {
                const vox_ray_hit zero = {0};
                ck_assert_mem_eq(&hit, &zero, sizeof hit);
                ++missed;
                continue;
            }
            ++met;
            ck_assert_uint_ne(hit.mesh, VOX_NULL_MESH);
            ck_assert_double_le(fabs(hit.t - first_tet), 1e-9);
            ck_assert_double_le(fabs(of_hit - first_tet), 1e-9);
            if (first_tet == 0) ck_assert_double_eq(hit.t, 0);
            ck_assert_int_eq(hit.surface_mesh != VOX_NULL_MESH, first_facet != INFINITY);
            if (first_facet == INFINITY) continue;
            ++crossed;
            ck_assert_double_le(fabs(hit.surface_t - first_facet), 1e-9);
            ck_assert_double_le(fabs(of_facet - first_facet), 1e-9);
            const float* corners[4];
            corners_of(&w.bodies[index_of(&w, hit.surface_mesh)], hit.surface_tet, corners);
            for (int axis = 0; axis < 3; ++axis) { /* the weights say where, too */
                double at = 0;
                for (int c = 0; c < 3; ++c)
                    at += hit.surface_barycentric[c] * (double)corners[facet_corners[hit.surface_facet][c]][axis];
                ck_assert_double_le(fabs(at - (from[axis] + hit.surface_t * (to[axis] - from[axis]))), 1e-6);
            }
            /* Into the tetrahedron when the end the segment comes from is on the other side of the facet than the
             * fourth corner. */
            const uint32_t* f = facet_corners[hit.surface_facet];
            const int inner = oracle_orientation(corners[f[0]], corners[f[1]], corners[f[2]], corners[hit.surface_facet]);
            const int before = oracle_orientation(corners[f[0]], corners[f[1]], corners[f[2]], p);
            const int after = oracle_orientation(corners[f[0]], corners[f[1]], corners[f[2]], q);
            const vox_side side = inner == 0 ? VOX_SIDE_NONE
                                  : before == -inner || after == inner ? VOX_SIDE_ENTERS
                                                                       : VOX_SIDE_LEAVES;
            ck_assert_int_eq(hit.surface_side, side);
        }
        for (int b = 0; b < w.count; ++b) free(surfaces[b]);
        end_world(&w);
    }
    ck_assert_uint_gt(met, 400);
    ck_assert_uint_gt(missed, 50);
    ck_assert_uint_gt(crossed, 400);
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
    vox_grid_desc desc = vox_default_grid_desc();
    vox_grid* grid = NULL;
    vox_mesh mesh, other;
    uint64_t count = 77;
    desc.engine = suite_engine;
    ck_ok(vox_grid_create(&desc, &grid));
    ck_fails(vox_grid_query_point(grid, inside, 1, NULL, 0, &count), VOX_ERROR_INVALID_STATE, "prepare_queries");
    ck_assert_uint_eq(count, 77);
    ck_ok(vox_grid_prepare_queries(grid)); /* of nothing */
    ck_assert_uint_eq(count_at(grid, inside), 0);
    const vox_mesh_desc body = body_desc(&box);
    ck_ok(vox_mesh_insert(grid, &body, &mesh));
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
    ck_ok(vox_mesh_remove(grid, mesh));
    ck_assert_uint_eq(count_at(grid, far_away), 1);
    box.positions[0] = 10;
    ck_ok(vox_mesh_insert(grid, &body, &other));
    ck_ok(vox_mesh_set_enabled(grid, other, 0));
    ck_ok(vox_grid_prepare_queries(grid));
    ck_assert_uint_eq(count_at(grid, far_away), 0);
    ck_ok(vox_grid_clear(grid));
    ck_fails(vox_grid_query_point(grid, inside, 1, NULL, 0, &count), VOX_ERROR_INVALID_STATE, "prepare_queries");
    vox_mesh_desc bare = body;
    bare.positions = NULL;
    ck_ok(vox_mesh_insert(grid, &bare, &mesh));
    ck_fails(vox_grid_prepare_queries(grid), VOX_ERROR_INVALID_STATE, "has no positions");
    vox_grid_destroy(grid);
    free_body(&box);
}
END_TEST

/* Many threads at once. */
typedef struct asker {
    const world* w;
    uint64_t seed;
    uint64_t sum;
} asker;

static void* ask(void* context) {
    asker* a = (asker*)context;
    uint64_t random = a->seed;
    for (int i = 0; i < 300; ++i) {
        float p[3], q[3];
        random_point(&random, 0, p);
        random_point(&random, 0, q);
        const double from[3] = {(double)p[0], (double)p[1], (double)p[2]}, to[3] = {(double)q[0], (double)q[1], (double)q[2]};
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
    ck_fails(vox_grid_query_point(w.grid, NULL, 1, &hit, 1, &count), VOX_ERROR_INVALID_ARGUMENT, "point is null");
    ck_fails(vox_grid_query_point(w.grid, p, 1, NULL, 1, &count), VOX_ERROR_INVALID_ARGUMENT, "hits is null");
    ck_fails(vox_grid_query_point(w.grid, p, 1, &hit, 1, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_count is null");
    ck_fails(vox_grid_query_point(w.grid, nan_point, 1, &hit, 1, &count), VOX_ERROR_NON_FINITE, "point is (0, nan, 0)");
    ck_fails(vox_grid_query_point(w.grid, huge, 1, &hit, 1, &count), VOX_ERROR_LIMIT, "4e+38");
    ck_fails(vox_grid_query_points(NULL, p, VOX_FORMAT_DOUBLE3, 0, 1, 1, &hit, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "grid is null");
    ck_fails(vox_grid_query_points(w.grid, NULL, VOX_FORMAT_DOUBLE3, 0, 1, 1, &hit, 1, &count),
             VOX_ERROR_INVALID_ARGUMENT, "points is null");
    ck_fails(vox_grid_query_points(w.grid, p, VOX_FORMAT_DOUBLE3, 0, 1, 1, NULL, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "hits is null");
    ck_fails(vox_grid_query_points(w.grid, p, VOX_FORMAT_DOUBLE3, 0, 1, 1, &hit, 1, NULL), VOX_ERROR_INVALID_ARGUMENT,
             "out_count is null");
    ck_fails(vox_grid_query_points(w.grid, p, (vox_format)7, 0, 1, 1, &hit, 1, &count), VOX_ERROR_INVALID_ARGUMENT, "7");
    ck_fails(vox_grid_query_points(w.grid, p, VOX_FORMAT_DOUBLE3, 23, 1, 1, &hit, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "23");
    ck_fails(vox_grid_query_points(w.grid, p, VOX_FORMAT_DOUBLE3, 24, 1ull << 32, 1, &hit, 1, &count), VOX_ERROR_LIMIT,
             "4294967296");
    ck_fails(vox_grid_query_points(w.grid, floats, VOX_FORMAT_FLOAT3, 0, 1, 1, &hit, 1, &count), VOX_ERROR_NON_FINITE,
             "point 0 is (1, 1, inf)");
    ck_ok(vox_grid_query_points(w.grid, NULL, VOX_FORMAT_FLOAT3, 0, 0, 1, NULL, 0, &count));
    ck_assert_uint_eq(count, 0);
    count = 77;
    ck_fails(vox_grid_query_box(NULL, p, p, 1, &tet, 1, &count), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_query_box(w.grid, NULL, p, 1, &tet, 1, &count), VOX_ERROR_INVALID_ARGUMENT, "min is null");
    ck_fails(vox_grid_query_box(w.grid, p, NULL, 1, &tet, 1, &count), VOX_ERROR_INVALID_ARGUMENT, "max is null");
    ck_fails(vox_grid_query_box(w.grid, p, p, 1, NULL, 1, &count), VOX_ERROR_INVALID_ARGUMENT, "hits is null");
    ck_fails(vox_grid_query_box(w.grid, p, p, 1, &tet, 1, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_count is null");
    ck_fails(vox_grid_query_box(w.grid, p, q, 1, &tet, 1, &count), VOX_ERROR_INVALID_ARGUMENT, "[1, 0] on axis 0");
    ck_fails(vox_grid_query_box(w.grid, nan_point, q, 1, &tet, 1, &count), VOX_ERROR_INVALID_ARGUMENT, "on axis 1");
    ck_fails(vox_grid_query_closest(NULL, p, 1, 1, &surface), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_query_closest(w.grid, NULL, 1, 1, &surface), VOX_ERROR_INVALID_ARGUMENT, "point is null");
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
    tcase_add_test(tests, points_by_definition);
    tcase_add_test(tests, points_in_double);
    tcase_add_test(tests, boxes_by_definition);
    tcase_add_test(tests, closest_by_definition);
    tcase_add_test(tests, rays_by_definition);
    tcase_add_test(tests, as_it_was_when_prepared);
    tcase_add_test(tests, many_threads);
    tcase_add_test(tests, arguments);
}

int main(void) {
    Suite* suite = suite_create("queries");
    add_for_each_engine(suite, add_tests);
    return run_suite(suite);
}
