/* Measurements: what a step did, and how long each stage took. */
#include "example.h"

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

    vox_counters counters;
    counters.struct_size = sizeof counters; /* the fields that this program knows are written */
    must(vox_grid_get_counters(grid, &counters));
    printf("%u meshes, %" PRIu64 " tets: %" PRIu64 " vertices in %" PRIu64 " cells, %" PRIu64
           " candidates, %" PRIu64 " contacts\n",
           (unsigned)counters.meshes, counters.tets, counters.entries, counters.cells, counters.candidates,
           counters.contacts);

    vox_profile profile;
    profile.struct_size = sizeof profile;
    must(vox_grid_profile(grid, &profile));
    const uint64_t sum =
        profile.bin_ns + profile.broad_ns + profile.narrow_ns + profile.contacts_ns + profile.depth_ns;
    printf("the stages took %s the step\n",
           sum > 0 && sum <= profile.step_ns ? "no longer than" : "LONGER THAN");
    printf("step %.3f ms: bin %.3f, broad %.3f, narrow %.3f, contacts %.3f, depth %.3f\n",
           (double)profile.step_ns * 1e-6, (double)profile.bin_ns * 1e-6, (double)profile.broad_ns * 1e-6,
           (double)profile.narrow_ns * 1e-6, (double)profile.contacts_ns * 1e-6,
           (double)profile.depth_ns * 1e-6);
    vox_grid_destroy(grid);
    return 0;
}
