/* Penetrations against their contacts and against surfaces, by brute force. */
#ifndef VOX_TESTS_DEPTH_CHECKS_H
#define VOX_TESTS_DEPTH_CHECKS_H

#include <math.h>
#include <string.h>

#include "scenes/bodies.h"
#include "support/suite.h"

typedef struct vector {
    double x, y, z;
} vector;

static inline vector minus(vector a, vector b) { return (vector){a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline vector plus_times(vector a, double s, vector b) {
    return (vector){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}
static inline double inner(vector a, vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline vector outer(vector a, vector b) {
    return (vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline double norm(vector a) { return sqrt(inner(a, a)); }
static inline vector place(const float* positions, uint32_t v) {
    return (vector){positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]};
}
static inline vector direction_of(const vox_penetration* p) {
    return (vector){p->direction[0], p->direction[1], p->direction[2]};
}
static inline double degrees_between(vector a, vector b) {
    return atan2(norm(outer(a, b)), inner(a, b)) * (180 / 3.14159265358979);
}

static inline vox_penetration_view penetrations_of(const vox_grid* grid) {
    vox_penetration_view view = {NULL, 0, 0, 0};
    ck_ok(vox_grid_penetrations(grid, &view));
    ck_assert_uint_ge(view.byte_stride, sizeof(vox_penetration));
    return view;
}

static inline const vox_penetration* penetration_at(vox_penetration_view view, uint64_t i) {
    return (const vox_penetration*)(const void*)((const char*)view.data + i * view.byte_stride);
}

/* The penetration of a vertex in a mesh, or null. */
static inline const vox_penetration* penetration_of(const vox_grid* grid, vox_body a, uint32_t vertex,
                                                    vox_body b) {
    const vox_penetration_view view = penetrations_of(grid);
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_penetration* p = penetration_at(view, i);
        if (p->body_a == a && p->vertex == vertex && p->body_b == b) return p;
    }
    return NULL;
}

static inline uint64_t count_state(const vox_grid* grid, vox_body a, vox_penetration_state state) {
    const vox_penetration_view view = penetrations_of(grid);
    uint64_t count = 0;
    for (uint64_t i = 0; i < view.count; ++i)
        count += penetration_at(view, i)->body_a == a && penetration_at(view, i)->state == state;
    return count;
}

static inline vox_depth_view depths_of(const vox_grid* grid) {
    vox_depth_view view = {NULL, 0, 0, 0};
    ck_ok(vox_grid_depths(grid, &view));
    ck_assert_uint_ge(view.byte_stride, sizeof(vox_depth));
    return view;
}

/* Depth and direction in double are what the floats are rounded from. */
static inline void check_rounded(const vox_depth* exact, float depth, const float direction[3]) {
    ck_assert(depth == (float)exact->depth);
    for (int axis = 0; axis < 3; ++axis) ck_assert(direction[axis] == (float)exact->direction[axis]);
}

/* Checks what holds in every scene: one penetration for each (body_a, vertex, body_b) of the contacts, in
 * their order, with finite numbers and a unit direction. */
static inline void check_penetrations(const vox_grid* grid) {
    const vox_penetration_view view = penetrations_of(grid);
    const vox_depth_view depths = depths_of(grid);
    ck_assert_uint_eq(depths.count, view.count);
    ck_assert_uint_eq(depths.epoch, view.epoch);
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_depth* exact =
            (const vox_depth*)(const void*)((const char*)depths.data + i * depths.byte_stride);
        const vox_penetration* p = penetration_at(view, i);
        check_rounded(exact, p->depth, p->direction);
        const vector d = {exact->direction[0], exact->direction[1], exact->direction[2]};
        ck_assert_msg(fabs(norm(d) - 1) < 1e-14, "vertex %u: a direction of length 1 + %g", p->vertex,
                      norm(d) - 1);
    }
    vox_contact_view contacts = contacts_of(grid);
    ck_assert_uint_eq(view.epoch, contacts.epoch);
    uint64_t next = 0;
    for (uint64_t i = 0; i < contacts.count; ++i) {
        const vox_contact* c =
            (const vox_contact*)(const void*)((const char*)contacts.data + i * contacts.byte_stride);
        if (next > 0) {
            const vox_penetration* last = penetration_at(view, next - 1);
            if (last->body_a == c->body_a && last->vertex == c->vertex && last->body_b == c->body_b) continue;
        }
        ck_assert_uint_lt(next, view.count);
        const vox_penetration* p = penetration_at(view, next++);
        ck_assert_uint_eq(p->body_a, c->body_a);
        ck_assert_uint_eq(p->vertex, c->vertex);
        ck_assert_uint_eq(p->body_b, c->body_b);
        ck_assert_uint_eq(p->contact, i);
        ck_assert_int_ge(p->state, VOX_PENETRATION_SURFACE);
        ck_assert_int_le(p->state, VOX_PENETRATION_COINCIDENT);
        ck_assert_msg(p->depth >= 0 && isfinite(p->depth), "vertex %u: depth %g", p->vertex,
                      (double)p->depth);
        ck_assert_msg(fabs(norm(direction_of(p)) - 1) < 1e-6, "vertex %u: a direction of length %g",
                      p->vertex, norm(direction_of(p)));
        if (p->state == VOX_PENETRATION_COINCIDENT) ck_assert(p->depth == 0);
        if (p->state == VOX_PENETRATION_SURFACE || p->state == VOX_PENETRATION_PROPAGATED)
            ck_assert(p->depth > 0);
    }
    ck_assert_uint_eq(next, view.count);
    ck_assert_uint_eq(counters_of(grid).penetrations, view.count);
}

/* ---- surfaces ---- */

typedef struct surface {
    uint32_t (*triangles)[3];
    uint32_t count;
} surface;

static inline int compare_facets(const void* x, const void* y) { return memcmp(x, y, 3 * sizeof(uint32_t)); }

/* The facets of exactly one tetrahedron. */
static inline surface surface_of(const uint32_t* tets, uint64_t tet_count) {
    surface made = {(uint32_t(*)[3])malloc(tet_count * 12 * sizeof(uint32_t) + 1), 0};
    uint32_t n = 0;
    for (uint64_t t = 0; t < tet_count; ++t)
        for (uint32_t left_out = 0; left_out < 4; ++left_out) {
            uint32_t* facet = made.triangles[n++];
            for (uint32_t i = 0, k = 0; i < 4; ++i) {
                if (i == left_out) continue;
                uint32_t j = k++;
                for (; j > 0 && facet[j - 1] > tets[4 * t + i]; --j) facet[j] = facet[j - 1];
                facet[j] = tets[4 * t + i];
            }
        }
    qsort(made.triangles, n, sizeof *made.triangles, compare_facets);
    for (uint32_t i = 0, end; i < n; i = end) {
        for (end = i + 1; end < n && compare_facets(made.triangles[i], made.triangles[end]) == 0;) ++end;
        if (end == i + 1) memmove(made.triangles[made.count++], made.triangles[i], sizeof *made.triangles);
    }
    return made;
}

static inline vector closest_on_segment(vector p, vector a, vector b) {
    const vector ab = minus(b, a);
    const double l = inner(ab, ab), t = l > 0 ? inner(minus(p, a), ab) / l : 0;
    return plus_times(a, t < 0 ? 0 : t > 1 ? 1 : t, ab);
}

static inline vector closest_on_facet(vector p, vector a, vector b, vector c) {
    const vector n = outer(minus(b, a), minus(c, a));
    const vector foot = plus_times(p, -inner(minus(p, a), n) / (inner(n, n) > 0 ? inner(n, n) : 1), n);
    if (inner(n, n) > 0 && inner(outer(minus(b, a), minus(foot, a)), n) >= 0 &&
        inner(outer(minus(c, b), minus(foot, b)), n) >= 0 &&
        inner(outer(minus(a, c), minus(foot, c)), n) >= 0)
        return foot;
    const vector on[3] = {closest_on_segment(p, a, b), closest_on_segment(p, b, c),
                          closest_on_segment(p, c, a)};
    int best = 0;
    for (int i = 1; i < 3; ++i)
        if (norm(minus(on[i], p)) < norm(minus(on[best], p))) best = i;
    return on[best];
}

/* The way from p to the closest point of a surface. */
static inline vector way_to(surface s, const float* positions, vector p) {
    vector best = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    for (uint32_t t = 0; t < s.count; ++t) {
        const uint32_t* v = s.triangles[t];
        const vector way = minus(
            closest_on_facet(p, place(positions, v[0]), place(positions, v[1]), place(positions, v[2])), p);
        if (norm(way) < norm(best)) best = way;
    }
    return best;
}

/* Checks a penetration that takes the closest point of the surface. */
static inline void check_closest(const vox_penetration* p, vector vertex, surface s, const float* positions,
                                 double unit) {
    const vector way = way_to(s, positions, vertex);
    ck_assert_msg(fabs(norm(way) - (double)p->depth) < 1e-6 * unit,
                  "vertex %u: depth %g, the surface is %g away", p->vertex, (double)p->depth, norm(way));
    /* Where several points are as close, any of them. */
    const vector end = plus_times(vertex, (double)p->depth, direction_of(p));
    ck_assert_msg(norm(way_to(s, positions, end)) < 1e-6 * unit,
                  "vertex %u: the direction misses the surface by %g", p->vertex,
                  norm(way_to(s, positions, end)));
}

#endif
