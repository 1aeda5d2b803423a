/* Measurements: what a step did, and how long each stage took. */
#include "example.h"

#include <string.h>

enum { side = 8 };

int main(void) {
    static cube cubes[side * side * side];
    vox_grid* grid = NULL;
    must(vox_grid_create(NULL, &grid));
    for (int i = 0; i < side * side * side; ++i) {
        cubes[i] = cube_at(0.95f * (float)(i % side), 0.95f * (float)(i / side % side),
                           0.95f * (float)(i / side / side));
        insert_cube(grid, &cubes[i]);
    }
    must(vox_grid_step(grid));

    vox_counter_view counters;
    must(vox_grid_get_counters(grid, &counters));
    uint64_t stages = 0;
    for (uint64_t i = 0; i < counters.count; ++i) {
        const vox_counter* c = &counters.data[i];
        const size_t length = strlen(c->name);
        const int is_time = length > 3 && strcmp(c->name + length - 3, "_ns") == 0;
        if (is_time)
            stages += strcmp(c->name, "lookup_ns") == 0 || strcmp(c->name, "decide_ns") == 0 ? c->value : 0;
        if (c->value > 0) printf("%s %" PRIu64 "\n", c->name, c->value);
    }
    vox_grid_info info;
    info.struct_size = sizeof info;
    must(vox_grid_get_info(grid, &info));
    printf("these stages took %s the step\n", stages <= info.step_ns ? "no longer than" : "LONGER THAN");
    vox_grid_destroy(grid);
    return 0;
}
