/* Rigid shapes: a cube in a floor, a finger that presses it, a blade through it, and a ball that went through
 * within one step. One loop reads them all. */
#include "example.h"

static vox_body insert(vox_grid* grid, const vox_shape_desc* desc, const double matrix[12]) {
    vox_body id = VOX_NULL_BODY;
    must(vox_shape_insert(grid, desc, &id));
    must(vox_body_set_transform(grid, id, matrix));
    return id;
}

int main(void) {
    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags = VOX_GRID_CONSTRAINTS | VOX_GRID_EDGES;
    vox_grid* grid = NULL;
    must(vox_grid_create(&desc, &grid));
    const cube soft = cube_at(0, 0, -0.25f);
    (void)insert_cube(grid, &soft);

    vox_shape_desc shape = vox_default_shape_desc();
    shape.kind = VOX_SHAPE_HALF_SPACE; /* z <= 0 */
    const vox_body plane = insert(grid, &shape, NULL);

    shape.kind = VOX_SHAPE_CAPSULE;
    shape.radius = 0.125;
    shape.half_length = 0.5;
    const double finger_at[12] = {1, 0, 0, 0, 0, 1, 0, 0.0625, 0, 0, 1, 1.25}; /* its tip is at z = 0.625 */
    const vox_body finger = insert(grid, &shape, finger_at);

    const double corners[12] = {0.375, -1, 0.25, 0.375, 2, 0.25, 0.375, 2, 2, 0.375, -1, 2};
    const uint32_t triangles[6] = {0, 1, 2, 0, 2, 3};
    shape = vox_default_shape_desc();
    shape.kind = VOX_SHAPE_SHEET;
    shape.positions = vox_double_positions(corners, 4);
    shape.triangles = triangles;
    shape.triangle_count = 2;
    const vox_body blade = insert(grid, &shape, NULL);

    shape = vox_default_shape_desc();
    shape.kind = VOX_SHAPE_SPHERE;
    shape.radius = 0.25;
    const double from[12] = {1, 0, 0, -4, 0, 1, 0, 1, 0, 0, 1, 0.75},
                 to[12] = {1, 0, 0, 4, 0, 1, 0, 1, 0, 0, 1, 0.75};
    const vox_body ball = insert(grid, &shape, to);
    must(vox_shape_set_previous_transform(grid, ball, from));

    must(vox_grid_step(grid));
    vox_constraint_view found;
    must(vox_grid_get_constraints(grid, &found));
    const char* const kinds[4] = {"inside", "edge", "near", "impact"};
    for (uint64_t i = 0; i < found.count; ++i) {
        const vox_constraint* c = &found.data[i];
        printf("%s, %s %u",
               c->body_b == plane    ? "floor"
               : c->body_b == finger ? "finger"
               : c->body_b == blade  ? "blade"
                                     : "ball",
               kinds[c->kind], (unsigned)c->vertices[0]);
        if (c->count == 2) printf(" %u", (unsigned)c->vertices[1]);
        if (c->count == 3) printf(" %u %u", (unsigned)c->vertices[1], (unsigned)c->vertices[2]);
        printf(": %g along (%g, %g, %g)", -c->gap, c->normal[0], c->normal[1], c->normal[2]);
        printf(c->kind == VOX_CONSTRAINT_IMPACT ? " at time %.3f\n" : "\n", c->time);
    }
    vox_grid_destroy(grid);
    return 0;
}
