/* Edges: two bars laid across each other. No vertex of one is in the other; edges of one pass through faces
 * of the other, and the way out is up, by as much as they overlap. */
#include "example.h"

/* A cube, 9 times as long along one axis, around its middle. */
static cube bar_along(int axis, float z) {
    cube bar = cube_at(0, 0, z);
    for (int v = 0; v < 8; ++v) bar.positions[v][axis] = 9 * (bar.positions[v][axis] - 0.5f) + 0.5f;
    return bar;
}

int main(void) {
    cube below = bar_along(0, 0), above = bar_along(1, 0.75f);
    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags = VOX_GRID_CONSTRAINTS | VOX_GRID_EDGES;
    vox_grid* grid = NULL;
    must(vox_grid_create(&desc, &grid));
    insert_cube(grid, &below);
    const vox_body upper = insert_cube(grid, &above);
    must(vox_grid_step(grid));
    vox_constraint_view view;
    must(vox_grid_get_constraints(grid, &view));
    printf("%" PRIu64 " contacts, %s\n", contact_count(grid), view.count > 0 ? "but edges" : "no edges");
    const vox_constraint* deepest = NULL;
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_constraint* c = &view.data[i];
        if (c->kind == VOX_CONSTRAINT_EDGE && c->body_a == upper && (!deepest || c->gap < deepest->gap))
            deepest = c;
    }
    /* Its vertices are those of the edge, then those of the face. */
    printf("edge %u %u of the upper bar enters face %u %u %u of the lower one at y = %g; the way out is %g "
           "along "
           "(%g, %g, %g)\n",
           (unsigned)deepest->vertices[0], (unsigned)deepest->vertices[1], (unsigned)deepest->vertices[2],
           (unsigned)deepest->vertices[3], (unsigned)deepest->vertices[4], deepest->position[1],
           -deepest->gap, deepest->normal[0], deepest->normal[1], deepest->normal[2]);

    move_cube(&above, 0, 0, 0.01f - (float)deepest->gap);
    must(vox_grid_step(grid));
    must(vox_grid_get_constraints(grid, &view));
    printf("moved out: %" PRIu64 " constraints\n", view.count);
    vox_grid_destroy(grid);
    return 0;
}
