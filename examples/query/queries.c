/* Queries: what is here, what is near, and what is in the way. Each call answers many of them. */
#include "example.h"

#include <vox/vox_query.h>

int main(void) {
    vox_grid* grid = NULL;
    vox_locator* locator = NULL;
    must(vox_grid_create(NULL, &grid));
    const cube first = cube_at(0, 0, 0), second = cube_at(3, 0, 0);
    insert_cube(grid, &first);
    insert_cube(grid, &second);
    must(vox_grid_update_locator(grid, &locator)); /* the cubes as they are now; no step is needed */

    const double xyz[2][3] = {{0.1, 0.1, 0.1}, {2, 0.5, 0.5}}, ends[2][3] = {{0.9, 0.9, 0.9}, {9, 2, 2}};
    const vox_positions from = vox_double_positions(xyz[0], 2), to = vox_double_positions(ends[0], 2);
    uint64_t count = 0;
    vox_point_hit hit;
    must(vox_locator_find_point_hits(locator, &from, NULL, &hit, 1, &count));
    printf("%" PRIu64 " hit: point %u is in tet %u of mesh %u\n", count, hit.point, hit.tet, hit.body);

    vox_location where[2];
    must(vox_locator_locate(locator, &from, NULL, where));
    for (int i = 0; i < 2; ++i)
        printf("point %d is %s, %g away from tet %u of mesh %u\n", i,
               where[i].state == VOX_LOCATION_INSIDE ? "inside" : "outside", where[i].distance, where[i].tet,
               where[i].body);

    vox_closest_hit closest[2];
    must(vox_locator_find_closest(locator, &from, NULL, closest));
    for (int i = 0; i < 2; ++i)
        printf("closest to point %d: mesh %u, distance %g\n", i, closest[i].body, closest[i].distance);

    must(vox_locator_find_box_hits(locator, &from, &to, NULL, NULL, 0, &count));
    printf("%" PRIu64 " tets near the boxes\n", count);

    vox_query_desc desc = vox_default_query_desc();
    desc.flags = VOX_QUERY_FIRST_HIT;
    vox_ray_hit ray;
    must(vox_locator_find_ray_hits(locator, &from, &to, &desc, &ray, 1, &count));
    printf("ray %u meets mesh %u at x = %g\n", ray.ray, ray.body, xyz[ray.ray][0] + 7 * ray.t);

    vox_track_piece pieces[8];
    must(vox_locator_find_tracks(locator, &from, &to, NULL, pieces, 8, &count));
    for (uint64_t i = 0; i < count && i < 8; ++i)
        printf("segment %u is in tet %u of mesh %u from t = %g to %g\n", pieces[i].segment, pieces[i].tet,
               pieces[i].body, pieces[i].t_in, pieces[i].t_out);
    vox_locator_release(locator);
    vox_grid_destroy(grid);
    return 0;
}
