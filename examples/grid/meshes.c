/* Meshes: they come and go, borrow or copy positions, and collide with whom they may. */
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

    /* Points without tetrahedra: sensors. */
    const float sensors[2][3] = {{0.3f, 0.3f, 0.3f}, {5, 5, 5}};
    vox_mesh_desc desc = vox_mesh_desc_floats(sensors[0], 2, NULL, 0);
    desc.user_data = 42; /* yours */
    vox_body points = VOX_NULL_BODY;
    must(vox_mesh_insert(grid, &desc, &points));
    step(grid, "and two points, one of them inside");

    vox_filter filter = VOX_ZERO;
    filter.mask = 2; /* the points feel meshes of category 2 only, and a and b are of category 1 */
    must(vox_body_set_filter(grid, points, &filter));
    step(grid, "the points filtered out");
    must(vox_grid_set_pair_enabled(grid, a, b, 0));
    step(grid, "the cubes an exception, too");
    must(vox_grid_set_pair_enabled(grid, a, b, 1));

    move_cube(&second, 0.25f, 0, 0); /* borrowed: no call needed */
    step(grid, "one cube moved");
    must(vox_body_set_enabled(grid, b, 0));
    step(grid, "and switched off");
    must(vox_body_remove(grid, a));
    printf("a is %s, b is %s\n", vox_body_is_valid(grid, a) ? "valid" : "gone",
           vox_body_is_valid(grid, b) ? "valid" : "gone");
    vox_grid_destroy(grid);
    return 0;
}
