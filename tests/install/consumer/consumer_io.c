#include <stdio.h>
#include <vox/vox_io.h>

/* A ready-made body collides with its copy. */
int main(void) {
    vox_io_mesh* ball;
    vox_grid* grid;
    vox_body mesh;
    vox_mesh_desc desc = vox_default_mesh_desc();
    vox_contact_view contacts;
    if (vox_io_make_lattice_ball(1000, 1, &ball) != VOX_OK) return puts(vox_last_error()), 1;
    if (vox_io_mesh_describe(ball, &desc) != VOX_OK) return puts(vox_last_error()), 1;
    if (vox_grid_create(NULL, &grid) != VOX_OK) return puts(vox_last_error()), 1;
    for (int i = 0; i < 2; ++i)
        if (vox_mesh_insert(grid, &desc, &mesh) != VOX_OK) return puts(vox_last_error()), 1;
    if (vox_grid_step(grid) != VOX_OK) return puts(vox_last_error()), 1;
    if (vox_grid_get_contacts(grid, &contacts) != VOX_OK || contacts.count == 0) return 1;
    vox_grid_destroy(grid);
    vox_io_mesh_destroy(ball);
    return 0;
}
