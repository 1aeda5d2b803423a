/* Step: several grids in one call. One of them has a bad coordinate, fails and says where; a grid may leave
 * such a body out instead. */
#include "example.h"

#include <math.h>

enum { count = 3 };

int main(void) {
    cube cubes[count][2];
    vox_grid* grids[count];
    vox_result results[count];
    for (int i = 0; i < count; ++i) {
        must(vox_grid_create(NULL, &grids[i]));
        cubes[i][0] = cube_at(0, 0, 0);
        cubes[i][1] = cube_at(0.75f, 0.25f * (float)i, 0.5f);
        for (int c = 0; c < 2; ++c) insert_cube(grids[i], &cubes[i][c]);
    }
    cubes[1][1].positions[6][2] = NAN;
    if (vox_grids_step(grids, count, VOX_ALL_CORES, NULL, results) != VOX_OK)
        printf("%s\n", vox_last_error());
    for (int i = 0; i < count; ++i)
        printf("grid %d: %s, %" PRIu64 " contacts\n", i, vox_result_string(results[i]),
               contact_count(grids[i]));

    must(vox_grid_set_flags(grids[1], VOX_GRID_SKIP_BAD_BODIES));
    must(vox_grid_step(grids[1]));
    vox_failure failure = {.struct_size = sizeof failure};
    must(vox_grid_get_failure(grids[1], 0, &failure));
    printf("left out: body %u, for vertex %u\n", (unsigned)failure.body, (unsigned)failure.vertex);
    for (int i = 0; i < count; ++i) vox_grid_destroy(grids[i]);
    return 0;
}
