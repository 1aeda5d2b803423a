/* Queries: what is here, what is near, and what is in the way. */
#include "example.h"

int main(void) {
    vox_grid* grid = NULL;
    must(vox_grid_create(NULL, &grid));
    const cube first = cube_at(0, 0, 0), second = cube_at(3, 0, 0);
    insert_cube(grid, &first);
    insert_cube(grid, &second);
    must(vox_grid_prepare_queries(grid)); /* looks at the positions as they are now */

    const double inside[3] = {0.1, 0.1, 0.1}, between[3] = {2, 0.5, 0.5}, far_right[3] = {9, 0.5, 0.5};
    const double low[3] = {2.5, -1, -1}, high[3] = {9, 2, 2};
    vox_point_hit hit;
    uint64_t count = 0;
    must(vox_grid_query_point(grid, inside, UINT64_MAX, &hit, 1, &count));
    printf("(0.1, 0.1, 0.1) is in %" PRIu64 " tet: tet %u of mesh %u\n", count, (unsigned)hit.tet,
           (unsigned)hit.mesh);

    must(vox_grid_query_box(grid, low, high, UINT64_MAX, NULL, 0, &count));
    printf("%" PRIu64 " tets near the box right of x = 2.5\n", count);

    vox_surface_hit closest;
    must(vox_grid_query_closest(grid, between, 10, UINT64_MAX, &closest));
    printf("closest to (2, 0.5, 0.5): mesh %u at (%g, %g, %g), distance %g\n", (unsigned)closest.mesh,
           closest.position[0], closest.position[1], closest.position[2], closest.distance);

    vox_ray_hit ray;
    must(vox_grid_query_ray(grid, between, far_right, UINT64_MAX, &ray));
    printf("to the right: meets mesh %u after %g\n", (unsigned)ray.mesh, 7 * ray.t);
    vox_grid_destroy(grid);
    return 0;
}
