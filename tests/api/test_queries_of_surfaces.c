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

static int index_of(const world* w, vox_body mesh) {
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
    for (int scene = 0; scene < (int)volume_from("VOX_QUERY_SCENES", 8); ++scene) {
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
            ck_assert_uint_ne(hit.mesh, VOX_NULL_BODY);
            ck_assert_double_le(fabs(hit.t - first_tet), 1e-9);
            ck_assert_double_le(fabs(of_hit - first_tet), 1e-9);
            if (first_tet == 0) ck_assert_double_eq(hit.t, 0);
            ck_assert_int_eq(hit.surface_mesh != VOX_NULL_BODY, first_facet != INFINITY);
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
    ck_assert_uint_gt(met, 130);
    ck_assert_uint_gt(missed, 16);
    ck_assert_uint_gt(crossed, 130);
}
END_TEST

static vox_query_view* take_view(vox_grid* grid) {
    vox_query_view* view = NULL;
    ck_ok(vox_grid_take_query_view(grid, &view));
    return view;
}

/* Some meshes by their category, and now and then one of them, or none, left out. */
static uint64_t random_meshes(uint64_t* random, const world* w, vox_body* excluded) {
    const uint32_t which = random_below(random, 2 * (uint32_t)w->count);
    *excluded = which < (uint32_t)w->count ? w->meshes[which] : which % 2 ? VOX_NULL_BODY : 4095u << 12 | 1;
    return random_below(random, 3) ? UINT64_MAX : random_next(random);
}

static int takes_part(const world* w, int b, uint64_t mask, vox_body excluded) {
    return (int)(mask >> b & 1) && w->meshes[b] != excluded;
}

static double dot3(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* A unit vector, at right angles to the facet, away from the fourth corner or else from the point. */
static void check_normal(const body* b, const vox_closest_hit* hit, const float p[3]) {
    const float* corners[4];
    corners_of(b, hit->tet, corners);
    const uint32_t* f = facet_corners[hit->facet];
    double to_apex[3], to_point[3];
    ck_assert_double_le(fabs(dot3(hit->normal, hit->normal) - 1), 1e-12);
    for (int e = 1; e < 3; ++e) {
        double edge[3];
        for (int i = 0; i < 3; ++i) edge[i] = (double)corners[f[e]][i] - (double)corners[f[0]][i];
        ck_assert_double_le(fabs(dot3(hit->normal, edge)), 1e-9);
    }
    for (int i = 0; i < 3; ++i) {
        to_apex[i] = (double)corners[hit->facet][i] - (double)corners[f[0]][i];
        to_point[i] = (double)p[i] - (double)corners[f[0]][i];
    }
    if (oracle_orientation(corners[0], corners[1], corners[2], corners[3]) != 0)
        ck_assert_double_lt(dot3(hit->normal, to_apex), 0);
    else
        ck_assert_double_le(dot3(hit->normal, to_point), 1e-9);
}

START_TEST(closest_points_by_definition) {
    enum { n = 60 };
    uint64_t random = 11, found = 0, none = 0, negative = 0, several = 0;
    for (int scene = 0; scene < 30; ++scene) {
        world w = new_world(&random, scene % 2);
        vox_query_view* view = take_view(w.grid);
        uint8_t* surfaces[most_bodies];
        float points[n][4]; /* three and a hole */
        vox_closest_hit hits[n], again[n];
        for (int b = 0; b < w.count; ++b) surfaces[b] = surface_of(&w.bodies[b]);
        for (int i = 0; i < n; ++i) random_point(&random, scene % 2, points[i]);
        vox_closest_desc desc = vox_default_closest_desc();
        desc.points = points;
        desc.byte_stride = sizeof points[0];
        desc.point_count = n;
        desc.mask = random_meshes(&random, &w, &desc.excluded);
        if (desc.mask == 0) desc.mask = UINT64_MAX; /* as 0 means */
        desc.max_distance = INFINITY;
        if (scene % 4 == 0) desc.max_distance = (double)random_float(&random, 0, 1);
        memset(hits, 0xaa, sizeof hits);
        ck_ok(vox_grid_query_closest_points(w.grid, &desc, hits));
        ck_ok(vox_query_view_closest_points(view, &desc, again));
        ck_assert_mem_eq(hits, again, sizeof hits);
        for (int i = 0; i < n; ++i) {
            const double p[3] = {(double)points[i][0], (double)points[i][1], (double)points[i][2]};
            double best = INFINITY;
            uint32_t inside = 0;
            int inside_of_hit = 0;
            for (int b = 0; b < w.count; ++b) {
                int in_mesh = 0;
                const uint32_t tets = takes_part(&w, b, desc.mask, desc.excluded) ? w.bodies[b].tet_count : 0;
                for (uint32_t t = 0; t < tets; ++t) {
                    const float* corners[4];
                    corners_of(&w.bodies[b], t, corners);
                    if (!apart(points[i], points[i], corners, 4)) {
                        const oracle_containment where = oracle_locate(points[i], corners);
                        in_mesh |= where == ORACLE_INTERIOR || where == ORACLE_BOUNDARY;
                    }
                    for (int facet = 0; facet < 4; ++facet) {
                        if (!(surfaces[b][t] >> facet & 1)) continue;
                        const float* const triangle[3] = {corners[facet_corners[facet][0]],
                                                          corners[facet_corners[facet][1]],
                                                          corners[facet_corners[facet][2]]};
                        best = fmin(best, distance_to_triangle(p, triangle));
                    }
                }
                inside += (uint32_t)in_mesh;
                if (hits[i].mesh == w.meshes[b]) inside_of_hit = in_mesh;
            }
            ck_assert_uint_eq(hits[i].inside, inside);
            several += inside > 1;
            if (fabs(best - desc.max_distance) < 1e-9) continue; /* rounding decides */
            if (best > desc.max_distance || best == INFINITY) {
                vox_closest_hit zero = {0};
                zero.inside = inside;
                ck_assert_mem_eq(&hits[i], &zero, sizeof zero);
                ++none;
                continue;
            }
            ++found;
            const int b = index_of(&w, hits[i].mesh);
            ck_assert(takes_part(&w, b, desc.mask, desc.excluded));
            ck_assert_uint_eq(surfaces[b][hits[i].tet] >> hits[i].facet & 1, 1);
            ck_assert_double_le(fabs(fabs(hits[i].distance) - best), 1e-9);
            ck_assert_int_eq(signbit(hits[i].distance) != 0, inside_of_hit && hits[i].distance != 0);
            negative += hits[i].distance < 0;
            check_normal(&w.bodies[b], &hits[i], points[i]);
            /* The same as one by one, as far as that goes. */
            vox_surface_hit one;
            uint64_t categories = desc.mask;
            for (int other = 0; other < w.count; ++other)
                if (w.meshes[other] == desc.excluded) categories &= ~(1ull << other);
            ck_ok(vox_query_view_closest(view, p, desc.max_distance, categories, &one));
            ck_assert_uint_eq(one.mesh, hits[i].mesh);
            ck_assert_uint_eq(one.tet, hits[i].tet);
            ck_assert_uint_eq(one.facet, hits[i].facet);
            ck_assert_mem_eq(one.barycentric, hits[i].barycentric, sizeof one.barycentric);
            ck_assert_mem_eq(one.position, hits[i].position, sizeof one.position);
            ck_assert(one.distance == fabs(hits[i].distance));
        }
        for (int b = 0; b < w.count; ++b) free(surfaces[b]);
        vox_query_view_release(view);
        end_world(&w);
    }
    ck_assert_uint_gt(found, 400);
    ck_assert_uint_gt(none, 50);
    ck_assert_uint_gt(negative, 30);
    ck_assert_uint_gt(several, 10);
}
END_TEST

START_TEST(all_hits_by_definition) {
    enum { most = 4096 };
    static vox_facet_hit hits[most], again[most];
    uint64_t random = 12, all = 0, entered = 0, left = 0, met = 0, missed = 0;
    for (int scene = 0; scene < (int)volume_from("VOX_QUERY_SCENES", 8); ++scene) {
        world w = new_world(&random, scene % 2);
        vox_query_view* view = take_view(w.grid);
        uint8_t* surfaces[most_bodies];
        for (int b = 0; b < w.count; ++b) surfaces[b] = surface_of(&w.bodies[b]);
        for (int i = 0; i < 100; ++i) {
            float p[3], q[3];
            random_point(&random, scene % 2, p);
            random_point(&random, scene % 2, q);
            if (i % 10 == 0) memcpy(q, p, sizeof q);  /* a point */
            if (i % 4 == 1) q[1] = p[1], q[2] = p[2]; /* along an axis */
            vox_body excluded;
            const uint64_t mask = random_meshes(&random, &w, &excluded);
            const double from[3] = {(double)p[0], (double)p[1], (double)p[2]};
            const double to[3] = {(double)q[0], (double)q[1], (double)q[2]};
            uint64_t count = 0, count_again = 0, expected = 0;
            uint32_t any = 7, any_again = 7;
            ck_ok(vox_grid_query_ray_hits(w.grid, from, to, mask, excluded, hits, most, &count));
            ck_ok(vox_query_view_ray_hits(view, from, to, mask, excluded, again, most, &count_again));
            ck_ok(vox_grid_query_ray_any(w.grid, from, to, mask, excluded, &any));
            ck_ok(vox_query_view_ray_any(view, from, to, mask, excluded, &any_again));
            ck_assert_uint_eq(count, count_again);
            ck_assert_uint_le(count, most);
            ck_assert_mem_eq(hits, again, count * sizeof *hits);
            ck_assert_uint_eq(any, any_again);
            int meets = 0;
            for (int b = 0; b < w.count; ++b)
                for (uint32_t t = 0; t < w.bodies[b].tet_count && takes_part(&w, b, mask, excluded); ++t) {
                    const float* corners[4];
                    corners_of(&w.bodies[b], t, corners);
                    if (apart(p, q, corners, 4)) continue;
                    const oracle_containment where = oracle_locate(p, corners);
                    meets |= where == ORACLE_INTERIOR || where == ORACLE_BOUNDARY;
                    for (uint32_t facet = 0; facet < 4; ++facet) {
                        const uint32_t* f = facet_corners[facet];
                        const float* const triangle[3] = {corners[f[0]], corners[f[1]], corners[f[2]]};
                        const double at = crossing(p, q, triangle);
                        if (at == INFINITY) continue;
                        meets |= where != ORACLE_DEGENERATE;
                        if (!(surfaces[b][t] >> facet & 1)) continue;
                        ++expected;
                        const vox_facet_hit* hit = NULL;
                        for (uint64_t h = 0; h < count; ++h)
                            if (hits[h].mesh == w.meshes[b] && hits[h].tet == t && hits[h].facet == facet)
                                hit = &hits[h];
                        ck_assert_ptr_nonnull(hit);
                        ck_assert_double_le(fabs(hit->t - at), 1e-9);
                        const int inner =
                            oracle_orientation(triangle[0], triangle[1], triangle[2], corners[facet]);
                        const int before = oracle_orientation(triangle[0], triangle[1], triangle[2], p);
                        const int after = oracle_orientation(triangle[0], triangle[1], triangle[2], q);
                        const vox_side side = inner == 0                           ? VOX_SIDE_NONE
                                              : before == -inner || after == inner ? VOX_SIDE_ENTERS
                                                                                   : VOX_SIDE_LEAVES;
                        ck_assert_int_eq(hit->side, side);
                        entered += side == VOX_SIDE_ENTERS;
                        left += side == VOX_SIDE_LEAVES;
                        for (int axis = 0; axis < 3; ++axis) { /* the weights say where, too */
                            double sum = 0;
                            for (int c = 0; c < 3; ++c)
                                sum += hit->barycentric[c] * (double)triangle[c][axis];
                            ck_assert_double_le(fabs(sum - (from[axis] + hit->t * (to[axis] - from[axis]))),
                                                1e-6);
                        }
                    }
                }
            ck_assert_uint_eq(count, expected);
            ck_assert_uint_eq(any, (uint32_t)meets);
            met += any;
            missed += !any;
            all += count;
            for (uint64_t h = 1; h < count; ++h) {
                const vox_facet_hit *x = &hits[h - 1], *y = &hits[h];
                const int same_mesh = x->t == y->t && x->mesh == y->mesh,
                          same_tet = same_mesh && x->tet == y->tet;
                ck_assert(x->t < y->t || (x->t == y->t && x->mesh < y->mesh) ||
                          (same_mesh && x->tet < y->tet) || (same_tet && x->facet < y->facet));
            }
            if (excluded == VOX_NULL_BODY && count > 0) { /* the first one is that of the other query */
                vox_ray_hit first;
                ck_ok(vox_query_view_ray(view, from, to, mask, &first));
                ck_assert_uint_eq(first.surface_mesh, hits[0].mesh);
                ck_assert_uint_eq(first.surface_tet, hits[0].tet);
                ck_assert_uint_eq(first.surface_facet, hits[0].facet);
                ck_assert(first.surface_t == hits[0].t);
                ck_assert_int_eq(first.surface_side, hits[0].side);
            }
            if (count > 1) { /* room for some */
                memset(again, 0, sizeof again[0] * 2);
                ck_ok(vox_grid_query_ray_hits(w.grid, from, to, mask, excluded, again, 1, &count_again));
                ck_assert_uint_eq(count_again, count);
                ck_assert_mem_eq(again, hits, sizeof again[0]);
                ck_assert_uint_eq(again[1].mesh, VOX_NULL_BODY);
            }
        }
        for (int b = 0; b < w.count; ++b) free(surfaces[b]);
        vox_query_view_release(view);
        end_world(&w);
    }
    ck_assert_uint_gt(all, 200);
    ck_assert_uint_gt(entered, 70);
    ck_assert_uint_gt(left, 70);
    ck_assert_uint_gt(met, 100);
    ck_assert_uint_gt(missed, 100);
}
END_TEST

/* A flat tetrahedron, one without any area, and a point on them. */
START_TEST(normals_without_volume) {
    static const float flat[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    static const float line[] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0};
    static const double above[3] = {0.25, 0.25, 2}, below[3] = {0.25, 0.25, -2};
    static const double beside[3] = {1, 0, 3}, on[3] = {1, 0, 0};
    static const struct {
        const float* positions;
        const double *point, normal[3];
    } cases[] = {{flat, above, {0, 0, -1}},
                 {flat, below, {0, 0, 1}},
                 {line, beside, {0, 0, -1}},
                 {line, on, {0, 0, 1}}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        vox_grid* grid = engine_grid();
        const vox_mesh_desc mesh = vox_mesh_desc_floats(cases[i].positions, 4, unit_tet, 1);
        insert_mesh(grid, &mesh);
        ck_ok(vox_grid_prepare_queries(grid));
        vox_closest_desc desc = vox_default_closest_desc();
        vox_closest_hit hit;
        desc.points = cases[i].point;
        desc.format = VOX_FORMAT_DOUBLE;
        desc.point_count = 1;
        ck_ok(vox_grid_query_closest_points(grid, &desc, &hit));
        ck_assert_uint_ne(hit.mesh, VOX_NULL_BODY);
        ck_assert_uint_eq(hit.inside, 0);
        for (int axis = 0; axis < 3; ++axis) ck_assert_double_eq(hit.normal[axis], cases[i].normal[axis]);
        vox_grid_destroy(grid);
    }
}
END_TEST

START_TEST(arguments) {
    uint64_t random = 9, count = 77;
    world w = new_world(&random, 0);
    vox_query_view* view = take_view(w.grid);
    const double p[3] = {1, 1, 1}, nan_point[3] = {0, NAN, 0}, huge[3] = {0, 0, 4e38};
    const float floats[6] = {1, 1, 1, 1, 1, NAN};
    vox_closest_desc desc = vox_default_closest_desc();
    vox_closest_hit hit;
    vox_facet_hit facet;
    vox_ray_hit ray;
    uint32_t any = 77;
    ck_assert_uint_eq(desc.struct_size, sizeof desc);
    ck_fails(vox_grid_query_closest_points(NULL, &desc, &hit), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_query_view_closest_points(NULL, &desc, &hit), VOX_ERROR_INVALID_ARGUMENT, "view is null");
    ck_fails(vox_grid_query_closest_points(w.grid, NULL, &hit), VOX_ERROR_INVALID_ARGUMENT, "desc is null");
    ck_ok(vox_grid_query_closest_points(w.grid, &desc, NULL)); /* of no points */
    desc.point_count = 2;
    ck_fails(vox_grid_query_closest_points(w.grid, &desc, &hit), VOX_ERROR_INVALID_ARGUMENT,
             "points is null");
    desc.points = floats;
    ck_fails(vox_grid_query_closest_points(w.grid, &desc, NULL), VOX_ERROR_INVALID_ARGUMENT,
             "out_hits is null");
    ck_fails(vox_grid_query_closest_points(w.grid, &desc, &hit), VOX_ERROR_NON_FINITE, "point 1 is (1, 1, ");
    desc.point_count = 1;
    desc.points = huge;
    desc.format = VOX_FORMAT_DOUBLE;
    ck_fails(vox_query_view_closest_points(view, &desc, &hit), VOX_ERROR_LIMIT, "point 0 is (0, 0, 4e+38)");
    desc.points = p;
    desc.max_distance = -1;
    ck_fails(vox_query_view_closest_points(view, &desc, &hit), VOX_ERROR_INVALID_ARGUMENT,
             "max_distance is -1");
    desc.max_distance = NAN;
    ck_fails(vox_query_view_closest_points(view, &desc, &hit), VOX_ERROR_INVALID_ARGUMENT, "max_distance is");
    desc.max_distance = 1;
    desc.reserved = 3;
    ck_fails(vox_query_view_closest_points(view, &desc, &hit), VOX_ERROR_INVALID_ARGUMENT, "reserved is 3");
    desc.reserved = 0;
    desc.byte_stride = 5;
    ck_fails(vox_query_view_closest_points(view, &desc, &hit), VOX_ERROR_INVALID_ARGUMENT, "5");
    desc.byte_stride = 0;
    desc.format = (vox_format)9;
    ck_fails(vox_query_view_closest_points(view, &desc, &hit), VOX_ERROR_INVALID_ARGUMENT, "9");
    desc.format = VOX_FORMAT_DOUBLE;
    desc.byte_stride = 24;
    desc.point_count = 1ull << 32;
    ck_fails(vox_query_view_closest_points(view, &desc, &hit), VOX_ERROR_LIMIT, "4294967296");

    ck_fails(vox_grid_query_ray_hits(NULL, p, p, 1, 0, &facet, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "grid is null");
    ck_fails(vox_query_view_ray_hits(NULL, p, p, 1, 0, &facet, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "view is null");
    ck_fails(vox_grid_query_ray_hits(w.grid, p, huge, 1, 0, &facet, 1, &count), VOX_ERROR_LIMIT,
             "to is (0, 0, 4e+38)");
    ck_fails(vox_grid_query_ray_hits(w.grid, NULL, p, 1, 0, &facet, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "from is null");
    ck_fails(vox_query_view_ray_hits(view, p, p, 1, 0, NULL, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "hits is null");
    ck_fails(vox_query_view_ray_hits(view, p, p, 1, 0, &facet, 1, NULL), VOX_ERROR_INVALID_ARGUMENT,
             "out_count is null");
    ck_fails(vox_grid_query_ray_any(w.grid, nan_point, p, 1, 0, &any), VOX_ERROR_NON_FINITE,
             "from is (0, nan, 0)");
    ck_fails(vox_query_view_ray_any(view, p, NULL, 1, 0, &any), VOX_ERROR_INVALID_ARGUMENT, "to is null");
    ck_fails(vox_query_view_ray_any(view, p, p, 1, 0, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_any is null");
    ck_fails(vox_query_view_ray(view, p, nan_point, 1, &ray), VOX_ERROR_NON_FINITE, "to is (0, nan, 0)");
    ck_assert_uint_eq(count, 77);
    ck_assert_uint_eq(any, 77);
    vox_query_view_release(view);
    vox_grid* empty = engine_grid();
    ck_fails(vox_grid_query_ray_any(empty, p, p, 1, 0, &any), VOX_ERROR_INVALID_STATE, "prepare_queries");
    vox_grid_destroy(empty);
    end_world(&w);
}
END_TEST

/* A batch visits its points in an order of its own; each answer must be that of a call for the point alone.
 * The body is a lattice of cubes, and the points are on half cells, so that most have several closest facets.
 */
START_TEST(batches_answer_as_single_calls) {
    enum { cells = 12, corners = cells + 1, n = 2000 };
    static float positions[corners * corners * corners][3];
    static uint32_t tets[cells * cells * cells * 6][4];
    static const uint32_t paths[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    const uint32_t strides[3] = {1, corners, corners * corners};
    uint32_t tet_count = 0;
    for (uint32_t v = 0; v < corners * corners * corners; ++v)
        for (int i = 0; i < 3; ++i) positions[v][i] = (float)(v / strides[i] % corners);
    for (uint32_t c = 0; c < cells * cells * cells; ++c)
        for (int path = 0; path < 6; ++path, ++tet_count) {
            uint32_t v = c % cells + c / cells % cells * corners + c / (cells * cells) * corners * corners;
            tets[tet_count][0] = v;
            for (int i = 0; i < 3; ++i) tets[tet_count][i + 1] = v += strides[paths[path][i]];
        }
    vox_grid* grid = engine_grid();
    vox_mesh_desc mesh_desc = vox_default_mesh_desc();
    mesh_desc.positions.data = positions;
    mesh_desc.positions.count = corners * corners * corners;
    mesh_desc.tets = tets[0];
    mesh_desc.tet_count = tet_count;
    vox_body mesh = VOX_NULL_BODY;
    ck_ok(vox_mesh_insert(grid, &mesh_desc, &mesh));
    ck_ok(vox_grid_prepare_queries(grid));
    static float points[n][3];
    static vox_closest_hit hits[n];
    uint64_t random = 5;
    for (int i = 0; i < n; ++i)
        for (int c = 0; c < 3; ++c) points[i][c] = floorf(random_float(&random, -4, 2 * cells + 5)) / 2;
    vox_closest_desc desc = vox_default_closest_desc();
    for (int bounded = 0; bounded < 2; ++bounded) {
        desc.max_distance = bounded ? 1 : INFINITY; /* 1: exactly as far as some points are */
        desc.points = points;
        desc.point_count = n;
        ck_ok(vox_grid_query_closest_points(grid, &desc, hits));
        desc.point_count = 1;
        for (int i = 0; i < n; ++i) {
            vox_closest_hit alone;
            desc.points = points[i];
            ck_ok(vox_grid_query_closest_points(grid, &desc, &alone));
            ck_assert_mem_eq(&alone, &hits[i], sizeof alone);
        }
    }
    vox_grid_destroy(grid);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, closest_by_definition, rays_by_definition, closest_points_by_definition,
                   all_hits_by_definition, normals_without_volume, batches_answer_as_single_calls, arguments);
}

SUITE(queries_of_surfaces) { add_for_each_engine(suite, add_tests); }
