/* A search grid: everything within a radius of some points, in a world with crowded places. A rule of thumb
 * says 16 to 64 points per cell. vox times three cell sizes and says which is the best for this machine and
 * this loop. */
#include "point_grid.h"

#include <math.h>
#include <string.h>
#include <vox/vox_cell_size.h>

enum { count = 200000, watchers = 4000, places = 24 };
static const double world = 16000, radius = 192;
static float points[count][3], watching[watchers][3];
static uint64_t seen;

static double seconds_of(double cell_size, double* per_cell) {
    const clock_t start = clock();
    point_grid g = make_point_grid(points, count, cell_size);
    const float limit = (float)(radius * radius);
    seen = 0;
    for (int i = 0; i < watchers; ++i) {
        const float* p = watching[i];
        int low[3], high[3];
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = voxel_of(&g, axis, p[axis] - radius);
            high[axis] = voxel_of(&g, axis, p[axis] + radius);
        }
        for_voxels(&g, low, high, from, to) {
            uint32_t near = 0;
            for (uint32_t j = from; j < to; ++j) {
                const float x = g.sorted[0][j] - p[0], y = g.sorted[1][j] - p[1];
                near += x * x + y * y <= limit;
            }
            seen += near;
        }
    }
    uint32_t occupied = 0;
    for (size_t v = 0; v < row_of(&g, 0, g.cells[2]); ++v) occupied += g.begin[v] < g.begin[v + 1];
    *per_cell = (double)count / occupied;
    free_point_grid(&g);
    return seconds_since(start);
}

static double least_of(double cell_size, double* per_cell) {
    double least = HUGE_VAL;
    for (int times = 0; times < 5; ++times) least = fmin(least, seconds_of(cell_size, per_cell));
    return least;
}

/* Half of the points are anywhere, the others in crowded places. */
static void fill(float (*out)[3], int n, uint32_t* state) {
    for (int i = 0; i < n; ++i) {
        uint32_t place = 7919u * (random_quick(state) >> 8) % places + 1;
        const double wide = i % 2 ? world : 400;
        for (int axis = 0; axis < 2; ++axis) {
            const double middle =
                i % 2 ? world / 2 : world * (0.1 + 0.8 * (double)(random_quick(&place) >> 8) / (1 << 24));
            out[i][axis] = (float)(middle + wide * ((double)(random_quick(state) >> 8) / (1 << 24) - 0.5));
        }
    }
}

int main(int argc, char** argv) {
    const int shows_times = argc > 1 && strcmp(argv[1], "times") == 0;
    uint32_t state = 1;
    fill(points, count, &state);
    fill(watching, watchers, &state);
    vox_primitives stored = vox_default_primitives(), asking = vox_default_primitives();
    stored.positions = vox_float_positions(points[0], stored.count = count);
    asking.positions = vox_float_positions(watching[0], asking.count = watchers);
    vox_foreign_grid grid = vox_default_foreign_grid();
    grid.known = VOX_KNOWN_GRID_SORTED;
    grid.cells_stored = VOX_CELLS_STORED_CENTRE;
    grid.stored = &stored;
    grid.querying = &asking;
    grid.radius = radius;

    vox_timing timings[3] = {{0.5 * radius, 0}, {1.5 * radius, 0}, {5 * radius, 0}};
    double per_cell = 0;
    for (int i = 0; i < 3; ++i) timings[i].seconds = least_of(timings[i].cell_size, &per_cell);
    vox_cell_size_result fitted;
    fitted.struct_size = sizeof fitted;
    must(vox_foreign_grid_fit(&grid, timings, 3, &fitted));

    uint64_t expected = 0;
    const double sizes[] = {32, 64, 128, 256, 512, 1024, 2048, fitted.cell_size};
    for (int i = 0; i < 8; ++i) {
        const double seconds = least_of(sizes[i], &per_cell);
        if (i > 0 && seen != expected) return puts("others are seen"), 1;
        expected = seen;
        if (shows_times)
            printf("%s%4.0f, %5.0f points per cell: %6.2f ms\n", i < 7 ? "" : "fitted ", sizes[i], per_cell,
                   1e3 * seconds);
    }
    printf("fitted from three timings; each watcher sees %.0f others at every cell size\n",
           (double)expected / watchers);
    return 0;
}
