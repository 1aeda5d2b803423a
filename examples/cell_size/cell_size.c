/* Cell size: the best one for some meshes, before there is a grid, and what other rules would have taken. */
#include "example.h"

#include <vox/vox_cell_size.h>

int main(void) {
    const cube cubes[2] = {cube_at(0, 0, 0), cube_at(0.5f, 0.5f, 0.5f)};
    const vox_mesh_desc meshes[2] = {cube_desc(&cubes[0]), cube_desc(&cubes[1])};
    vox_suggestion s;
    s.struct_size = sizeof s;
    must(vox_suggest_cell_size(NULL, meshes, 2, &s));
    printf("cell size %.3f (%.1f cells an axis), good from %.3f to %.3f\n", s.cell_size, s.cells_per_axis,
           s.zone_min, s.zone_max);
    printf("mean edge %.3f, median box side %.3f, cube root of the mean volume %.3f\n", s.rules.mean_edge,
           s.rules.median_box_side, s.rules.mean_volume);
    for (uint32_t i = 0; i < s.curve_count; i += 8) {
        printf("%8.3f ", s.curve[i].cell_size);
        const int width = (int)(20 * s.predicted_cost / s.curve[i].cost);
        for (int x = 0; x < width; ++x) putchar('#');
        printf(" %.0f%% as good\n", 100 * s.predicted_cost / s.curve[i].cost);
    }
    return 0;
}
