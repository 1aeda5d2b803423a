/* Errors: a failing call says why, with the numbers in it, and changes nothing. */
#include "example.h"

int main(void) {
    vox_grid* grid = NULL;
    must(vox_grid_create(NULL, &grid));

    const cube c = cube_at(0, 0, 0);
    vox_mesh_desc desc = cube_desc(&c);
    desc.positions.count = 7; /* but the tetrahedra name eight */
    vox_body mesh = VOX_NULL_BODY;
    const vox_result result = vox_mesh_insert(grid, &desc, &mesh);
    printf("%s: %s\n", vox_result_string(result), vox_last_error());

    desc.positions.count = 8;
    must(vox_mesh_insert(grid, &desc, &mesh));
    printf("body %u is in\n", (unsigned)mesh);

    must(vox_body_remove(grid, mesh));
    printf("%s: %s\n", vox_result_string(vox_body_remove(grid, mesh)), vox_last_error());
    vox_grid_destroy(grid);
    return 0;
}
