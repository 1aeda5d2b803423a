/* The mechanics grid of a cell model: spheres in a spheroid, each pushed by all that it touches. Such models
 * hold agents in voxels of a fixed side (30 micrometres in PhysiCell) and look through 27 of them. Which side
 * is the best? */
#include "point_grid.h"

#include <math.h>
#include <string.h>
#include <vox/vox_cell_size.h>

enum { count = 20000 };
static const double largest = 8.41, reach = 1.25; /* radius of a cell, micrometres; adhesion, in radii */
static float centres[count][3], reaches[count];
static uint64_t touching;

/* Every agent looks through the 27 voxels around it. Returns milliseconds. */
static double run(double cell_size, double* reads) {
    const clock_t start = clock();
    point_grid g = make_point_grid(centres, count, cell_size);
    touching = 0;
    for (uint32_t i = 0; i < count; ++i) {
        int low[3], high[3];
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = voxel_of(&g, axis, centres[i][axis] - cell_size);
            high[axis] = voxel_of(&g, axis, centres[i][axis] + cell_size);
        }
        for_voxels(&g, low, high, from, to) {
            g.reads += to - from;
            for (uint32_t j = from; j < to; ++j) {
                const float x = g.sorted[0][j] - centres[i][0], y = g.sorted[1][j] - centres[i][1],
                            z = g.sorted[2][j] - centres[i][2], sum = reaches[i] + reaches[g.number_of[j]];
                touching += x * x + y * y + z * z < sum * sum;
            }
        }
    }
    *reads = g.reads / count;
    free_point_grid(&g);
    return 1e3 * seconds_since(start);
}

int main(int argc, char** argv) {
    const int shows_times = argc > 1 && strcmp(argv[1], "times") == 0;
    uint32_t state = 1;
    const double radius = largest * cbrt(count / 0.7); /* of the spheroid */
    for (int i = 0; i < count;) {
        double square = 0;
        for (int axis = 0; axis < 3; ++axis) {
            centres[i][axis] = (float)(radius * ((double)(random_quick(&state) >> 8) / (1 << 23) - 1));
            square += (double)centres[i][axis] * centres[i][axis];
        }
        if (square > radius * radius) continue;
        reaches[i++] =
            (float)(reach * largest * cbrt(0.5 + 0.5 * (double)(random_quick(&state) >> 8) / (1 << 24)));
    }
    vox_primitives agents = vox_default_primitives();
    agents.type = VOX_PRIMITIVE_POINT;
    agents.positions = vox_float_positions(centres[0], count);
    agents.count = count;
    agents.radii = reaches;
    vox_foreign_grid grid = vox_default_foreign_grid();
    grid.known = VOX_KNOWN_GRID_SORTED;
    grid.cells_stored = VOX_CELLS_STORED_CENTRE;
    grid.stored = &agents;
    grid.cells_queried = VOX_CELLS_QUERIED_27; /* so a voxel has to be as wide as the largest reach */
    vox_cell_size_result suggested;
    suggested.struct_size = sizeof suggested;
    must(vox_foreign_grid_suggest(&grid, &suggested));

    const double sides[] = {30, suggested.cell_size, 0.8 * suggested.cell_size};
    const char* const words[] = {"the usual side", "the side that vox suggests", "smaller voxels"};
    uint64_t expected = 0;
    for (int i = 0; i < 3; ++i) {
        double reads = 0, least = HUGE_VAL;
        for (int times = 0; times < 5; ++times) least = fmin(least, run(sides[i], &reads));
        if (i == 0) expected = touching;
        printf("%-26s %4.1f: %5.1f agents read by each%s\n", words[i], sides[i], reads,
               touching == expected ? "" : ", but neighbours are missed");
        if (shows_times) printf("    %.2f ms\n", least);
    }
    printf("%.1f neighbours each\n", (double)(expected - count) / count);
    return 0;
}
