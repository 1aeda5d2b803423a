/* Scenes for the tests of readings, and the expected readings by brute force over every triangle of every
 * surface. */
#ifndef VOX_TESTS_READING_CHECKS_H
#define VOX_TESTS_READING_CHECKS_H

#include <math.h>
#include <string.h>

#include "scenes/bodies.h"
#include "scenes/random.h"
#include "support/suite.h"

/* ---- brute force ---- */

typedef struct facet {
    uint32_t sorted[3], opposite;
    uint32_t part; /* of the mesh that its tetrahedron belongs to */
} facet;

static inline int compare_facets(const void* x, const void* y) {
    return memcmp(
        x, y, sizeof(uint32_t) * 4); /* any order that brings equal corners together, then equal opposites */
}

/* The facets of exactly one tetrahedron, doubled ones once; returns their number. part(t) = t / tets_a_part.
 */
static inline uint32_t surface_of(const uint32_t* tets, uint32_t count, uint32_t tets_a_part, facet** out) {
    facet* all = (facet*)malloc(sizeof(facet) * (4 * (size_t)count + 1));
    uint32_t n = 0, kept = 0;
    for (uint32_t t = 0; t < count; ++t) {
        const uint32_t* v = tets + 4 * t;
        int twice = 0;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < i; ++j) twice |= v[i] == v[j];
        if (twice) continue;
        for (int i = 0; i < 4; ++i) {
            facet f = {{0, 0, 0}, v[i], t / tets_a_part};
            for (int j = 0, k = 0; j < 4; ++j)
                if (j != i) f.sorted[k++] = v[j];
            for (int a = 0; a < 2; ++a)
                for (int b = 0; b < 2; ++b)
                    if (f.sorted[b] > f.sorted[b + 1]) {
                        const uint32_t swapped = f.sorted[b];
                        f.sorted[b] = f.sorted[b + 1];
                        f.sorted[b + 1] = swapped;
                    }
            all[n++] = f;
        }
    }
    qsort(all, n, sizeof(facet), compare_facets);
    for (uint32_t first = 0, last; first < n; first = last) {
        int sides = 1;
        for (last = first + 1;
             last < n && memcmp(all[last].sorted, all[first].sorted, sizeof all->sorted) == 0; ++last)
            sides += all[last].opposite != all[last - 1].opposite;
        if (sides == 1) all[kept++] = all[first];
    }
    *out = all;
    return kept;
}

static inline double dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static inline void minus(const double* a, const double* b, double* out) {
    for (int i = 0; i < 3; ++i) out[i] = a[i] - b[i];
}
static inline void cross(const double* a, const double* b, double* out) {
    for (int i = 0; i < 3; ++i) out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static inline double squared_to_segment(const double* p, const double* a, const double* b) {
    double ab[3], ap[3], rest[3];
    minus(b, a, ab);
    minus(p, a, ap);
    const double length = dot(ab, ab);
    const double t = length > 0 ? fmin(fmax(dot(ap, ab) / length, 0), 1) : 0;
    for (int i = 0; i < 3; ++i) rest[i] = ap[i] - t * ab[i];
    return dot(rest, rest);
}

static inline double squared_to_triangle(const double* p, const double* a, const double* b, const double* c) {
    const double* corner[3] = {a, b, c};
    double ab[3], ac[3], normal[3], ap[3];
    minus(b, a, ab);
    minus(c, a, ac);
    minus(p, a, ap);
    cross(ab, ac, normal);
    const double area = dot(normal, normal);
    int above = area > 0;
    for (int i = 0; i < 3 && above; ++i) {
        double edge[3], to_p[3], side[3];
        minus(corner[(i + 1) % 3], corner[i], edge);
        minus(p, corner[i], to_p);
        cross(edge, to_p, side);
        above = dot(side, normal) >= 0;
    }
    if (above) return dot(ap, normal) * dot(ap, normal) / area;
    return fmin(squared_to_segment(p, a, b), fmin(squared_to_segment(p, b, c), squared_to_segment(p, c, a)));
}

/* ---- scenes ---- */

enum { most_bodies = 4 };

typedef struct model {
    body shape;
    double* positions; /* as they collide */
    double* given;     /* as the grid borrows them, where these are doubles */
    facet* surface;
    uint32_t surface_count;
    uint32_t tets_a_part;
    vox_body mesh;
    int self;
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

static inline vox_mesh_desc desc_of(const model* m, int index) {
    vox_mesh_desc desc = body_desc(&m->shape);
    if (m->given) {
        desc.positions.data = m->given;
        desc.positions.format = VOX_FORMAT_DOUBLE;
    }
    if (m->self) desc.filter.flags |= VOX_FILTER_SELF_COLLISION;
    desc.user_data = 1000 + (uint64_t)index;
    return desc;
}

static inline void complete(model* m) {
    m->positions = (double*)malloc(sizeof(double) * 3 * m->shape.vertex_count);
    for (uint32_t i = 0; i < 3 * m->shape.vertex_count; ++i)
        m->positions[i] = m->given ? m->given[i] : (double)m->shape.positions[i];
    if (m->tets_a_part == 0) m->tets_a_part = m->shape.tet_count + 1;
    m->surface_count = surface_of(m->shape.tets, m->shape.tet_count, m->tets_a_part, &m->surface);
}

static inline void insert(world* w, vox_grid* grid) {
    for (int i = 0; i < w->count; ++i) {
        const vox_mesh_desc desc = desc_of(&w->models[i], i);
        ck_ok(vox_mesh_insert(grid, &desc, &w->models[i].mesh));
    }
}

static inline void end_world(world* w) {
    vox_grid_destroy(w->grid);
    for (int i = 0; i < w->count; ++i) {
        free_body(&w->models[i].shape);
        free(w->models[i].positions);
        free(w->models[i].given);
        free(w->models[i].surface);
    }
}

/* Boxes that overlap each other. `coarse`: on a lattice of quarters, so that vertices meet facets, edges and
 * corners and many triangles are equally far. */
static inline world random_world(uint64_t* random, int coarse) {
    world w;
    memset(&w, 0, sizeof w);
    w.count = 2 + (int)random_below(random, most_bodies - 1);
    for (int b = 0; b < w.count; ++b) {
        model* m = &w.models[b];
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
            m->given = (double*)malloc(sizeof(double) * coordinates);
            for (uint32_t i = 0; i < coordinates; ++i)
                m->given[i] =
                    (double)m->shape.positions[i] + (coarse ? 0 : 1e-9 * (double)random_float(random, -1, 1));
        }
        complete(m);
    }
    w.grid = new_grid(suite_engine, VOX_GRID_PENETRATIONS, 1);
    insert(&w, w.grid);
    return w;
}

/* Of n cubes along an edge each. */
static inline void two_in_each_other(world* w, uint32_t n, uint32_t flags) {
    memset(w, 0, sizeof *w);
    w->count = 2;
    for (int b = 0; b < 2; ++b) {
        w->models[b].shape = make_box(n, 1, 1.3f * (float)b, 0.2f * (float)b, 0.1f * (float)b);
        complete(&w->models[b]);
    }
    w->grid = new_grid(suite_engine, flags, 1);
    insert(w, w->grid);
}

/* ---- one reading ---- */

static inline int index_of(const world* w, vox_body mesh) {
    for (int i = 0; i < w->count; ++i)
        if (w->models[i].mesh == mesh) return i;
    ck_abort_msg("no mesh %u", mesh);
    return -1;
}

/* The closest triangle by definition, of parts other than that of the vertex for self-contact; its squared
 * distance. Of those exactly as close, as computed here, the lowest. */
static inline double closest_by_definition(const model* b, const double* p, uint32_t part,
                                           const facet** out) {
    double least = INFINITY;
    for (uint32_t f = 0; f < b->surface_count; ++f) {
        const facet* candidate = &b->surface[f];
        if (part != UINT32_MAX && candidate->part != part) continue;
        const double squared = squared_to_triangle(p, b->positions + 3 * candidate->sorted[0],
                                                   b->positions + 3 * candidate->sorted[1],
                                                   b->positions + 3 * candidate->sorted[2]);
        int lower = squared < least;
        if (squared == least)
            for (int i = 0, differ = 0; i < 3 && !differ; ++i) {
                differ = candidate->sorted[i] != (*out)->sorted[i];
                if (differ) lower = candidate->sorted[i] < (*out)->sorted[i];
            }
        if (!lower) continue;
        least = squared;
        *out = candidate;
    }
    return least;
}

static inline const facet* facet_of(const model* b, const uint32_t triangle[3]) {
    for (uint32_t f = 0; f < b->surface_count; ++f) {
        int same = 0;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) same += triangle[i] == b->surface[f].sorted[j];
        if (same == 3) return &b->surface[f];
    }
    return NULL;
}

/* Checks one reading; `exact`: all distances are exact, so that ties are too. Returns 1 when it has a
 * surface. */
static inline int check_reading(const world* w, const vox_contact* contact, const vox_reading* reading,
                                int exact) {
    const model *a = &w->models[index_of(w, contact->body_a)], *b = &w->models[index_of(w, contact->body_b)];
    const double* p = a->positions + 3 * contact->vertex;
    ck_assert_uint_eq(reading->user_data_a, 1000 + (uint64_t)(a - w->models));
    ck_assert_uint_eq(reading->user_data_b, 1000 + (uint64_t)(b - w->models));
    ck_assert(reading->known & VOX_READING_POSITION);
    ck_assert_mem_eq(reading->position, p, sizeof reading->position);
    const uint32_t part = a == b ? contact->tet / b->tets_a_part : UINT32_MAX;
    const facet* wanted = NULL;
    const double least = closest_by_definition(b, p, part, &wanted);
    ck_assert_int_eq((reading->known & VOX_READING_SURFACE) != 0, wanted != NULL);
    if (!wanted) return 0;

    const facet* found = facet_of(b, reading->triangle);
    ck_assert_ptr_nonnull(found);
    ck_assert_uint_eq(reading->triangle[0], found->sorted[0]);
    const double* corner[3];
    for (int i = 0; i < 3; ++i) corner[i] = b->positions + 3 * reading->triangle[i];
    const double squared = squared_to_triangle(p, corner[0], corner[1], corner[2]);
    ck_assert_double_le(fabs(reading->distance - sqrt(least)), 1e-12 + 1e-9 * sqrt(least));
    ck_assert_double_le(fabs(reading->distance - sqrt(squared)), 1e-12 + 1e-9 * sqrt(squared));
    if (exact) ck_assert_mem_eq(found->sorted, wanted->sorted, sizeof found->sorted);

    double sum = 0, at[3] = {0, 0, 0}, way[3];
    for (int i = 0; i < 3; ++i) {
        ck_assert_double_ge(reading->barycentric[i], -1e-12);
        sum += reading->barycentric[i];
        for (int axis = 0; axis < 3; ++axis) at[axis] += reading->barycentric[i] * corner[i][axis];
    }
    ck_assert_double_eq_tol(sum, 1, 1e-12);
    for (int axis = 0; axis < 3; ++axis)
        ck_assert_double_eq_tol(at[axis], reading->surface_position[axis], 1e-12);
    minus(reading->surface_position, p, way);
    ck_assert_double_eq_tol(sqrt(dot(way, way)), reading->distance, 1e-9);

    /* Outwards, and the triangle wound to suit. */
    double ab[3], ac[3], normal[3], inward[3];
    minus(corner[1], corner[0], ab);
    minus(corner[2], corner[0], ac);
    cross(ab, ac, normal);
    minus(b->positions + 3 * found->opposite, corner[0], inward);
    const double area = sqrt(dot(normal, normal));
    ck_assert_double_eq_tol(dot(reading->normal, reading->normal), 1, 1e-9);
    if (area > 1e-9) {
        ck_assert_double_ge(dot(reading->normal, normal), (1 - 1e-9) * area);
        ck_assert_double_le(dot(normal, inward), 1e-12);
    }
    return 1;
}

/* Checks all readings of the last step; returns how many have a surface. */
static inline uint64_t check_readings(const world* w, int exact) {
    vox_reading_view readings;
    uint64_t surfaces = 0;
    ck_ok(vox_grid_prepare_readings(w->grid));
    vox_contact_view contacts = contacts_of(w->grid);
    ck_ok(vox_grid_readings(w->grid, &readings));
    ck_assert_uint_eq(readings.count, contacts.count);
    ck_assert_uint_eq(readings.epoch, contacts.epoch);
    for (uint64_t i = 0; i < readings.count; ++i) {
        const vox_reading* reading =
            (const vox_reading*)(const void*)((const char*)readings.data + i * readings.byte_stride);
        ck_assert_uint_eq(reading->contact, i);
        surfaces += (uint64_t)check_reading(w, &contacts.data[i], reading, exact);
    }
    return surfaces;
}

#endif
