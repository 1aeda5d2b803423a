/* Scenes for the tests of queries. */
#ifndef VOX_TESTS_QUERY_CHECKS_H
#define VOX_TESTS_QUERY_CHECKS_H

#include <math.h>
#include <string.h>

#include "scenes/bodies.h"
#include "scenes/random.h"
#include "support/locators.h"

enum { most_bodies = 4 };

typedef struct world {
    vox_grid* grid;
    vox_locator* locator;
    body bodies[most_bodies];
    vox_body meshes[most_bodies];
    int count;
} world;

/* Boxes that overlap each other; by quarters of an edge when `coarse`, so that points fall on facets, edges,
 * corners. */
static inline world new_world(uint64_t* random, int coarse) {
    world w;
    vox_grid_desc desc = vox_default_grid_desc();
    memset(&w, 0, sizeof w);
    use_engine(&desc, suite_engine);
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
            w.bodies[b].positions[i] +=
                coarse ? 0.25f * roundf(4 * moved) * (float)(random_below(random, 4) == 0) : moved;
        }
        vox_mesh_desc mesh = body_desc(&w.bodies[b]);
        vox_filter filter = plain_filter();
        filter.category = 1u << b;
        mesh.filter = filter;
        ck_ok(vox_mesh_insert(w.grid, &mesh, &w.meshes[b]));
    }
    w.locator = take_locator(w.grid);
    return w;
}

static inline void end_world(world* w) {
    vox_grid_destroy(w->grid);
    vox_locator_release(w->locator);
    for (int b = 0; b < w->count; ++b) free_body(&w->bodies[b]);
}

/* Some bodies by their category, and now and then one of them, or none, left out. */
static inline vox_query_desc random_bodies(uint64_t* random, const world* w) {
    const uint32_t which = random_below(random, 3 * (uint32_t)w->count), by = random_below(random, 4);
    const vox_body none = which % 2 ? VOX_NULL_BODY : 4095u << 12 | 1;
    return query_of(by == 0   ? random_next(random)
                    : by == 1 ? UINT64_MAX
                              : 0,
                    which < (uint32_t)w->count ? w->meshes[which] : none);
}

static inline int takes_part(const world* w, int b, const vox_query_desc* desc) {
    return (desc->mask == 0 || (desc->mask >> b & 1)) && w->meshes[b] != desc->excluded;
}

static inline void random_point(uint64_t* random, int coarse, float p[3]) {
    for (int axis = 0; axis < 3; ++axis)
        p[axis] = coarse ? 0.25f * (float)random_below(random, 28) - 0.5f : random_float(random, -0.5f, 6.5f);
}

static inline void widen(const float p[3], double wide[3]) {
    for (int axis = 0; axis < 3; ++axis) wide[axis] = (double)p[axis];
}

static inline void corners_of(const body* b, uint32_t tet, const float* corners[4]) {
    for (int c = 0; c < 4; ++c) corners[c] = b->positions + 3 * b->tets[4 * tet + c];
}

/* Whether the boxes of a segment and of some points have nothing in common: a short cut for the exact
 * arithmetic. */
static inline int apart(const float* from, const float* to, const float* const* points, int count) {
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

#endif
