/* Queries for the surface, the closest point of it and what a segment meets, against brute force over every
 * tetrahedron. */
#include "support/oracle.h"
#include "support/query_checks.h"

static const uint32_t facet_corners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

/* Whether a facet belongs to no other tetrahedron of the body. */
static int on_surface(const body* b, uint32_t tet, int facet) {
    for (uint32_t t = 0; t < b->tet_count; ++t) {
        int shared = 0;
        for (int i = 0; i < 3 && t != tet; ++i)
            for (int c = 0; c < 4; ++c)
                shared += b->tets[4 * t + c] == b->tets[4 * tet + facet_corners[facet][i]];
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
                for (int c = 0; c < 3; ++c)
                    at_axis += hit.barycentric[c] * (double)corners[facet_corners[hit.facet][c]][axis];
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
            if (i % 10 == 0) memcpy(q, p, sizeof q);  /* a point */
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
                        if (hit.surface_mesh == w.meshes[b] && hit.surface_tet == t &&
                            hit.surface_facet == (uint32_t)facet)
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
                    at += hit.surface_barycentric[c] *
                          (double)corners[facet_corners[hit.surface_facet][c]][axis];
                ck_assert_double_le(fabs(at - (from[axis] + hit.surface_t * (to[axis] - from[axis]))), 1e-6);
            }
            /* Into the tetrahedron when the end the segment comes from is on the other side of the facet than
             * the fourth corner. */
            const uint32_t* f = facet_corners[hit.surface_facet];
            const int inner =
                oracle_orientation(corners[f[0]], corners[f[1]], corners[f[2]], corners[hit.surface_facet]);
            const int before = oracle_orientation(corners[f[0]], corners[f[1]], corners[f[2]], p);
            const int after = oracle_orientation(corners[f[0]], corners[f[1]], corners[f[2]], q);
            const vox_side side = inner == 0                           ? VOX_SIDE_NONE
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

static void add_tests(TCase* tests) { tcase_add_each(tests, closest_by_definition, rays_by_definition); }

int main(void) {
    Suite* suite = suite_create("query surfaces");
    add_for_each_engine(suite, add_tests);
    return run_suite(suite);
}
