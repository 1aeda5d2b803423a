/* Contacts: which vertex is in which tetrahedron. */
#include "example.h"

int main(void) {
    vox_grid* grid = NULL;
    must(vox_grid_create(NULL, &grid));
    cube first = cube_at(0, 0, 0), second = cube_at(0.75f, 0.5f, 0.25f);
    insert_cube(grid, &first);
    insert_cube(grid, &second);
    for (int frame = 0; frame < 4; ++frame, move_cube(&second, 0.125f, 0, 0)) {
        must(vox_grid_step(grid));
        vox_contact_view view;
        must(vox_grid_get_contacts(grid, &view));
        printf("frame %d: %" PRIu64 " contacts\n", frame, view.count);
        for (uint64_t i = 0; i < view.count; ++i) {
            const vox_contact* c = &view.data[i]; /* valid until the next step */
            printf("  vertex %u of body %u is in tet %u of body %u%s\n", (unsigned)c->vertex,
                   (unsigned)c->body_a, (unsigned)c->tet, (unsigned)c->body_b,
                   view.interiors[i] ? "" : ", on its boundary");
        }
    }
    vox_grid_destroy(grid);
    return 0;
}
