#include <stdio.h>
#include <vox/vox.h>

int main(void) {
    vox_grid* grid;
    if (vox_version() / 1000 != VOX_VERSION_MAJOR * 1000u + VOX_VERSION_MINOR) return 1;
    if (vox_grid_create(NULL, &grid) != VOX_OK) return puts(vox_last_error()), 1;
    if (vox_grid_step(grid) != VOX_OK) return puts(vox_last_error()), 1;
    vox_grid_destroy(grid);
    return 0;
}
