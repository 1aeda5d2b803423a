/* Cell size: the best one for some meshes, before there is a grid, and what other rules would have taken. */
#include "example.h"

#include <vox/vox_cell_size.h>

int main(void) {
    const cube cubes[2] = {cube_at(0, 0, 0), cube_at(0.5f, 0.5f, 0.5f)};
    const vox_mesh_desc meshes[2] = {cube_desc(&cubes[0]), cube_desc(&cubes[1])};
    vox_cell_size_result s;
    s.struct_size = sizeof s;
    must(vox_suggest_cell_size(NULL, meshes, 2, &s));
    printf("cell size %.3f (%.1f cells an axis), good from %.3f to %.3f\n", s.cell_size, s.cells_per_axis,
           s.zone_min, s.zone_max);
    for (uint32_t i = 0; i < s.rule_count; ++i)
        printf("%.3f, %.0f%% as good: %s\n", s.rules[i].cell_size, 100 * s.cost / s.rules[i].cost,
               s.rules[i].name);
    for (uint32_t i = 0; i < s.curve_count; i += 8) {
        printf("%8.3f ", s.curve[i].cell_size);
        const int width = (int)(20 * s.cost / s.curve[i].cost);
        for (int x = 0; x < width; ++x) putchar('#');
        printf(" %.0f%% as good\n", 100 * s.cost / s.curve[i].cost);
    }
    return 0;
}
