/* Meshes: they come and go, borrow or copy positions, and need not have tetrahedra. */
#include "example.h"

static void step(vox_grid* grid, const char* what) {
    must(vox_grid_step(grid));
    printf("%-34s %2" PRIu64 " contacts\n", what, contact_count(grid));
}

int main(void) {
    vox_grid* grid = NULL;
    must(vox_grid_create(NULL, &grid));
    cube first = cube_at(0, 0, 0), second = cube_at(0.5f, 0.5f, 0.5f);
    const vox_body a = insert_cube(grid, &first), b = insert_cube(grid, &second);
    step(grid, "two cubes");

    /* Points without tetrahedra, copied. */
    float points[2][3] = {{0.3f, 0.3f, 0.3f}, {5, 5, 5}};
    vox_mesh_desc desc = vox_mesh_desc_floats(points[0], 2, NULL, 0);
    desc.flags = VOX_MESH_COPY_POSITIONS;
    vox_body id = VOX_NULL_BODY;
    must(vox_mesh_insert(grid, &desc, &id));
    points[0][0] = 5; /* which the grid does not see */
    step(grid, "and two points, one of them inside");

    move_cube(&second, 1, 0, 0); /* borrowed: no call needed */
    step(grid, "one cube moved");
    must(vox_body_remove(grid, a));
    step(grid, "the other one removed");
    printf("a is %s, b is %s\n", vox_body_is_valid(grid, a) ? "valid" : "gone",
           vox_body_is_valid(grid, b) ? "valid" : "gone");
    vox_grid_destroy(grid);
    return 0;
}
