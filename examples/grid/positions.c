/* Positions: in records, in columns, in doubles; bound again, and in memory of the library. */
#include "example.h"

static const uint32_t tet[4] = {0, 1, 2, 3};

/* Steps, and prints how many points are inside the tetrahedron. */
static void step(vox_grid* grid, const char* what) {
    must(vox_grid_step(grid));
    printf("%-22s %" PRIu64 " inside\n", what, contact_count(grid));
}

int main(void) {
    vox_grid* grid = NULL;
    must(vox_grid_create(NULL, &grid));
    const float corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const vox_mesh_desc solid = vox_mesh_desc_floats(corners, 4, tet, 1);
    vox_body id = VOX_NULL_BODY;
    must(vox_mesh_insert(grid, &solid, &id));

    /* Part of larger records. */
    const struct { float temperature, position[3]; } sensors[2] = {{20, {0.3f, 0.3f, 0.3f}}, {21, {5, 5, 5}}};
    vox_mesh_desc desc = vox_default_mesh_desc();
    desc.positions = vox_float_positions(sensors[0].position, 2);
    desc.positions.byte_stride = sizeof sensors[0];
    vox_body points = VOX_NULL_BODY;
    must(vox_mesh_insert(grid, &desc, &points));
    step(grid, "in records:");

    /* All x, all y, all z, in doubles. */
    const double columns[3][2] = {{0.1, 0.2}, {0.1, 0.2}, {0.1, 0.2}};
    vox_positions positions = vox_double_positions(columns[0], 2);
    positions.component_byte_stride = sizeof columns[0];
    must(vox_mesh_bind_positions(grid, points, &positions));
    step(grid, "in columns:");

    /* The library's own copy, to be written to. */
    void* mapped = NULL;
    must(vox_mesh_map_positions(grid, points, &mapped));
    ((double*)mapped)[0] = 7; /* x of the first */
    step(grid, "in the library's own:");
    vox_grid_destroy(grid);
    return 0;
}
