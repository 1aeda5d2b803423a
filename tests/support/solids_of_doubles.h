/* Bodies whose positions are doubles, written in any format and stride, in every range of doubles. */
#ifndef VOX_TESTS_SOLIDS_OF_DOUBLES_H
#define VOX_TESTS_SOLIDS_OF_DOUBLES_H

#include <math.h>
#include <string.h>

#include "scenes/bodies.h"
#include "scenes/random.h"
#include "support/constraint_checks.h"
#include "support/oracle.h"

static uint64_t state = 1;

static inline double random_double(double min, double max) { return min + (max - min) * random_unit(&state); }

/* ---- bodies of doubles ----------------------------------------------------------------------------------
 */

typedef struct solid {
    double* positions; /* 3 a vertex: what counts */
    uint32_t* tets;
    uint32_t vertex_count, tet_count;
    vox_format format;
    uint64_t stride;
    unsigned char* bytes; /* the same in that format and stride: what the library reads */
} solid;

static inline solid make_solid(uint32_t n) {
    body box = make_box(n, 1, 0, 0, 0);
    solid s = {NULL, box.tets, box.vertex_count, box.tet_count, VOX_FORMAT_DOUBLE, 24, NULL};
    s.positions = (double*)malloc(3 * sizeof(double) * s.vertex_count);
    for (uint32_t i = 0; i < 3 * s.vertex_count; ++i) s.positions[i] = box.positions[i];
    free(box.positions);
    return s;
}

/* Writes the positions as the library is to read them; rounds them first where they are floats. */
static inline void write_solid(solid* s, vox_format format, uint64_t stride) {
    s->format = format;
    s->stride = stride;
    s->bytes = (unsigned char*)realloc(s->bytes, stride * s->vertex_count + 8);
    for (uint32_t v = 0; v < s->vertex_count; ++v) {
        float rounded[3];
        for (int a = 0; a < 3; ++a) {
            double* x = &s->positions[3 * v + a];
            rounded[a] = (float)*x;
            if (format == VOX_FORMAT_FLOAT) *x = (double)rounded[a];
        }
        if (format == VOX_FORMAT_FLOAT)
            memcpy(s->bytes + v * stride, rounded, sizeof rounded);
        else
            memcpy(s->bytes + v * stride, s->positions + 3 * v, 3 * sizeof(double));
    }
}

static inline void free_solid(solid* s) {
    free(s->positions);
    free(s->tets);
    free(s->bytes);
}

static inline vox_mesh_desc solid_desc(const solid* s) {
    vox_mesh_desc desc = vox_default_mesh_desc();
    desc.positions.data = s->bytes;
    desc.positions.format = s->format;
    desc.positions.byte_stride = s->stride;
    desc.positions.count = s->vertex_count;
    desc.tets = s->tets;
    desc.tet_count = s->tet_count;
    return desc;
}

static inline vox_grid* new_grid(uint32_t workers) {
    vox_grid_desc desc = engine_desc();
    desc.worker_count = workers;
    return grid_of(&desc);
}

static inline vox_body insert(vox_grid* grid, const solid* s, uint32_t flags) {
    vox_mesh_desc desc = solid_desc(s);
    desc.flags = flags;
    return insert_mesh(grid, &desc);
}

static inline vox_body insert_self(vox_grid* grid, const solid* s) {
    vox_mesh_desc desc = solid_desc(s);
    desc.filter.flags = VOX_FILTER_SELF_COLLISION;
    return insert_mesh(grid, &desc);
}

/* The grid's contacts are those of the solids, which were inserted in this order, and so are the weights of
 * each vertex in the first tetrahedron that it is in. */
static inline size_t check_contacts(vox_grid* grid, const solid* solids, uint32_t count, const vox_body* ids,
                                    int self) {
    oracle_mesh_d meshes[4];
    oracle_contact* expected = NULL;
    uint64_t vertices = 0;
    for (uint32_t m = 0; m < count; ++m)
        meshes[m] = (oracle_mesh_d){solids[m].positions, solids[m].tets, solids[m].vertex_count,
                                    solids[m].tet_count, self};
    const size_t expected_count = oracle_contacts_d(meshes, count, &expected);
    const vox_contact_view view = contacts_of(grid);
    ck_assert_uint_eq(view.count, expected_count);
    find_weights(grid);
    for (size_t i = 0; i < expected_count; ++i) {
        const oracle_contact* e = &expected[i];
        ck_assert_uint_eq(view.data[i].body_a, ids[e->body_a]);
        ck_assert_uint_eq(view.data[i].vertex, e->vertex);
        ck_assert_uint_eq(view.data[i].body_b, ids[e->body_b]);
        ck_assert_uint_eq(view.data[i].tet, e->tet);
        ck_assert_uint_eq(view.interiors[i], e->interior);
        if (i > 0 && e->body_a == e[-1].body_a && e->vertex == e[-1].vertex && e->body_b == e[-1].body_b)
            continue;
        const vox_constraint* c = find_constraint(grid, ids[e->body_a], e->vertex, ids[e->body_b]);
        ck_assert_ptr_nonnull(c);
        ck_assert_int_eq(c->kind, VOX_CONSTRAINT_INSIDE);
        ck_assert_uint_eq(c->element_b, e->tet);
        for (uint32_t k = 0; k < 4; ++k) {
            ck_assert_uint_eq(c->vertices[1 + k], solids[e->body_b].tets[4 * e->tet + k]);
            ck_assert_double_le(fabs(-c->weights[1 + k] - e->barycentric[k]),
                                0x1p-52 * e->barycentric[k] + 0x1p-57);
        }
        ++vertices;
    }
    ck_assert_uint_eq(constraints_of(grid).count, vertices);
    free(expected);
    return expected_count;
}

/* ---- where they are ------------------------------------------------------------------------------------ */

typedef struct kind {
    const char* name;
    double scale, offset, jitter;
    int coarse; /* vertices on quarters of an edge: on faces, edges and corners of others, as far as doubles
                   go */
} kind;

static const kind kinds[] = {{"unit", 1, 0, 0.4, 0},
                             {"thirds", 1.0 / 3, 0, 0.4, 1},
                             {"dyadic, far", 0x1p-20, 1e6, 0.4, 1},
                             {"far", 1e-3, -1e9, 0.4, 0},
                             {"next to one another", 0x1p-50, 1, 0.4, 1},
                             {"very far", 1, 1e15, 0.5, 1},
                             {"tiny", 1e-60, 0, 0.4, 0},
                             {"products underflow", 1e-105, 0, 0.4, 1},
                             {"products vanish", 1e-200, 0, 0.4, 0},
                             {"denormal", 4 * 0x1p-1074, 0, 0.5, 1},
                             {"huge", 1e37, 0, 0.4, 0},
                             {"huge and far", 1e24, 2e38, 0.4, 0}};

static inline void place(solid* s, const kind* k, double x, double y, double z) {
    const double by[3] = {x, y, z};
    for (uint32_t i = 0; i < 3 * s->vertex_count; ++i) {
        double moved = s->positions[i] + by[i % 3] + random_double(-k->jitter, k->jitter);
        if (k->coarse) moved = floor(4 * moved) / 4;
        s->positions[i] = moved * k->scale + k->offset;
    }
}

#endif
