/* A blade that a cutting program moves into a cube: the tetrahedra on its way, in order, and the edges that
 * it cuts. */
#include "example.h"

#include <vox/vox_query.h>

int main(void) {
    vox_grid* grid = NULL;
    vox_locator* locator = NULL;
    must(vox_grid_create(NULL, &grid));
    const cube body = cube_at(0, 0, 0);
    insert_cube(grid, &body);
    must(vox_grid_update_locator(grid, &locator));

    /* Its edge, from y = -1 to y = 2, goes down from z = 1.5 to z = 0.5: a triangle with two corners in one
     * place. */
    const double edge[3][3] = {{0.3, -1, 1.5}, {0.3, 2, 1.5}, {0.3, 2, 1.5}};
    const double then[3][3] = {{0.3, -1, 0.5}, {0.3, 2, 0.5}, {0.3, 2, 0.5}};
    const vox_positions from = vox_double_positions(edge[0], 3), to = vox_double_positions(then[0], 3);
    vox_triangle_hit hits[8];
    uint64_t count = 0;
    must(vox_locator_find_triangle_hits(locator, &from, &to, NULL, hits, 8, &count));
    for (uint64_t i = 0; i < count && i < 8; ++i) {
        printf("tet %u from t = %g; edges:", hits[i].tet, hits[i].t);
        for (int k = 0; k < 6; ++k)
            if (hits[i].edges >> k & 1) printf(" %d at s = %g", k, hits[i].s[k]);
        printf("\n");
    }

    /* Is a shaft of radius 0.1 in touch? */
    const double tip[3] = {0.5, 0.5, 1.05}, handle[3] = {0.5, 0.5, 3};
    const vox_positions begin = vox_double_positions(tip, 1), end = vox_double_positions(handle, 1);
    vox_closest_hit closest;
    must(vox_locator_find_closest_to_segments(locator, &begin, &end, NULL, &closest));
    printf("the shaft is %g deep in tet %u\n", 0.1 - closest.distance, closest.tet);
    vox_locator_release(locator);
    vox_grid_destroy(grid);
    return 0;
}
