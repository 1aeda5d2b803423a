/* Two bodies, their contact by the names that the program gave them, and the cell size for them. */
#include <stdio.h>
#include <vox/vox_cell_size.h>

static int failed(void) { return fprintf(stderr, "%s\n", vox_last_error()), 1; }

int main(void) {
    /* Two bodies of one tetrahedron each; vertex 3 of the first lies inside the second. */
    const uint32_t tet[4] = {0, 1, 2, 3};
    const float first[12] = {5, 5, 5, 6, 5, 5, 5, 6, 5, 0.2f, 0.3f, 0.4f};
    const float second[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    /* Positions are borrowed: move them between steps as you like. */
    vox_mesh_desc bodies[2] = {vox_mesh_desc_floats(first, 4, tet, 1),
                               vox_mesh_desc_floats(second, 4, tet, 1)};
    for (int i = 0; i < 2; ++i) bodies[i].user_data = (uint64_t)i + 1;

    vox_grid* grid;
    vox_body ids[2];
    if (vox_grid_create(NULL, &grid) != VOX_OK) return failed();
    for (int i = 0; i < 2; ++i)
        if (vox_mesh_insert(grid, &bodies[i], &ids[i]) != VOX_OK) return failed();

    if (vox_grid_step(grid) != VOX_OK) return failed(); /* once a frame */

    vox_contact_view contacts;
    if (vox_grid_get_contacts(grid, &contacts) != VOX_OK) return failed();
    for (uint64_t i = 0; i < contacts.count; ++i) {
        const vox_contact* c = &contacts.data[i];
        uint64_t a = 0, b = 0;
        vox_body_get_user_data(grid, c->body_a, &a);
        vox_body_get_user_data(grid, c->body_b, &b);
        printf("vertex %u of body %u in tet %u of body %u\n", c->vertex, (unsigned)a, c->tet, (unsigned)b);
    }
    vox_grid_destroy(grid);

    /* No grid yet? One call gives the cell size for these meshes. */
    vox_cell_size_result suggestion;
    suggestion.struct_size = sizeof suggestion;
    if (vox_suggest_cell_size(NULL, bodies, 2, &suggestion) != VOX_OK) return failed();
    printf("cell size %.3f, good from %.3f to %.3f\n", suggestion.cell_size, suggestion.zone_min,
           suggestion.zone_max);
    return 0;
}
