/* Bodies: where they are placed, and with whom they collide. */
#include "example.h"

static void step(vox_grid* grid, const char* what) {
    must(vox_grid_step(grid));
    printf("%-34s %2" PRIu64 " contacts\n", what, contact_count(grid));
}

int main(void) {
    vox_grid* grid = NULL;
    must(vox_grid_create(NULL, &grid));
    const cube shape = cube_at(0, 0, 0); /* three bodies of one shape */
    const vox_body a = insert_cube(grid, &shape), b = insert_cube(grid, &shape),
                   c = insert_cube(grid, &shape);
    const double right[12] = {1, 0, 0, 0.75, 0, 1, 0, 0.25, 0, 0, 1, 0.5};
    const double turned[12] = {0, -1, 0, 0.25, 1, 0, 0, 0.5, 0, 0, 1, 0.25};
    must(vox_body_set_transform(grid, b, right));
    must(vox_body_set_transform(grid, c, turned));
    step(grid, "three cubes");

    vox_filter filter = VOX_ZERO;
    filter.mask = 2; /* c collides with bodies of category 2 only, and a and b are of category 1 */
    must(vox_body_set_filter(grid, c, &filter));
    step(grid, "one filtered out");
    must(vox_grid_set_pair_enabled(grid, a, b, 0));
    step(grid, "the others an exception, too");
    must(vox_grid_set_pair_enabled(grid, a, b, 1));
    filter.mask = 0; /* the default: all */
    must(vox_body_set_filter(grid, c, &filter));
    must(vox_body_set_enabled(grid, b, 0));
    step(grid, "all allowed, one switched off");

    vox_body ids[3];
    uint64_t count = 0;
    must(vox_grid_get_bodies(grid, ids, 3, &count));
    for (uint64_t i = 0; i < count; ++i) {
        vox_body_info info = {.struct_size = sizeof info};
        must(vox_body_get_info(grid, ids[i], &info));
        printf("body %u: %s, %" PRIu64 " tets, at x = %g\n", (unsigned)ids[i], info.enabled ? "on" : "off",
               info.tet_count, info.transform[3]);
    }
    vox_grid_destroy(grid);
    return 0;
}
