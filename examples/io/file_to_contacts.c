/* From files to contacts: load two meshes, insert them, step, read the contacts. The second one moves: it is
 * loaded once and placed by a transform. */
#include "example.h"

#include <vox/vox_io.h>

int main(int count, char** paths) {
    if (count != 3) return fprintf(stderr, "usage: %s FIXED.msh MOVING.msh\n", paths[0]), EXIT_FAILURE;
    vox_grid_desc grid_desc = vox_default_grid_desc();
    grid_desc.flags = VOX_GRID_CONSTRAINTS; /* how deep, and which way out */
    vox_grid* grid = NULL;
    vox_io_mesh* files[2] = {NULL, NULL};
    vox_body meshes[2];
    must(vox_grid_create(&grid_desc, &grid));
    for (int i = 0; i < 2; ++i) {
        must(vox_io_load(paths[i + 1], NULL, &files[i]));
        fputs(vox_io_mesh_get_warnings(files[i]), stdout);
        vox_mesh_desc desc = vox_default_mesh_desc();
        must(vox_io_mesh_describe(files[i], &desc)); /* the file's doubles, borrowed */
        desc.user_data = (uint64_t)i + 1;
        must(vox_mesh_insert(grid, &desc, &meshes[i]));
    }
    for (int frame = 0; frame < 3; ++frame) {
        const double x = 1.25 - 0.5 * frame;
        const double place[12] = {1, 0, 0, x, 0, 1, 0, 0.25, 0, 0, 1, 0.0625};
        must(vox_body_set_transform(grid, meshes[1], place));
        must(vox_grid_step(grid));
        vox_constraint_view found;
        must(vox_grid_get_constraints(grid, &found));
        printf("moved by %g: %" PRIu64 " contacts\n", x, contact_count(grid));
        for (uint64_t i = 0; i < found.count && i < 2; ++i) {
            const vox_constraint* c = &found.data[i];
            printf("  vertex %" PRIu32 " of file %" PRIu64 " is %.3f deep in file %" PRIu64
                   ", out along (%.2f, %.2f, %.2f)\n",
                   c->vertices[0], c->user_data_a, -c->gap, c->user_data_b, c->normal[0], c->normal[1],
                   c->normal[2]);
        }
    }
    vox_grid_destroy(grid);
    for (int i = 0; i < 2; ++i)
        vox_io_mesh_destroy(files[i]); /* after the grid, which borrowed their positions */
    return 0;
}
