/* Proximity and impacts: who comes close to a cube, and who went into it between two frames and is behind the
 * face that it met. */
#include "example.h"

static void print(const vox_grid* grid) {
    vox_constraint_view view;
    must(vox_grid_get_constraints(grid, &view));
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_constraint* c = &view.data[i];
        if (c->kind == VOX_CONSTRAINT_PROXIMITY)
            printf("vertex %u of %u is %g from %u, which pushes it along (%g, %g, %g)\n",
                   (unsigned)c->vertices[0], (unsigned)c->user_data_a, c->gap, (unsigned)c->user_data_b,
                   c->normal[0], c->normal[1], c->normal[2]);
        else if (c->kind == VOX_CONSTRAINT_IMPACT)
            printf("vertex %u of %u met %u at time %.4f and is %g behind the face\n",
                   (unsigned)c->vertices[0], (unsigned)c->user_data_a, (unsigned)c->user_data_b, c->time,
                   -c->gap);
    }
}

int main(void) {
    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags = VOX_GRID_CONSTRAINTS;
    desc.margin = 0.25;
    vox_grid* grid = NULL;
    must(vox_grid_create(&desc, &grid));
    cube shapes[2] = {cube_at(0, 0, 0), cube_at(0.25f, 0.125f, -1.125f)}; /* the target, and a bullet */
    vox_body ids[2];
    for (unsigned i = 0; i < 2; ++i) {
        vox_mesh_desc mesh = cube_desc(&shapes[i]);
        mesh.user_data = i + 1;
        must(vox_mesh_insert(grid, &mesh, &ids[i]));
    }
    must(vox_grid_step(grid));
    print(grid);

    const cube before = shapes[1]; /* where its vertices were a frame ago */
    const vox_positions came_from = vox_float_positions(before.positions[0], 8);
    must(vox_mesh_bind_previous_positions(grid, ids[1], &came_from));
    move_cube(&shapes[1], 0, 0, 8);
    must(vox_grid_step(grid));
    printf("%" PRIu64 " contacts, but\n", contact_count(grid));
    print(grid);
    vox_grid_destroy(grid);
    return 0;
}
