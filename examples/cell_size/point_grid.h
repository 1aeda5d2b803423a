/* A uniform grid of points as agent models and particle codes write it: a counting sort into voxels, x
 * fastest. */
#ifndef VOX_EXAMPLES_POINT_GRID_H
#define VOX_EXAMPLES_POINT_GRID_H

#include "example.h"

#include <time.h>

typedef struct point_grid {
    double cell_size, low[3];
    int cells[3];
    uint32_t* begin;     /* of each voxel, and one more */
    float* sorted[3];    /* x, y, z of the points, voxel by voxel */
    uint32_t* number_of; /* of each sorted point */
    double reads;        /* points that queries read */
} point_grid;

static inline int voxel_of(const point_grid* g, int axis, double x) {
    const int voxel = (int)((x - g->low[axis]) / g->cell_size);
    return voxel < 0 ? 0 : voxel < g->cells[axis] ? voxel : g->cells[axis] - 1;
}

static inline size_t row_of(const point_grid* g, int y, int z) {
    return ((size_t)z * (size_t)g->cells[1] + (size_t)y) * (size_t)g->cells[0];
}

static inline point_grid make_point_grid(float (*points)[3], uint32_t count, double cell_size) {
    point_grid g = {cell_size, {0}, {0}, NULL, {NULL}, NULL, 0};
    for (int axis = 0; axis < 3; ++axis) {
        double low = points[0][axis], high = low;
        for (uint32_t i = 1; i < count; ++i) {
            if (points[i][axis] < low) low = points[i][axis];
            if (points[i][axis] > high) high = points[i][axis];
        }
        g.low[axis] = low;
        g.cells[axis] = (int)((high - low) / cell_size) + 1;
        g.sorted[axis] = malloc(count * sizeof(float));
    }
    const size_t voxels = row_of(&g, 0, g.cells[2]);
    g.begin = calloc(voxels + 2, sizeof(uint32_t));
    g.number_of = malloc(count * sizeof(uint32_t));
    for (int pass = 0; pass < 2; ++pass) {
        for (uint32_t i = 0; i < count; ++i) {
            const float* p = points[i];
            const size_t v =
                row_of(&g, voxel_of(&g, 1, p[1]), voxel_of(&g, 2, p[2])) + (size_t)voxel_of(&g, 0, p[0]);
            if (pass == 0) {
                ++g.begin[v + 2];
                continue;
            }
            const uint32_t at = g.begin[v + 1]++;
            g.number_of[at] = i;
            for (int axis = 0; axis < 3; ++axis) g.sorted[axis][at] = p[axis];
        }
        if (pass == 0)
            for (size_t v = 0; v < voxels; ++v) g.begin[v + 2] += g.begin[v + 1];
    }
    return g;
}

static inline void free_point_grid(point_grid* g) {
    for (int axis = 0; axis < 3; ++axis) free(g->sorted[axis]);
    free(g->begin);
    free(g->number_of);
}

/* Calls body for each voxel from low to high: `from` and `to` are its points in `sorted`. */
#define for_voxels(g, low, high, from, to)                                                                   \
    for (int z_ = (low)[2]; z_ <= (high)[2]; ++z_)                                                           \
        for (int y_ = (low)[1]; y_ <= (high)[1]; ++y_)                                                       \
            for (int x_ = (low)[0]; x_ <= (high)[0]; ++x_)                                                   \
                for (uint32_t from = (g)->begin[row_of(g, y_, z_) + (size_t)x_],                             \
                              to = (g)->begin[row_of(g, y_, z_) + (size_t)x_ + 1], once_ = 1;                \
                     once_; once_ = 0)

static inline double seconds_since(clock_t start) { return (double)(clock() - start) / CLOCKS_PER_SEC; }

#endif
