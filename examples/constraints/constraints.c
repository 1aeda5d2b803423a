/* Constraints: how deep a vertex is inside, and which way out: pushes a cube out of another one. */
#include "example.h"

int main(void) {
    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags = VOX_GRID_CONSTRAINTS; /* in every step */
    vox_grid* grid = NULL;
    must(vox_grid_create(&desc, &grid));
    cube floor_cube = cube_at(0, 0, 0), falling = cube_at(0.3f, 0.8f, 0.3f); /* y is up */
    insert_cube(grid, &floor_cube);
    const vox_body b = insert_cube(grid, &falling);
    for (int frame = 0; frame < 6; ++frame) {
        must(vox_grid_step(grid));
        vox_constraint_view view;
        must(vox_grid_get_constraints(grid, &view));
        const vox_constraint* deepest = NULL;
        for (uint64_t i = 0; i < view.count; ++i)
            if (view.data[i].body_a == b && (!deepest || view.data[i].gap < deepest->gap))
                deepest = &view.data[i];
        if (!deepest) {
            printf("frame %d: out\n", frame);
            break;
        }
        printf("frame %d: deepest vertex %u, %.3f inside tet %u, out along (%.2f, %.2f, %.2f)\n", frame,
               (unsigned)deepest->vertices[0], -deepest->gap, (unsigned)deepest->element_b,
               deepest->normal[0], deepest->normal[1], deepest->normal[2]);
        const double way = 0.001 - 1.01 * deepest->gap;
        move_cube(&falling, (float)(way * deepest->normal[0]), (float)(way * deepest->normal[1]),
                  (float)(way * deepest->normal[2]));
    }
    vox_grid_destroy(grid);
    return 0;
}
