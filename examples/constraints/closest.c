/* Closest points: where each vertex inside a body is, the surface next to it and the way there, for a program
 * that answers or draws it; and constraints of one pair without depth, which take little time. */
#include "example.h"

int main(void) {
    vox_grid* grid = NULL;
    must(vox_grid_create(NULL, &grid));
    cube shapes[3] = {cube_at(0, 0, 0), cube_at(0.5f, 0.875f, 0.25f), cube_at(-0.75f, 0.5f, 0.5f)};
    vox_body ids[3];
    for (unsigned i = 0; i < 3; ++i) {
        vox_mesh_desc mesh = cube_desc(&shapes[i]);
        mesh.user_data = i + 1;
        must(vox_mesh_insert(grid, &mesh, &ids[i]));
    }
    must(vox_grid_step(grid));
    vox_constraint_desc desc = vox_default_constraint_desc();
    desc.method = VOX_DEPTH_METHOD_CLOSEST;
    must(vox_grid_find_constraints(grid, &desc)); /* where they are wanted, after a step */
    vox_constraint_view view;
    must(vox_grid_get_constraints(grid, &view));
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_constraint* c = &view.data[i];
        printf("cube %u in cube %u at (%g, %g, %g): %g from triangle %u %u %u, normal (%g, %g, %g)\n",
               (unsigned)c->user_data_a, (unsigned)c->user_data_b, c->position[0], c->position[1],
               c->position[2], -c->gap, (unsigned)c->vertices[1], (unsigned)c->vertices[2],
               (unsigned)c->vertices[3], c->normal[0], c->normal[1], c->normal[2]);
    }

    desc.method = VOX_DEPTH_METHOD_NONE;
    desc.body_a = ids[0];
    desc.body_b = ids[1];
    must(vox_grid_find_constraints(grid, &desc));
    must(vox_grid_get_constraints(grid, &view));
    double middle[3] = {0, 0, 0};
    for (uint64_t i = 0; i < view.count; ++i)
        for (int k = 0; k < 3; ++k) middle[k] += view.data[i].position[k] / (double)view.count;
    printf("%" PRIu64 " vertices of cubes 1 and 2 in each other, around (%g, %g, %g)\n", view.count,
           middle[0], middle[1], middle[2]);
    vox_grid_destroy(grid);
    return 0;
}
