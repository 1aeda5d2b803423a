/* Bodies that overlap in every way, and move, for the tests of constraints. */
#ifndef VOX_TESTS_CONSTRAINT_SCENES_H
#define VOX_TESTS_CONSTRAINT_SCENES_H

#include "scenes/random.h"
#include "support/depth_checks.h"

enum { most_bodies = 4 };

typedef struct model {
    body shape;
    double* doubles; /* what the grid borrows in place of the shape's positions; or null */
    float* before;   /* positions before the step, once it moves */
    vox_filter filter;
    vox_body id;
} model;

typedef struct world {
    vox_grid* grid;
    model models[most_bodies];
    int count;
} world;

static inline vox_grid* new_grid(engine_kind engine, uint32_t flags, uint32_t workers) {
    vox_grid_desc desc = vox_default_grid_desc();
    use_engine(&desc, engine);
    desc.flags = flags;
    desc.worker_count = workers;
    return grid_of(&desc);
}

static inline vox_positions positions_of(const model* m) {
    return m->doubles ? vox_double_positions(m->doubles, m->shape.vertex_count)
                      : vox_float_positions(m->shape.positions, m->shape.vertex_count);
}

/* Inserts body `index` of the world into any grid. */
static inline vox_body insert_model(vox_grid* grid, const world* w, int index) {
    const model* m = &w->models[index];
    vox_mesh_desc desc = body_desc(&m->shape);
    desc.positions = positions_of(m);
    desc.filter = m->filter;
    desc.user_data = 1000 + (uint64_t)index;
    const vox_body id = insert_mesh(grid, &desc);
    if (m->before) ck_ok(bind_previous_array(grid, id, m->before, VOX_FORMAT_FLOAT, 0, 0));
    return id;
}

static inline void insert_models(vox_grid* grid, world* w) {
    for (int i = 0; i < w->count; ++i) w->models[i].id = insert_model(grid, w, i);
}

static inline void end_world(world* w) {
    vox_grid_destroy(w->grid);
    for (int i = 0; i < w->count; ++i) {
        free_body(&w->models[i].shape);
        free(w->models[i].doubles);
        free(w->models[i].before);
    }
}

static inline int index_of(const world* w, vox_body id) {
    for (int i = 0; i < w->count; ++i)
        if (w->models[i].id == id) return i;
    ck_abort_msg("no body %u", id);
    return -1;
}

/* Boxes that overlap each other. `coarse`: on a lattice of quarters, so that vertices meet facets, edges and
 * corners and many triangles are equally far. */
static inline void make_random_models(world* w, uint64_t* random, int coarse) {
    memset(w, 0, sizeof *w);
    w->count = 2 + (int)random_below(random, most_bodies - 1);
    for (int b = 0; b < w->count; ++b) {
        model* m = &w->models[b];
        const uint32_t kind = random_below(random, 6);
        float at[3];
        for (int axis = 0; axis < 3; ++axis)
            at[axis] = coarse ? 0.25f * (float)random_below(random, 8) : random_float(random, 0, 2);
        m->shape = make_box(1 + random_below(random, 3), 1, at[0], at[1], at[2]);
        const uint32_t coordinates = 3 * m->shape.vertex_count;
        for (uint32_t i = 0; !coarse && i < coordinates; ++i)
            m->shape.positions[i] += random_float(random, -0.2f, 0.2f);
        if (kind == 0) { /* inside out */
            for (uint32_t t = 0; t < m->shape.tet_count; ++t) {
                const uint32_t swapped = m->shape.tets[4 * t];
                m->shape.tets[4 * t] = m->shape.tets[4 * t + 1];
                m->shape.tets[4 * t + 1] = swapped;
            }
        } else if (kind == 1) { /* some tetrahedra flat, inverted, doubled, or gone from the middle */
            for (uint32_t t = 0; t < m->shape.tet_count; t += 7) {
                uint32_t* v = m->shape.tets + 4 * t;
                const uint32_t what = random_below(random, 3);
                if (what == 0) memcpy(v, m->shape.tets + 4 * (m->shape.tet_count - 1 - t), 4 * sizeof *v);
                if (what == 1)
                    memcpy(m->shape.positions + 3 * v[0], m->shape.positions + 3 * v[1], 3 * sizeof(float));
                if (what == 2) v[2] = v[3];
            }
        } else if (kind == 2 && b > 0) { /* points alone */
            m->shape.tet_count = 0;
        }
        if (random_below(random, 2)) { /* doubles that no float comes near */
            m->doubles = (double*)malloc(sizeof(double) * coordinates);
            for (uint32_t i = 0; i < coordinates; ++i)
                m->doubles[i] =
                    (double)m->shape.positions[i] + (coarse ? 0 : 1e-9 * (double)random_float(random, -1, 1));
        }
    }
}

static inline world random_world(uint64_t* random, int coarse, uint32_t flags) {
    world w;
    make_random_models(&w, random, coarse);
    w.grid = new_grid(suite_engine, flags, 1);
    insert_models(w.grid, &w);
    return w;
}

/* Two boxes of n cubes along an edge each. */
static inline world two_in_each_other(uint32_t n, const vox_grid_desc* desc) {
    world w;
    memset(&w, 0, sizeof w);
    w.count = 2;
    for (int b = 0; b < 2; ++b)
        w.models[b].shape = make_box(n, 1, 1.3f * (float)b, 0.2f * (float)b, 0.1f * (float)b);
    w.grid = grid_of(desc);
    insert_models(w.grid, &w);
    return w;
}

/* Bodies that have constraints of all kinds, with each other and one with itself, while they move. */
static inline world moving_world(uint64_t* random) {
    world w;
    make_random_models(&w, random, random_below(random, 4) == 0);
    for (int b = 0; b < w.count; ++b) {
        model* m = &w.models[b];
        const size_t bytes = 3 * sizeof(float) * m->shape.vertex_count;
        m->before = (float*)malloc(bytes);
        memcpy(m->before, m->shape.positions, bytes);
        m->filter.category = (uint64_t)1 << b;
        if (b == 1) m->filter.flags = VOX_FILTER_SELF_COLLISION;
    }
    return w;
}

/* To be called before each step: some bodies move, so far now and then that they go through others. */
static inline void move_world(world* w, uint64_t* random) {
    for (int b = 0; b < w->count; ++b) {
        model* m = &w->models[b];
        const uint32_t coordinates = 3 * m->shape.vertex_count, how = random_below(random, 4);
        memcpy(m->before, m->shape.positions, coordinates * sizeof(float));
        const float far = how == 0 ? 1.5f : 0.1f, shaken = how == 1 ? 0.1f : 0;
        float by[3];
        for (int axis = 0; axis < 3; ++axis) {
            /* Back to the others, as a rule. */
            const float at = m->shape.positions[axis], drift = at > 2 ? -0.5f : at < -1 ? 0.5f : 0;
            by[axis] = far * (random_float(random, -1, 1) + drift);
        }
        for (uint32_t i = 0; how < 3 && i < coordinates; ++i) {
            const float change = by[i % 3] + shaken * random_float(random, -1, 1);
            m->shape.positions[i] += change;
            if (m->doubles) m->doubles[i] = (double)m->shape.positions[i] + 1e-9 * (i % 7);
        }
    }
}

#endif
