/* Small bodies for tests, made on the spot. */
#ifndef VOX_TESTS_BODIES_H
#define VOX_TESTS_BODIES_H

#include <stdint.h>
#include <stdlib.h>
#include <vox/vox.h>

typedef struct body {
    float* positions; /* 3 * vertex_count */
    uint32_t* tets;   /* 4 * tet_count */
    uint32_t vertex_count;
    uint32_t tet_count;
} body;

/* A box of n * n * n cubes with edge h and lowest corner (x, y, z), each cut into five tets; the cut alternates, so that
 * neighbours share facets. Positions are exact where x, y, z and h are small dyadic numbers. */
static inline body make_box(uint32_t n, float h, float x, float y, float z) {
    static const uint32_t even[5][4] = {{0, 1, 2, 4}, {3, 2, 1, 7}, {5, 4, 7, 1}, {6, 7, 4, 2}, {1, 2, 4, 7}};
    static const uint32_t odd[5][4] = {{1, 3, 0, 5}, {2, 0, 3, 6}, {4, 6, 5, 0}, {7, 5, 6, 3}, {0, 5, 3, 6}};
    const uint32_t m = n + 1;
    body box;
    box.vertex_count = m * m * m;
    box.tet_count = 5 * n * n * n;
    box.positions = (float*)malloc(3 * sizeof(float) * box.vertex_count);
    box.tets = (uint32_t*)malloc(4 * sizeof(uint32_t) * box.tet_count);
    for (uint32_t k = 0, v = 0; k < m; ++k)
        for (uint32_t j = 0; j < m; ++j)
            for (uint32_t i = 0; i < m; ++i, ++v) {
                box.positions[3 * v] = x + h * (float)i;
                box.positions[3 * v + 1] = y + h * (float)j;
                box.positions[3 * v + 2] = z + h * (float)k;
            }
    for (uint32_t k = 0, t = 0; k < n; ++k)
        for (uint32_t j = 0; j < n; ++j)
            for (uint32_t i = 0; i < n; ++i)
                for (uint32_t s = 0; s < 5; ++s, ++t)
                    for (uint32_t c = 0; c < 4; ++c) {
                        const uint32_t corner = (i + j + k) % 2 ? odd[s][c] : even[s][c];
                        box.tets[4 * t + c] =
                            ((k + (corner >> 2)) * m + j + (corner >> 1 & 1)) * m + i + (corner & 1);
                    }
    return box;
}

static inline void free_body(body* b) {
    free(b->positions);
    free(b->tets);
    b->positions = NULL;
    b->tets = NULL;
}

/* The desc of a body whose positions are borrowed. */
static inline vox_mesh_desc body_desc(const body* b) {
    vox_mesh_desc desc = vox_default_mesh_desc();
    desc.positions = b->positions;
    desc.vertex_count = b->vertex_count;
    desc.tets = b->tets;
    desc.tet_count = b->tet_count;
    return desc;
}

/* A desc over plain arrays. */
static inline vox_mesh_desc array_desc(const float* positions, uint64_t vertices, const uint32_t* tets,
                                       uint64_t tet_count) {
    vox_mesh_desc desc = vox_default_mesh_desc();
    desc.positions = positions;
    desc.vertex_count = vertices;
    desc.tets = tets;
    desc.tet_count = tet_count;
    return desc;
}

/* The tet with corners at the origin and at 1 on each axis. */
static const float unit_tet_positions[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
static const uint32_t unit_tet[4] = {0, 1, 2, 3};

#endif
