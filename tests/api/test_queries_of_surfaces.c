/* The closest point of the surface, and what a ray meets, against brute force over every tetrahedron. */
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

static void triangle_of(const float* const corners[4], uint32_t facet, const float* triangle[3]) {
    for (int i = 0; i < 3; ++i) triangle[i] = corners[facet_corners[facet][i]];
}

/* The point that weights of the facet's corners say, after the vertices and weights are looked at. */
static void weighted_point(const body* b, uint32_t tet, uint32_t facet, const uint32_t face[3],
                           const double weights[3], double p[3]) {
    double sum = 0;
    memset(p, 0, 3 * sizeof *p);
    for (int c = 0; c < 3; ++c) {
        ck_assert_uint_eq(face[c], b->tets[4 * tet + facet_corners[facet][c]]);
        ck_assert(weights[c] >= 0 && weights[c] <= 1);
        sum += weights[c];
        for (int axis = 0; axis < 3; ++axis)
            p[axis] += weights[c] * (double)b->positions[3 * face[c] + (uint32_t)axis];
    }
    ck_assert_double_le(fabs(sum - 1), 1e-12);
}

static int index_of(const world* w, vox_body mesh) {
    for (int b = 0; b < w->count; ++b)
        if (w->meshes[b] == mesh) return b;
    ck_abort_msg("mesh %u is none of the world's", mesh);
    return -1;
}

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

START_TEST(closest_by_definition) {
    enum { n = 60 };
    uint64_t random = 11, found = 0, none = 0, negative = 0, several = 0;
    for (int scene = 0; scene < 48; ++scene) {
        world w = new_world(&random, scene % 2);
        uint8_t* surfaces[most_bodies];
        float points[n][4]; /* three and a hole */
        vox_closest_hit hits[n];
        for (int b = 0; b < w.count; ++b) surfaces[b] = surface_of(&w.bodies[b]);
        for (int i = 0; i < n; ++i) random_point(&random, scene % 2, points[i]);
        vox_positions asked = vox_float_positions(points[0], n);
        asked.byte_stride = sizeof points[0];
        vox_query_desc desc = random_bodies(&random, &w);
        if (scene % 4 == 0) desc.max_distance = (double)random_float(&random, 0, 1);
        if (scene % 4 == 1) desc.max_distance = INFINITY;
        const double most = desc.max_distance > 0 ? desc.max_distance : INFINITY;
        memset(hits, 0xaa, sizeof hits);
        ck_ok(vox_locator_find_closest(w.locator, &asked, &desc, hits));
        for (int i = 0; i < n; ++i) {
            const vox_closest_hit* hit = &hits[i];
            double p[3], best = INFINITY;
            uint32_t inside = 0;
            int inside_of_hit = 0;
            widen(points[i], p);
            for (int b = 0; b < w.count; ++b) {
                int in_mesh = 0;
                const uint32_t tets = takes_part(&w, b, &desc) ? w.bodies[b].tet_count : 0;
                for (uint32_t t = 0; t < tets; ++t) {
                    const float *corners[4], *triangle[3];
                    corners_of(&w.bodies[b], t, corners);
                    if (!apart(points[i], points[i], corners, 4)) {
                        const oracle_containment where = oracle_locate(points[i], corners);
                        in_mesh |= where == ORACLE_INTERIOR || where == ORACLE_BOUNDARY;
                    }
                    for (uint32_t facet = 0; facet < 4; ++facet) {
                        if (!(surfaces[b][t] >> facet & 1)) continue;
                        triangle_of(corners, facet, triangle);
                        best = fmin(best, distance_to_triangle(p, triangle));
                    }
                }
                inside += (uint32_t)in_mesh;
                if (hit->body == w.meshes[b]) inside_of_hit = in_mesh;
            }
            ck_assert_uint_eq(hit->inside, inside);
            several += inside > 1;
            const vox_closest_hit alone = closest_to(w.locator, p, &desc);
            ck_assert_mem_eq(&alone, hit, sizeof alone);
            if (fabs(best - most) < 1e-9) continue; /* rounding decides */
            if (best > most || best == INFINITY) {
                vox_closest_hit zero = {0};
                zero.inside = inside;
                ck_assert_mem_eq(hit, &zero, sizeof zero);
                ++none;
                continue;
            }
            ++found;
            const int b = index_of(&w, hit->body);
            ck_assert(takes_part(&w, b, &desc));
            ck_assert_uint_eq(surfaces[b][hit->tet] >> hit->facet & 1, 1);
            ck_assert_double_le(fabs(fabs(hit->distance) - best), 1e-9);
            ck_assert_int_eq(signbit(hit->distance) != 0, inside_of_hit && hit->distance != 0);
            negative += hit->distance < 0;
            double at[3], squared = 0;
            weighted_point(&w.bodies[b], hit->tet, hit->facet, hit->face, hit->weights, at);
            for (int axis = 0; axis < 3; ++axis) {
                ck_assert_double_le(fabs(at[axis] - hit->position[axis]), 1e-9);
                squared += (at[axis] - p[axis]) * (at[axis] - p[axis]);
            }
            ck_assert_double_le(fabs(sqrt(squared) - best), 1e-9);
            check_normal(&w.bodies[b], hit, points[i]);
        }
        for (int b = 0; b < w.count; ++b) free(surfaces[b]);
        end_world(&w);
    }
    ck_assert_uint_gt(found, 640);
    ck_assert_uint_gt(none, 80);
    ck_assert_uint_gt(negative, 48);
    ck_assert_uint_gt(several, 10);
}
END_TEST

static int in_order(const vox_ray_hit* x, const vox_ray_hit* y) {
    if (x->ray != y->ray) return x->ray < y->ray;
    if (x->t != y->t) return x->t < y->t;
    if (x->body != y->body) return x->body < y->body;
    return x->tet != y->tet ? x->tet < y->tet : x->facet < y->facet;
}

/* Into the tetrahedron when the end that the ray comes from is on the other side of the facet than the fourth
 * corner. */
static vox_side side_of(const float* const triangle[3], const float* apex, const float* from,
                        const float* to) {
    const int inner = oracle_orientation(triangle[0], triangle[1], triangle[2], apex);
    const int before = oracle_orientation(triangle[0], triangle[1], triangle[2], from);
    const int after = oracle_orientation(triangle[0], triangle[1], triangle[2], to);
    return inner == 0                           ? VOX_SIDE_NONE
           : before == -inner || after == inner ? VOX_SIDE_ENTERS
                                                : VOX_SIDE_LEAVES;
}

START_TEST(rays_by_definition) {
    enum { n = 200, most = 16384 };
    static vox_ray_hit hits[most], others[most];
    uint64_t random = 12, all = 0, sides[3] = {0}, met = 0, missed = 0;
    for (int scene = 0; scene < (int)volume_from("VOX_QUERY_SCENES", 8); ++scene) {
        world w = new_world(&random, scene % 2);
        uint8_t* surfaces[most_bodies];
        float begins[n][3], ends[n][3];
        uint8_t blocked[n];
        for (int b = 0; b < w.count; ++b) surfaces[b] = surface_of(&w.bodies[b]);
        for (int i = 0; i < n; ++i) {
            float *p = begins[i], *q = ends[i];
            random_point(&random, scene % 2, p);
            random_point(&random, scene % 2, q);
            if (i % 10 == 0) memcpy(q, p, sizeof ends[i]); /* a point */
            if (i % 4 == 1) q[1] = p[1], q[2] = p[2];      /* along an axis */
        }
        const vox_positions from = vox_float_positions(begins[0], n), to = vox_float_positions(ends[0], n);
        vox_query_desc desc = random_bodies(&random, &w);
        uint64_t count = 0, other_count = 0, next = 0, firsts = 0;
        ck_ok(vox_locator_find_ray_hits(w.locator, &from, &to, &desc, hits, most, &count));
        ck_assert_uint_lt(count, most);
        memset(blocked, 7, sizeof blocked);
        ck_ok(vox_locator_test_rays(w.locator, &from, &to, &desc, blocked));
        for (uint32_t i = 0; i < n; ++i) {
            const float *p = begins[i], *q = ends[i];
            const uint64_t begin = next;
            uint64_t expected = 0;
            int meets = 0;
            while (next < count && hits[next].ray == i) ++next;
            for (int b = 0; b < w.count; ++b)
                for (uint32_t t = 0; t < w.bodies[b].tet_count && takes_part(&w, b, &desc); ++t) {
                    const float *corners[4], *triangle[3];
                    corners_of(&w.bodies[b], t, corners);
                    if (apart(p, q, corners, 4)) continue;
                    const oracle_containment where = oracle_locate(p, corners);
                    meets |= where == ORACLE_INTERIOR || where == ORACLE_BOUNDARY;
                    for (uint32_t facet = 0; facet < 4; ++facet) {
                        triangle_of(corners, facet, triangle);
                        double from_p[3], to_q[3], at[3];
                        widen(p, from_p);
                        widen(q, to_q);
                        const double expected_t = crossing(p, q, triangle);
                        if (expected_t == INFINITY) continue;
                        meets |= where != ORACLE_DEGENERATE;
                        if (!(surfaces[b][t] >> facet & 1)) continue;
                        ++expected;
                        const vox_ray_hit* hit = NULL;
                        for (uint64_t h = begin; h < next; ++h)
                            if (hits[h].body == w.meshes[b] && hits[h].tet == t && hits[h].facet == facet)
                                hit = &hits[h];
                        ck_assert_ptr_nonnull(hit);
                        ck_assert_double_le(fabs(hit->t - expected_t), 1e-9);
                        ck_assert_int_eq(hit->side, side_of(triangle, corners[facet], p, q));
                        ++sides[hit->side];
                        weighted_point(&w.bodies[b], t, facet, hit->face, hit->weights, at);
                        for (int axis = 0; axis < 3; ++axis)
                            ck_assert_double_le(
                                fabs(at[axis] - (from_p[axis] + hit->t * (to_q[axis] - from_p[axis]))), 1e-6);
                    }
                }
            ck_assert_uint_eq(next - begin, expected);
            ck_assert_uint_eq(blocked[i], meets);
            met += blocked[i];
            missed += !blocked[i];
            for (uint64_t h = begin + 1; h < next; ++h) ck_assert(in_order(&hits[h - 1], &hits[h]));
            if (expected > 0) others[firsts++] = hits[begin];

            /* The ray alone. */
            const vox_positions from_one = vox_float_positions(p, 1), to_one = vox_float_positions(q, 1);
            vox_ray_hit* alone = others + most / 2;
            uint8_t blocked_alone = 7;
            ck_ok(vox_locator_find_ray_hits(w.locator, &from_one, &to_one, &desc, alone, most / 2,
                                            &other_count));
            ck_assert_uint_eq(other_count, expected);
            for (uint64_t h = 0; h < expected; ++h) alone[h].ray = i;
            ck_assert_mem_eq(alone, hits + begin, expected * sizeof *hits);
            ck_ok(vox_locator_test_rays(w.locator, &from_one, &to_one, &desc, &blocked_alone));
            ck_assert_uint_eq(blocked_alone, blocked[i]);
        }
        ck_assert_uint_eq(next, count);
        all += count;
        vox_ray_hit* some = others + most / 2; /* room for some */
        memset(some, 0, most / 2 * sizeof *some);
        ck_ok(vox_locator_find_ray_hits(w.locator, &from, &to, &desc, some, count / 2, &other_count));
        ck_assert_uint_eq(other_count, count);
        ck_assert_mem_eq(some, hits, count / 2 * sizeof *some);
        ck_assert_uint_eq(some[count / 2].body, VOX_NULL_BODY);
        desc.flags = VOX_QUERY_FIRST_HIT;
        ck_ok(vox_locator_find_ray_hits(w.locator, &from, &to, &desc, hits, most, &count));
        ck_assert_uint_eq(count, firsts);
        ck_assert_mem_eq(hits, others, firsts * sizeof *hits);
        for (int b = 0; b < w.count; ++b) free(surfaces[b]);
        end_world(&w);
    }
    ck_assert_uint_gt(all, 400);
    ck_assert_uint_gt(sides[VOX_SIDE_ENTERS], 140);
    ck_assert_uint_gt(sides[VOX_SIDE_LEAVES], 140);
    ck_assert_uint_gt(met, 200);
    ck_assert_uint_gt(missed, 200);
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
        vox_locator* locator = take_locator(grid);
        const vox_closest_hit hit = closest_to(locator, cases[i].point, NULL);
        ck_assert_uint_ne(hit.body, VOX_NULL_BODY);
        ck_assert_uint_eq(hit.inside, 0);
        for (int axis = 0; axis < 3; ++axis) ck_assert_double_eq(hit.normal[axis], cases[i].normal[axis]);
        vox_locator_release(locator);
        vox_grid_destroy(grid);
    }
}
END_TEST

/* A batch visits its points in an order of its own; each answer must be that of the point alone.
 * The body is a lattice of cubes, and the points are on half cells, so that most have several closest facets.
 */
START_TEST(batches_answer_as_batches_of_one) {
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
    vox_locator* locator = take_locator(grid);
    static float points[n][3];
    static vox_closest_hit hits[n];
    uint64_t random = 5;
    for (int i = 0; i < n; ++i)
        for (int c = 0; c < 3; ++c) points[i][c] = floorf(random_float(&random, -4, 2 * cells + 5)) / 2;
    const vox_positions all = vox_float_positions(points[0], n);
    vox_query_desc desc = vox_default_query_desc();
    for (int bounded = 0; bounded < 2; ++bounded) {
        desc.max_distance = bounded; /* 1: exactly as far as some points are */
        ck_ok(vox_locator_find_closest(locator, &all, &desc, hits));
        for (int i = 0; i < n; ++i) {
            double p[3];
            widen(points[i], p);
            const vox_closest_hit alone = closest_to(locator, p, &desc);
            ck_assert_mem_eq(&alone, &hits[i], sizeof alone);
        }
    }
    vox_locator_release(locator);
    vox_grid_destroy(grid);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, closest_by_definition, rays_by_definition, normals_without_volume,
                   batches_answer_as_batches_of_one);
}

SUITE(queries_of_surfaces) { add_for_each_engine(suite, add_tests); }
