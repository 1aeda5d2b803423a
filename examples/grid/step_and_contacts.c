/* Step and contacts: which vertex is in which tetrahedron, and where in it. */
#include "example.h"

int main(void) {
    vox_grid* grid = NULL;
    must(vox_grid_create(NULL, &grid));
    cube first = cube_at(0, 0, 0), second = cube_at(0.75f, 0.5f, 0.25f);
    insert_cube(grid, &first);
    const vox_body b = insert_cube(grid, &second);
    for (int frame = 0; frame < 3; ++frame, move_cube(&second, 0.125f, 0, 0)) {
        must(vox_grid_step(grid));
        vox_contact_view view;
        must(vox_grid_get_contacts(grid, &view));
        printf("frame %d: %" PRIu64 " contacts\n", frame, view.count);
        for (uint64_t i = 0; i < view.count; ++i) {
            const vox_contact* c = &view.data[i]; /* valid until the next step */
            /* Where it is: the tetrahedron's corners, weighted. */
            const cube* holder = c->body_b == b ? &second : &first;
            float p[3] = {0, 0, 0};
            for (int corner = 0; corner < 4; ++corner)
                for (int axis = 0; axis < 3; ++axis)
                    p[axis] += c->barycentric[corner] * holder->positions[holder->tets[c->tet][corner]][axis];
            printf("  vertex %u of mesh %u in tet %u of mesh %u, at (%g, %g, %g)\n", (unsigned)c->vertex,
                   (unsigned)c->body_a, (unsigned)c->tet, (unsigned)c->body_b, p[0], p[1], p[2]);
        }
    }
    vox_grid_destroy(grid);
    return 0;
}
