/* Margin contacts and passages: who comes close to a cube, and who has gone through it between two frames. */
#include "example.h"

int main(void) {
    vox_grid* grid = NULL;
    must(vox_grid_create(NULL, &grid));
    must(vox_grid_set_margin(grid, 0.25));
    cube target = cube_at(0, 0, 0), bullet = cube_at(0.25f, 0.125f, -1.125f);
    insert_cube(grid, &target);
    const vox_body id = insert_cube(grid, &bullet);
    must(vox_grid_step(grid));

    vox_margin_contact_view near;
    must(vox_grid_margin_contacts(grid, &near));
    for (uint64_t i = 0; i < near.count; ++i) {
        const vox_margin_contact* c = &near.data[i]; /* valid until the next step */
        printf("vertex %u of mesh %u is %g from mesh %u, which pushes it along (%g, %g, %g)\n",
               (unsigned)c->vertex, (unsigned)c->body_a, c->distance, (unsigned)c->body_b, c->normal[0],
               c->normal[1], c->normal[2]);
    }

    const cube before = bullet; /* where its vertices were a frame ago */
    const vox_positions came_from = vox_float_positions(before.positions[0], 8);
    must(vox_mesh_bind_previous_positions(grid, id, &came_from));
    move_cube(&bullet, 0, 0, 8);
    must(vox_grid_step(grid));
    vox_contact_view contacts;
    vox_passage_view passages;
    must(vox_grid_get_contacts(grid, &contacts));
    must(vox_grid_passages(grid, &passages));
    printf("%" PRIu64 " contacts, %" PRIu64 " passages\n", contacts.count, passages.count);
    for (uint64_t i = 0; i < passages.count; ++i)
        printf("vertex %u of mesh %u met mesh %u at time %.4f\n", (unsigned)passages.data[i].vertex,
               (unsigned)passages.data[i].body_a, (unsigned)passages.data[i].body_b, passages.data[i].time);
    vox_grid_destroy(grid);
    return 0;
}
