/* Small bodies cut from lattices of cubes, and operations on them. The maker of a body frees it. */
#ifndef VOX_SCENES_BODIES_H
#define VOX_SCENES_BODIES_H

#include "scenes/random.h"
#include "src/mesh/cube_lattice.h"

#include <vox/vox.h>

#include <stdlib.h>
#include <string.h>

typedef struct body {
    float* positions; /* 3 * vertex_count */
    uint32_t* tets;   /* 4 * tet_count */
    uint32_t vertex_count;
    uint32_t tet_count;
} body;

/* Five tetrahedra a cube: one in the middle and four around it. Cubes alternate between the two ways to cut,
 * so that neighbours share facets. All tetrahedra are positive. */
static const cube_cut five_cut = {5,
                                  {{{0, 1, 2, 4}, {3, 2, 1, 7}, {5, 4, 7, 1}, {6, 7, 4, 2}, {1, 2, 4, 7}},
                                   {{1, 3, 0, 5}, {2, 0, 3, 6}, {4, 6, 5, 0}, {7, 5, 6, 3}, {0, 5, 3, 6}}}};

/* The cut with the two ways exchanged, and other numbers. */
static const cube_cut five_cut_exchanged = {
    5,
    {{{0, 1, 3, 5}, {0, 3, 2, 6}, {0, 5, 6, 4}, {3, 6, 5, 7}, {0, 3, 6, 5}},
     {{1, 2, 0, 4}, {1, 3, 2, 7}, {1, 4, 5, 7}, {2, 6, 4, 7}, {1, 2, 4, 7}}}};

static inline void free_body(body* b) {
    free(b->positions);
    free(b->tets);
    b->positions = NULL;
    b->tets = NULL;
}

/* nx * ny * nz cubes with edge 1 from the origin on. */
static inline body make_block(const cube_cut* cut, uint32_t nx, uint32_t ny, uint32_t nz) {
    body block;
    block.vertex_count = (nx + 1) * (ny + 1) * (nz + 1);
    block.tet_count = cut->tet_count * nx * ny * nz;
    block.positions = (float*)malloc(3 * sizeof(float) * block.vertex_count);
    block.tets = (uint32_t*)malloc(4 * sizeof(uint32_t) * block.tet_count);
    write_lattice_positions(nx, ny, nz, block.positions);
    write_lattice_tets(cut, nx, ny, nz, block.tets);
    return block;
}

/* A box of n * n * n cubes with edge h and lowest corner (x, y, z), each cut into five tets. Positions are
 * exact where x, y, z and h are small dyadic numbers. */
static inline body make_box(uint32_t n, float h, float x, float y, float z) {
    body box = make_block(&five_cut, n, n, n);
    for (uint32_t v = 0; v < box.vertex_count; ++v) {
        float* p = box.positions + 3 * v;
        p[0] = x + h * p[0];
        p[1] = y + h * p[1];
        p[2] = z + h * p[2];
    }
    return box;
}

/* Removes the tets for which `kept` is 0, and vertices that no other tet has. */
static inline void keep_tets(body* b, const uint8_t* kept) {
    uint32_t* number = (uint32_t*)calloc((size_t)b->vertex_count + 1, sizeof(uint32_t));
    uint32_t tets = 0, vertices = 0;
    for (uint32_t t = 0; t < b->tet_count; ++t) {
        if (!kept[t]) continue;
        memmove(b->tets + 4 * (size_t)tets, b->tets + 4 * (size_t)t, 4 * sizeof(uint32_t));
        for (uint32_t c = 0; c < 4; ++c) number[b->tets[4 * (size_t)tets + c]] = 1;
        ++tets;
    }
    for (uint32_t v = 0; v < b->vertex_count; ++v) {
        if (!number[v]) continue;
        memmove(b->positions + 3 * (size_t)vertices, b->positions + 3 * (size_t)v, 3 * sizeof(float));
        number[v] = vertices++;
    }
    for (size_t i = 0; i < 4 * (size_t)tets; ++i) b->tets[i] = number[b->tets[i]];
    free(number);
    b->vertex_count = vertices;
    b->tet_count = tets;
}

/* The cubes with edge 1 whose centres lie in a ball around the origin, out of 2 `half` cubes on each axis. */
static inline body make_lattice_ball(const cube_cut* cut, uint32_t half, double radius) {
    const uint32_t n = 2 * half;
    body ball = make_block(cut, n, n, n);
    uint8_t* kept = (uint8_t*)malloc((size_t)ball.tet_count + 1);
    for (uint32_t t = 0; t < ball.tet_count; ++t) {
        const uint32_t cube = t / cut->tet_count;
        const double x = cube % n + 0.5 - half, y = cube / n % n + 0.5 - half,
                     z = cube / (n * n) + 0.5 - half;
        kept[t] = x * x + y * y + z * z <= radius * radius;
    }
    keep_tets(&ball, kept);
    free(kept);
    for (uint32_t i = 0; i < 3 * ball.vertex_count; ++i) ball.positions[i] -= (float)half;
    return ball;
}

/* Moves every vertex by up to `amount` on each axis. */
static inline void jitter_body(body* b, double amount, uint64_t seed) {
    for (uint32_t i = 0; i < 3 * b->vertex_count; ++i)
        b->positions[i] = (float)(b->positions[i] + amount * random_symmetric(&seed));
}

static inline void move_body(body* b, double x, double y, double z) {
    for (uint32_t v = 0; v < b->vertex_count; ++v) {
        b->positions[3 * v] = (float)(b->positions[3 * v] + x);
        b->positions[3 * v + 1] = (float)(b->positions[3 * v + 1] + y);
        b->positions[3 * v + 2] = (float)(b->positions[3 * v + 2] + z);
    }
}

/* The desc of a body whose positions are borrowed. */
static inline vox_mesh_desc body_desc(const body* b) {
    return vox_mesh_desc_floats(b->positions, b->vertex_count, b->tets, b->tet_count);
}

/* The tet with corners at the origin and at 1 on each axis. */
static const float unit_tet_positions[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
static const uint32_t unit_tet[4] = {0, 1, 2, 3};

#endif
