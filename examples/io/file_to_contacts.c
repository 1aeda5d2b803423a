/* From files to contacts: load two meshes, insert them, step, read the contacts. The second one moves: it is
 * loaded once and placed by a transform. */
#include "example.h"

#include <vox/vox_io.h>

int main(int count, char** paths) {
    if (count != 3) return fprintf(stderr, "usage: %s FIXED.msh MOVING.msh\n", paths[0]), EXIT_FAILURE;
    vox_grid* grid = NULL;
    vox_io_mesh* files[2] = {NULL, NULL};
    vox_body meshes[2];
    must(vox_grid_create(NULL, &grid));
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
        vox_contact_view contacts;
        vox_penetration_view penetrations;
        must(vox_grid_get_contacts(grid, &contacts));
        must(vox_grid_penetrations(grid, &penetrations));
        printf("moved by %g: %" PRIu64 " contacts\n", x, contacts.count);
        for (uint64_t i = 0; i < penetrations.count && i < 2; ++i) {
            const vox_penetration* p = &penetrations.data[i];
            uint64_t a = 0, b = 0;
            must(vox_body_get_user_data(grid, p->body_a, &a));
            must(vox_body_get_user_data(grid, p->body_b, &b));
            printf("  vertex %" PRIu32 " of file %" PRIu64 " is %.3f deep in file %" PRIu64
                   ", out along (%.2f, %.2f, %.2f)\n",
                   p->vertex, a, (double)p->depth, b, (double)p->direction[0], (double)p->direction[1],
                   (double)p->direction[2]);
        }
    }
    vox_grid_destroy(grid);
    for (int i = 0; i < 2; ++i)
        vox_io_mesh_destroy(files[i]); /* after the grid, which borrowed their positions */
    return 0;
}
