/* Blocks of cubes cut into tetrahedra, written into plain arrays. In C99 and under src/, since both the
 * library (cell_size/calibrate.cpp) and the bodies of tests, benchmarks and examples (scenes/bodies.h) are
 * made with it. */
#ifndef VOX_MESH_CUBE_LATTICE_H
#define VOX_MESH_CUBE_LATTICE_H

#include <stdint.h>

/* The tetrahedra of a cube (i, j, k), for even and for odd i + j + k. Corner c of a cube is at bit 0 of c on
 * x, bit 1 on y, bit 2 on z. */
typedef struct cube_cut {
    uint32_t tet_count;
    uint8_t tets[2][6][4];
} cube_cut;

/* Six tetrahedra around the diagonal from corner 0 to corner 7, one for each order of the axes (Kuhn); every
 * other one is inverted. Neighbouring cubes share facets without alternating. */
static const cube_cut kuhn_cut = {
    6,
    {{{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}},
     {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}}}};

/* The corners of nx * ny * nz cubes with edge 1, x fastest: 3 * (nx + 1) * (ny + 1) * (nz + 1) floats. */
static inline void write_lattice_positions(uint32_t nx, uint32_t ny, uint32_t nz, float* positions) {
    for (uint32_t k = 0; k <= nz; ++k)
        for (uint32_t j = 0; j <= ny; ++j)
            for (uint32_t i = 0; i <= nx; ++i) {
                *positions++ = (float)i;
                *positions++ = (float)j;
                *positions++ = (float)k;
            }
}

/* The tetrahedra of these cubes, x fastest: 4 * cut->tet_count * nx * ny * nz numbers. */
static inline void write_lattice_tets(const cube_cut* cut, uint32_t nx, uint32_t ny, uint32_t nz,
                                      uint32_t* tets) {
    for (uint32_t k = 0; k < nz; ++k)
        for (uint32_t j = 0; j < ny; ++j)
            for (uint32_t i = 0; i < nx; ++i)
                for (uint32_t t = 0; t < cut->tet_count; ++t)
                    for (uint32_t c = 0; c < 4; ++c) {
                        const uint32_t corner = cut->tets[(i + j + k) % 2][t][c];
                        *tets++ = ((k + (corner >> 2)) * (ny + 1) + j + (corner >> 1 & 1)) * (nx + 1) + i +
                                  (corner & 1);
                    }
}

#endif
