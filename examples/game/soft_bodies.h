/* The game's bodies and their physics: balls in a pit, moved by XPBD (response/xpbd.c explains it). */
#ifndef VOX_EXAMPLES_SOFT_BODIES_H
#define VOX_EXAMPLES_SOFT_BODIES_H

#include "example.h"
#include "scenes/solids.h"

enum { bodies = 300, side = 7, substeps = 8 };

#define RADIUS 0.5              /* metres */
#define PIT (0.52 * side)       /* half of its width */
#define H (1.0 / 60 / substeps) /* seconds of a substep */
#define GRAVITY 9.81
#define FRICTION 0.4
#define SLOP 0.01     /* depth that stays, so that a touch lasts from frame to frame */
#define PUSH 0.5      /* metres per second: how fast bodies that overlapped before are moved apart */
#define STIFFNESS 1.0 /* part of the change of an edge's length that a substep undoes */

typedef struct edge {
    uint32_t ends[2];
    double length;
} edge;

/* All bodies have the same mesh. Body b has the vertices from b * shape.vertex_count on. */
static solid shape;
static edge* edges;
static uint32_t edge_count;
static double (*x)[3], (*before)[3], (*v)[3]; /* positions, those at the beginning of a substep, velocities */

static double dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void add(double* to, double factor, const double* a) {
    for (int k = 0; k < 3; ++k) to[k] += factor * a[k];
}

static void make_shape(void) {
    static const int corners[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
    shape = make_lattice_solid(6, 6, 6, 2.15, 0.1, 1); /* in cubes of the lattice */
    for (uint32_t i = 0; i < 3 * shape.vertex_count; ++i) shape.positions[i] -= 3;
    round_solid(&shape, 2.15);
    for (uint32_t i = 0; i < 3 * shape.vertex_count; ++i) shape.positions[i] *= RADIUS / 2.15;
    uint8_t* seen = (uint8_t*)calloc(shape.vertex_count, shape.vertex_count);
    edges = (edge*)malloc(6 * sizeof(edge) * shape.tet_count);
    for (uint32_t i = 0; i < 6 * shape.tet_count; ++i) {
        const uint32_t* tet = shape.tets + 4 * (i / 6);
        const uint32_t p = tet[corners[i % 6][0]], q = tet[corners[i % 6][1]];
        uint8_t* is_seen = seen + shape.vertex_count * (p < q ? p : q) + (p < q ? q : p);
        if (*is_seen) continue;
        *is_seen = 1;
        double along[3] = {0, 0, 0};
        add(along, 1, shape.positions + 3 * p);
        add(along, -1, shape.positions + 3 * q);
        edges[edge_count].ends[0] = p;
        edges[edge_count].ends[1] = q;
        edges[edge_count++].length = sqrt(dot(along, along));
    }
    free(seen);
}

/* Layers of 49 bodies, whose centres are `distance` apart, but for up to 0.05 in x and y. */
static void place_bodies(double distance) {
    uint64_t seed = 7;
    for (size_t b = 0; b < bodies; ++b) {
        const size_t place[3] = {b % side, b / side % side, b / (side * side)};
        for (int k = 0; k < 3; ++k) {
            const double wanted = k < 2 ? (double)place[k] - (side - 1) / 2.0 : (double)place[k] + 0.55,
                         centre = distance * wanted + (k < 2 ? 0.05 * random_symmetric(&seed) : 0);
            for (uint32_t i = 0; i < shape.vertex_count; ++i)
                x[b * shape.vertex_count + i][k] = centre + shape.positions[3 * i + (uint32_t)k];
        }
    }
}

/* The user data of a body is its number. */
static void insert_bodies(vox_grid* grid) {
    const size_t vertices = (size_t)bodies * shape.vertex_count;
    x = (double(*)[3])calloc(vertices, sizeof *x);
    before = (double(*)[3])calloc(vertices, sizeof *before);
    v = (double(*)[3])calloc(vertices, sizeof *v);
    for (size_t b = 0; b < bodies; ++b) {
        vox_mesh_desc desc =
            vox_mesh_desc_doubles(x[b * shape.vertex_count], shape.vertex_count, shape.tets, shape.tet_count);
        desc.user_data = b;
        vox_body id = VOX_NULL_BODY;
        must(vox_mesh_insert(grid, &desc, &id));
    }
}

static void free_bodies(void) {
    free(x);
    free(before);
    free(v);
    free(edges);
    free_solid(&shape);
}

/* Where vertex i of a constraint is in the arrays. */
static size_t vertex_of(const vox_constraint* c, uint32_t i) {
    return (size_t)(i < c->count_a ? c->user_data_a : c->user_data_b) * shape.vertex_count + c->vertices[i];
}

static void push(const vox_constraint* c, double impulse, const double* direction) {
    for (uint32_t i = 0; i < c->count; ++i) add(x[vertex_of(c, i)], impulse * c->weights[i], direction);
}

static void solve_contact(const vox_constraint* c) {
    double slip[3] = {0, 0, 0}, gap = c->offset, weight = 0;
    for (uint32_t i = 0; i < c->count; ++i) {
        const size_t at = vertex_of(c, i);
        gap += c->weights[i] * dot(c->normal, x[at]);
        weight += c->weights[i] * c->weights[i];
        add(slip, c->weights[i], x[at]);
        add(slip, -c->weights[i], before[at]);
    }
    if (gap >= -SLOP) return;
    const double approach = fmax(-dot(slip, c->normal), 0); /* in this substep */
    const double impulse = fmin(-gap - SLOP, approach + PUSH * H) / weight;
    push(c, impulse, c->normal);
    add(slip, -dot(slip, c->normal), c->normal); /* Coulomb: against the sliding, and no more than it */
    const double length = sqrt(dot(slip, slip)), most = FRICTION * impulse;
    if (length > 0) push(c, most < length / weight ? -most / length : -1 / weight, slip);
}

static void solve_edge(const edge* e, double (*of_body)[3]) {
    double *p = of_body[e->ends[0]], *q = of_body[e->ends[1]];
    const double along[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
    const double length = sqrt(dot(along, along)), move = STIFFNESS / 2 * (length - e->length) / length;
    add(p, move, along);
    add(q, -move, along);
}

static void keep_in_pit(size_t i) {
    for (int k = 0; k < 2; ++k) x[i][k] = x[i][k] < -PIT ? -PIT : x[i][k] > PIT ? PIT : x[i][k];
    if (x[i][2] < 0) {
        memcpy(x[i], before[i], 2 * sizeof(double)); /* it sticks to the floor */
        x[i][2] = 0;
    }
}

/* Moves all bodies by H seconds. */
static void substep(const vox_constraint_view* found) {
    const size_t vertices = (size_t)bodies * shape.vertex_count;
    for (size_t i = 0; i < vertices; ++i) {
        memcpy(before[i], x[i], sizeof x[i]);
        v[i][2] -= GRAVITY * H;
        add(x[i], H, v[i]);
    }
    for (size_t b = 0; b < bodies; ++b)
        for (uint32_t e = 0; e < edge_count; ++e) solve_edge(&edges[e], x + b * shape.vertex_count);
    for (uint64_t n = 0; n < found->count; ++n) solve_contact(&found->data[n]);
    for (size_t i = 0; i < vertices; ++i) {
        keep_in_pit(i);
        for (int k = 0; k < 3; ++k) v[i][k] = 0.998 * (x[i][k] - before[i][k]) / H;
    }
}

#endif
