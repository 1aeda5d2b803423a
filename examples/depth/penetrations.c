/* Penetrations: how deep a vertex is inside, and which way out: pushes a cube out of another one. */
#include "example.h"

int main(void) {
    vox_grid* grid = NULL;
    must(vox_grid_create(NULL, &grid));
    cube floor_cube = cube_at(0, 0, 0), falling = cube_at(0.3f, 0.8f, 0.3f); /* y is up */
    insert_cube(grid, &floor_cube);
    const vox_body b = insert_cube(grid, &falling);
    for (int frame = 0; frame < 6; ++frame) {
        must(vox_grid_step(grid));
        vox_penetration_view view;
        must(vox_grid_penetrations(grid, &view));
        const vox_penetration* deepest = NULL;
        for (uint64_t i = 0; i < view.count; ++i)
            if (view.data[i].body_a == b && (!deepest || view.data[i].depth > deepest->depth))
                deepest = &view.data[i];
        if (!deepest) {
            printf("frame %d: out\n", frame);
            break;
        }
        printf("frame %d: deepest vertex %u, %.3f inside, out along (%.2f, %.2f, %.2f)\n", frame,
               (unsigned)deepest->vertex, deepest->depth, deepest->direction[0], deepest->direction[1],
               deepest->direction[2]);
        const float way = 1.01f * deepest->depth + 0.001f;
        move_cube(&falling, way * deepest->direction[0], way * deepest->direction[1],
                  way * deepest->direction[2]);
    }
    vox_grid_destroy(grid);
    return 0;
}
