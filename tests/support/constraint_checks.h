/* Checks of the constraints of a step whose positions have not changed since. */
#ifndef VOX_TESTS_CONSTRAINT_CHECKS_H
#define VOX_TESTS_CONSTRAINT_CHECKS_H

#include <math.h>
#include <string.h>

#include "support/suite.h"

/* A body's transformed positions as packed doubles, and its tetrahedra. */
typedef struct placed_body {
    double* x;
    uint32_t* tets;
    uint64_t vertex_count, tet_count;
    uint64_t user_data;
    double extent; /* the largest coordinate */
} placed_body;

static inline placed_body place_body(const vox_grid* grid, vox_body id) {
    placed_body b;
    vox_body_info info;
    info.struct_size = sizeof info;
    ck_ok(vox_body_get_info(grid, id, &info));
    const vox_positions p = info.positions;
    b.vertex_count = p.count;
    b.tet_count = info.tet_count;
    b.user_data = info.user_data;
    b.extent = 0;
    b.x = (double*)malloc(3 * sizeof(double) * (size_t)(p.count + 1));
    b.tets = (uint32_t*)malloc(4 * sizeof(uint32_t) * (size_t)(b.tet_count + 1));
    ck_ok(vox_mesh_get_tets(grid, id, b.tets, NULL, b.tet_count, &b.tet_count));
    for (uint64_t v = 0; v < p.count; ++v) {
        double at[3];
        for (uint64_t k = 0; k < 3; ++k) {
            const char* from = (const char*)p.data + v * p.byte_stride + k * p.component_byte_stride;
            float single;
            memcpy(&single, from, sizeof single);
            at[k] = (double)single;
            if (p.format == VOX_FORMAT_DOUBLE) memcpy(&at[k], from, sizeof(double));
        }
        for (int k = 0; k < 3; ++k) {
            const double* m = info.transform + 4 * k;
            b.x[3 * v + (uint64_t)k] = m[0] * at[0] + m[1] * at[1] + m[2] * at[2] + m[3];
            b.extent = fmax(b.extent, fabs(b.x[3 * v + (uint64_t)k]));
        }
    }
    return b;
}

static inline void free_placed(placed_body* b) {
    free(b->x);
    free(b->tets);
}

/* The sort key of the constraints of one pair and kind. */
static inline void constraint_key(const vox_constraint* c, uint32_t key[6]) {
    memset(key, 0, 6 * sizeof *key);
    key[0] = c->body_a;
    key[1] = c->vertices[0];
    if (c->kind != VOX_CONSTRAINT_EDGE) return;
    memcpy(key + 2, c->vertices + 1, 4 * sizeof *key);
    if (c->count == c->count_a) { /* with a shape */
        key[4] = c->count;
        key[5] = c->element_b;
        return;
    }
    for (int i = 0; i < 2; ++i) /* the face, ascending */
        for (int k = 3; k < 5; ++k)
            if (key[k] > key[k + 1]) {
                const uint32_t higher = key[k];
                key[k] = key[k + 1];
                key[k + 1] = higher;
            }
}

static inline int compare_constraints(const vox_constraint* x, const vox_constraint* y) {
    uint32_t p[6], q[6];
    if (x->kind != y->kind) return x->kind < y->kind ? -1 : 1;
    constraint_key(x, p);
    constraint_key(y, q);
    for (int i = 0; i < 6; ++i)
        if (p[i] != q[i]) return p[i] < q[i] ? -1 : 1;
    return 0;
}

/* Checks one constraint. */
static inline void check_constraint(const vox_constraint* c, const placed_body* a, const placed_body* b) {
    const int of_vertex = c->kind != VOX_CONSTRAINT_EDGE;
    double sums[2] = {0, 0}, point[3] = {0, 0, 0};
    ck_assert_uint_eq(c->user_data_a, a->user_data);
    ck_assert_uint_eq(c->user_data_b, b->user_data);
    ck_assert_uint_eq(c->count_a, of_vertex ? 1 : 2);
    ck_assert(c->count == c->count_a + 3 || (c->kind == VOX_CONSTRAINT_INSIDE && c->count == 5));
    ck_assert_uint_lt(c->element_b, b->tet_count);
    for (uint32_t i = 0; i < VOX_STENCIL_CAPACITY; ++i) {
        const int of_a = i < c->count_a;
        if (i >= c->count) {
            ck_assert(c->vertices[i] == 0 && c->weights[i] == 0);
            continue;
        }
        ck_assert_uint_lt(c->vertices[i], of_a ? a->vertex_count : b->vertex_count);
        ck_assert(of_a ? c->weights[i] >= 0 : c->weights[i] <= 0);
        sums[!of_a] += c->weights[i];
        for (int k = 0; k < 3 && of_a; ++k)
            point[k] += c->weights[i] * a->x[3 * c->vertices[i] + (uint32_t)k];
        if (of_a || (c->kind == VOX_CONSTRAINT_INSIDE && c->count == 4)) continue; /* the closest triangle */
        const uint32_t* tet = b->tets + 4 * (size_t)c->element_b;
        ck_assert(tet[0] == c->vertices[i] || tet[1] == c->vertices[i] || tet[2] == c->vertices[i] ||
                  tet[3] == c->vertices[i]);
    }
    if (of_vertex) ck_assert_double_eq(c->weights[0], 1);
    ck_assert_double_eq_tol(sums[0], 1, 1e-12);
    ck_assert_double_eq_tol(sums[1], -1, 1e-11);
    const double tolerance = 1e-12 * (a->extent + b->extent);
    for (int k = 0; k < 3; ++k) ck_assert_double_eq_tol(c->position[k], point[k], tolerance);
    const double length =
        sqrt(c->normal[0] * c->normal[0] + c->normal[1] * c->normal[1] + c->normal[2] * c->normal[2]);
    if (c->state != VOX_DEPTH_UNKNOWN || length != 0) ck_assert_double_eq_tol(length, 1, 1e-12);
    ck_assert_double_eq_tol(vox_constraint_gap(c, a->x, b->x), c->gap, tolerance);
    ck_assert(c->kind == VOX_CONSTRAINT_PROXIMITY ? c->gap >= 0 : c->gap <= 0);
    if (c->state == VOX_DEPTH_TOUCHING || c->state == VOX_DEPTH_UNKNOWN) ck_assert_double_eq(c->gap, 0);
    ck_assert(c->time >= 0 && c->time <= 1);
    if (c->kind == VOX_CONSTRAINT_EDGE || c->kind == VOX_CONSTRAINT_PROXIMITY)
        ck_assert_double_eq(c->time, 1);
}

/* Checks all constraints and returns the view. */
static inline vox_constraint_view checked_constraints(const vox_grid* grid) {
    const vox_constraint_view view = constraints_of(grid);
    const vox_pair_view pairs = pairs_of(grid);
    ck_assert_uint_eq(view.pair_count, pairs.count);
    ck_assert_uint_eq(view.pair_offsets[0], 0);
    ck_assert_uint_eq(view.pair_offsets[view.pair_count], view.count);
    for (uint64_t p = 0; p < pairs.count; ++p) {
        const vox_pair* pair = &pairs.data[p];
        const uint64_t first = view.pair_offsets[p], end = view.pair_offsets[p + 1];
        ck_assert_uint_le(first, end);
        if (first == end) continue;
        placed_body bodies[2] = {place_body(grid, pair->body_a), place_body(grid, pair->body_b)};
        for (uint64_t i = first; i < end; ++i) {
            const vox_constraint* c = &view.data[i];
            const int swapped = c->body_a != pair->body_a;
            ck_assert_uint_eq(c->pair, p);
            ck_assert_uint_eq(c->body_a, swapped ? pair->body_b : pair->body_a);
            ck_assert_uint_eq(c->body_b, swapped ? pair->body_a : pair->body_b);
            check_constraint(c, &bodies[swapped], &bodies[!swapped]);
            if (i > first) ck_assert_int_lt(compare_constraints(c - 1, c), 0);
            if (pair->state == VOX_PAIR_NEAR || pair->state == VOX_PAIR_ENDED) /* which may be near still */
                ck_assert_int_eq(c->kind, VOX_CONSTRAINT_PROXIMITY);
            /* A vertex has at most one, of any kind. */
            for (uint64_t other = first; other < i && c->kind > VOX_CONSTRAINT_EDGE; ++other)
                ck_assert(view.data[other].kind == VOX_CONSTRAINT_EDGE ||
                          view.data[other].body_a != c->body_a ||
                          view.data[other].vertices[0] != c->vertices[0]);
        }
        free_placed(&bodies[0]);
        free_placed(&bodies[1]);
    }
    ck_assert_uint_eq(counters_of(grid).constraints, view.count);
    return view;
}

/* The constraint of a vertex with a body; null: none. */
static inline const vox_constraint* find_constraint(const vox_grid* grid, vox_body a, uint32_t vertex,
                                                    vox_body b) {
    const vox_constraint_view view = constraints_of(grid);
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_constraint* c = &view.data[i];
        if (c->kind != VOX_CONSTRAINT_EDGE && c->body_a == a && c->vertices[0] == vertex && c->body_b == b)
            return c;
    }
    return NULL;
}

/* Finds the constraints of the last step without depth: quick, for their weights. */
static inline void find_weights(vox_grid* grid) {
    vox_constraint_desc desc = vox_default_constraint_desc();
    desc.method = VOX_DEPTH_METHOD_NONE;
    ck_ok(vox_grid_find_constraints(grid, &desc));
}

static inline uint64_t count_constraints(const vox_grid* grid, vox_constraint_kind kind) {
    const vox_constraint_view view = constraints_of(grid);
    uint64_t count = 0;
    for (uint64_t i = 0; i < view.count; ++i) count += view.data[i].kind == kind;
    return count;
}

/* A copy of the view, which the caller frees. */
typedef struct kept_constraints {
    vox_constraint* data;
    uint64_t count;
} kept_constraints;

static inline kept_constraints keep_constraints(const vox_grid* grid) {
    const vox_constraint_view view = constraints_of(grid);
    kept_constraints kept = {(vox_constraint*)malloc((size_t)(view.count + 1) * sizeof(vox_constraint)),
                             view.count};
    if (view.count) memcpy(kept.data, view.data, (size_t)view.count * sizeof(vox_constraint));
    return kept;
}

/* The constraints of the last step are those, but for `previous`. */
static inline void same_constraints(const vox_grid* grid, const kept_constraints* kept) {
    const vox_constraint_view view = constraints_of(grid);
    ck_assert_uint_eq(view.count, kept->count);
    for (uint64_t i = 0; i < view.count; ++i) {
        vox_constraint c = view.data[i];
        c.previous = kept->data[i].previous;
        ck_assert_mem_eq(&c, &kept->data[i], sizeof c);
    }
}

/* `previous` is right, where `kept` are the constraints of the step before. */
static inline void check_previous(const vox_grid* grid, const kept_constraints* kept) {
    const vox_constraint_view view = constraints_of(grid);
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_constraint* c = &view.data[i];
        uint32_t expected = VOX_NONE;
        for (uint64_t k = 0; k < kept->count && expected == VOX_NONE; ++k) {
            const vox_constraint* old = &kept->data[k];
            if (old->vertices[0] != c->vertices[0]) continue; /* most of them */
            uint32_t p[6], q[6];
            if (c->vertices[0] != old->vertices[0] || c->body_a != old->body_a || c->body_b != old->body_b ||
                (c->kind == VOX_CONSTRAINT_EDGE) != (old->kind == VOX_CONSTRAINT_EDGE))
                continue;
            constraint_key(c, p);
            constraint_key(old, q);
            if (memcmp(p, q, sizeof p) == 0) expected = (uint32_t)k;
        }
        ck_assert_uint_eq(c->previous, expected);
    }
}

#endif
