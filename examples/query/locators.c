/* Locators: what another thread, of a haptic device say, asks while the grid steps. Here one thread does
 * both. */
#include "example.h"

#include <vox/vox_query.h>

/* How deep a point is in the meshes of a locator (negative: outside), and which way is out. */
static void feel(const vox_locator* locator, const vox_positions* probe) {
    vox_closest_hit hit;
    uint64_t epoch = 0;
    must(vox_locator_find_closest(locator, probe, NULL, &hit));
    must(vox_locator_get_epoch(locator, &epoch));
    printf("step %d: distance %g from mesh %u, normal (%g, %g, %g)\n", (int)epoch, hit.distance, hit.body,
           hit.normal[0], hit.normal[1], hit.normal[2]);
}

int main(void) {
    const double xyz[3][3] = {{0.875, 0.5, 0.5}, {-2, 0.5, 0.375}, {2, 0.5, 0.375}};
    const vox_positions probe = vox_double_positions(xyz[0], 1), left = vox_double_positions(xyz[1], 1),
                        right = vox_double_positions(xyz[2], 1);
    vox_grid* grid = NULL;
    vox_locator* locator = NULL;
    must(vox_grid_create(NULL, &grid));
    cube moving = cube_at(0, 0, 0);
    insert_cube(grid, &moving);
    for (int frame = 0; frame < 3; ++frame) {
        must(vox_grid_step(grid));
        must(vox_grid_update_locator(grid, &locator)); /* with a lock around it, where threads share it */
        feel(locator, &probe);
        move_cube(&moving, -0.25f, 0, 0); /* a locator has its own copy of the positions */
    }
    vox_grid_destroy(grid);
    feel(locator, &probe); /* still there */

    /* What is between two points: every facet on the way, or whether there is anything at all. */
    vox_ray_hit hits[8];
    uint64_t count = 0;
    must(vox_locator_find_ray_hits(locator, &left, &right, NULL, hits, 8, &count));
    for (uint64_t i = 0; i < count; ++i)
        printf("%s mesh %u at x = %g\n", hits[i].side == VOX_SIDE_ENTERS ? "enters" : "leaves", hits[i].body,
               4 * hits[i].t - 2);
    vox_query_desc desc = vox_default_query_desc();
    desc.excluded = hits[0].body;
    uint8_t blocked = 0;
    must(vox_locator_test_rays(locator, &left, &right, &desc, &blocked));
    printf("without that mesh: %s\n", blocked ? "something" : "nothing");
    vox_locator_release(locator);
    return 0;
}
