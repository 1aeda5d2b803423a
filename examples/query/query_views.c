/* Query views: what another thread, of a haptic device say, asks while the grid steps. Here one thread does
 * both. */
#include "example.h"

/* How deep a probe is in the meshes of a view (negative: outside), and which way is out. */
static void feel(const vox_query_view* view, const double probe[3]) {
    vox_closest_desc desc = vox_default_closest_desc();
    vox_closest_hit hit;
    uint64_t epoch = 0;
    desc.points = probe;
    desc.format = VOX_FORMAT_DOUBLE;
    desc.point_count = 1;
    must(vox_query_view_closest_points(view, &desc, &hit));
    must(vox_query_view_epoch(view, &epoch));
    printf("step %d: distance %g from mesh %u, normal (%g, %g, %g)\n", (int)epoch, hit.distance,
           (unsigned)hit.mesh, hit.normal[0], hit.normal[1], hit.normal[2]);
}

int main(void) {
    const double probe[3] = {0.875, 0.5, 0.5};
    vox_grid* grid = NULL;
    vox_query_view *shown = NULL, *next = NULL;
    must(vox_grid_create(NULL, &grid));
    cube moving = cube_at(0, 0, 0);
    insert_cube(grid, &moving);
    for (int frame = 0; frame < 3; ++frame) {
        must(vox_grid_step(grid));
        must(vox_grid_take_query_view(grid, &next)); /* uses the memory of a released view again */
        vox_query_view_release(shown);
        shown = next; /* with a lock around it, where threads share it */
        feel(shown, probe);
        move_cube(&moving, -0.25f, 0, 0); /* a view has its own copy of the positions */
    }
    vox_grid_destroy(grid);
    feel(shown, probe); /* still there */

    /* What is between two points: every facet on the way, or whether there is anything at all. */
    const double left[3] = {-2, 0.5, 0.375}, right[3] = {2, 0.5, 0.375};
    vox_facet_hit hits[8];
    uint64_t count = 0;
    uint32_t any = 0;
    must(vox_query_view_ray_hits(shown, left, right, UINT64_MAX, VOX_NULL_BODY, hits, 8, &count));
    for (uint64_t i = 0; i < count; ++i)
        printf("%s mesh %u at x = %g\n", hits[i].side == VOX_SIDE_ENTERS ? "enters" : "leaves",
               (unsigned)hits[i].mesh, left[0] + hits[i].t * (right[0] - left[0]));
    must(vox_query_view_ray_any(shown, left, right, UINT64_MAX, hits[0].mesh, &any));
    printf("without that mesh: %s\n", any ? "something" : "nothing");
    vox_query_view_release(shown);
    return 0;
}
