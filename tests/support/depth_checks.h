/* Depths against contacts and, by brute force, against surfaces. */
#ifndef VOX_TESTS_DEPTH_CHECKS_H
#define VOX_TESTS_DEPTH_CHECKS_H

#include "scenes/bodies.h"
#include "support/constraint_checks.h"

/* ---- vectors ---- */

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
static inline vector vector_of(const double* x) { return (vector){x[0], x[1], x[2]}; }
static inline vector place(const float* positions, uint32_t v) {
    return (vector){positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]};
}
static inline double degrees_between(vector a, vector b) {
    return atan2(norm(outer(a, b)), inner(a, b)) * (180 / 3.14159265358979);
}

/* ---- INSIDE constraints ---- */

static inline vox_grid_desc depth_desc(void) {
    vox_grid_desc desc = engine_desc();
    desc.flags = VOX_GRID_CONSTRAINTS;
    return desc;
}

static inline vox_grid* depth_grid(void) {
    const vox_grid_desc desc = depth_desc();
    return grid_of(&desc);
}

static inline vector normal_of(const vox_constraint* c) { return vector_of(c->normal); }
static inline double depth_of(const vox_constraint* c) { return -c->gap; }

/* The constraint of a vertex in a mesh, or null. */
static inline const vox_constraint* inside_of(const vox_grid* grid, vox_body a, uint32_t vertex, vox_body b) {
    const vox_constraint_view view = constraints_of(grid);
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_constraint* c = &view.data[i];
        if (c->kind == VOX_CONSTRAINT_INSIDE && c->body_a == a && c->vertices[0] == vertex && c->body_b == b)
            return c;
    }
    return NULL;
}

static inline uint64_t count_state(const vox_grid* grid, vox_body a, vox_depth_state state) {
    const vox_constraint_view view = constraints_of(grid);
    uint64_t count = 0;
    for (uint64_t i = 0; i < view.count; ++i)
        count += view.data[i].body_a == a && view.data[i].state == state;
    return count;
}

static inline uint32_t is_sensor(const vox_grid* grid, vox_body id) {
    vox_filter filter = plain_filter();
    ck_ok(get_filter(grid, id, &filter));
    return filter.flags & VOX_FILTER_SENSOR;
}

/* All constraints of a step of all pairs; and one INSIDE constraint for each vertex that has contacts with a
 * body, sensors aside, with the tetrahedron of the first of these. */
static inline vox_constraint_view check_depths(const vox_grid* grid) {
    const vox_constraint_view view = checked_constraints(grid);
    const vox_contact_view contacts = contacts_of(grid);
    const vox_pair_view pairs = pairs_of(grid);
    uint64_t count = 0;
    for (uint64_t p = 0; p < pairs.count; ++p) {
        const vox_pair* pair = &pairs.data[p];
        const vox_contact* last = NULL;
        uint64_t next = view.pair_offsets[p];
        if (pair->contact_count == 0) continue; /* its bodies may be gone */
        if (is_sensor(grid, pair->body_a) || is_sensor(grid, pair->body_b)) continue;
        for (uint64_t i = 0; i < pair->contact_count; ++i) {
            const vox_contact* contact = &contacts.data[pairs.contacts[pair->first_contact + i]];
            const int is_first = !last || last->body_a != contact->body_a || last->vertex != contact->vertex;
            last = contact;
            if (!is_first) continue;
            ck_assert_uint_lt(next, view.pair_offsets[p + 1]);
            const vox_constraint* c = &view.data[next++];
            ck_assert_int_eq(c->kind, VOX_CONSTRAINT_INSIDE);
            ck_assert_uint_eq(c->body_a, contact->body_a);
            ck_assert_uint_eq(c->vertices[0], contact->vertex);
            ck_assert_uint_eq(c->body_b, contact->body_b);
            ck_assert_uint_eq(c->element_b, contact->tet);
            ck_assert_int_ne(c->state, VOX_DEPTH_PLANE);
            if (c->state == VOX_DEPTH_SURFACE || c->state == VOX_DEPTH_PROPAGATED) ck_assert(c->gap < 0);
            ++count;
        }
    }
    ck_assert_uint_eq(count_constraints(grid, VOX_CONSTRAINT_INSIDE), count);
    return view;
}

/* ---- surfaces ---- */

typedef struct facet {
    uint32_t v[3]; /* ascending */
    uint32_t opposite;
    uint32_t part; /* of the mesh, to which its tetrahedron belongs */
} facet;

typedef struct surface {
    double* positions; /* of the mesh */
    facet* facets;
    uint32_t count;
} surface;

static inline int compare_facets(const void* x, const void* y) {
    const uint32_t *p = (const uint32_t*)x, *q = (const uint32_t*)y; /* corners, then what is opposite */
    for (int i = 0; i < 4; ++i)
        if (p[i] != q[i]) return p[i] < q[i] ? -1 : 1;
    return 0;
}

/* The facets of exactly one tetrahedron, doubled ones counted once. Part t / tets_a_part has tetrahedron t.
 */
static inline surface surface_of_parts(const body* b, uint32_t tets_a_part) {
    facet* all = (facet*)malloc(sizeof(facet) * (4 * (size_t)b->tet_count + 1));
    uint32_t n = 0;
    for (uint32_t t = 0; t < b->tet_count; ++t) {
        const uint32_t* v = b->tets + 4 * t;
        int twice = 0;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < i; ++j) twice |= v[i] == v[j];
        for (int i = 0; i < 4 && !twice; ++i) {
            facet* f = &all[n++];
            for (int j = 0, k = 0; j < 4; ++j) {
                if (j == i) continue;
                int at = k++;
                for (; at > 0 && f->v[at - 1] > v[j]; --at) f->v[at] = f->v[at - 1];
                f->v[at] = v[j];
            }
            f->opposite = v[i];
            f->part = t / tets_a_part;
        }
    }
    qsort(all, n, sizeof *all, compare_facets);
    surface made = {(double*)malloc((3 * (size_t)b->vertex_count + 1) * sizeof(double)), all, 0};
    for (size_t i = 0; i < 3 * (size_t)b->vertex_count; ++i) made.positions[i] = (double)b->positions[i];
    for (uint32_t first = 0, last; first < n; first = last) {
        int sides = 1;
        for (last = first + 1; last < n && memcmp(all[last].v, all[first].v, sizeof all->v) == 0; ++last)
            sides += all[last].opposite != all[last - 1].opposite;
        if (sides == 1) all[made.count++] = all[first];
    }
    return made;
}

static inline surface surface_of(const body* b) { return surface_of_parts(b, b->tet_count + 1); }

static inline void free_surface(surface* s) {
    free(s->positions);
    free(s->facets);
}

static inline vector corner(const surface* s, uint32_t v) { return vector_of(s->positions + 3 * (size_t)v); }

static inline vector closest_on_segment(vector p, vector a, vector b) {
    const vector ab = minus(b, a);
    const double l = inner(ab, ab), t = l > 0 ? inner(minus(p, a), ab) / l : 0;
    return plus_times(a, t < 0 ? 0 : t > 1 ? 1 : t, ab);
}

static inline vector closest_on_facet(vector p, vector a, vector b, vector c) {
    const vector n = outer(minus(b, a), minus(c, a));
    const double area = inner(n, n);
    if (area > 0) {
        const vector foot = plus_times(p, -inner(minus(p, a), n) / area, n);
        if (inner(outer(minus(b, a), minus(foot, a)), n) >= 0 &&
            inner(outer(minus(c, b), minus(foot, b)), n) >= 0 &&
            inner(outer(minus(a, c), minus(foot, c)), n) >= 0)
            return foot;
    }
    const vector on[3] = {closest_on_segment(p, a, b), closest_on_segment(p, b, c),
                          closest_on_segment(p, c, a)};
    int best = 0;
    for (int i = 1; i < 3; ++i)
        if (norm(minus(on[i], p)) < norm(minus(on[best], p))) best = i;
    return on[best];
}

static const uint32_t all_parts = UINT32_MAX;

/* The facet closest to p, of one part or of all; of those exactly as close, as computed here, the first. Null
 * where there is none. */
static inline const facet* closest_facet(const surface* s, vector p, uint32_t part, vector* way) {
    const facet* best = NULL;
    for (uint32_t i = 0; i < s->count; ++i) {
        const facet* f = &s->facets[i];
        if (part != all_parts && f->part != part) continue;
        const vector found =
            minus(closest_on_facet(p, corner(s, f->v[0]), corner(s, f->v[1]), corner(s, f->v[2])), p);
        if (best && inner(found, found) >= inner(*way, *way)) continue;
        best = f;
        *way = found;
    }
    return best;
}

/* The way from p to the closest point of a surface. */
static inline vector way_to(const surface* s, vector p) {
    vector way = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    (void)closest_facet(s, p, all_parts, &way);
    return way;
}

/* Checks a constraint that takes the closest point of the surface. */
static inline void check_closest(const vox_constraint* c, const surface* s) {
    const vector at = vector_of(c->position), way = way_to(s, at);
    ck_assert_msg(fabs(norm(way) - depth_of(c)) < 1e-14, "vertex %u: depth %.17g, the surface is %.17g away",
                  c->vertices[0], depth_of(c), norm(way));
    /* Where several points are as close, any of them. */
    const double missed = norm(way_to(s, plus_times(at, depth_of(c), normal_of(c))));
    ck_assert_msg(missed < 1e-14, "vertex %u: the direction misses the surface by %g", c->vertices[0],
                  missed);
}

#endif
