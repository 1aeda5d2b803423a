/* Terrain: soft blocks fall onto a heightfield with two valleys and a ridge between them, slide down and come
 * to rest. The ground is one shape of a few numbers; it has no vertices and no tetrahedra. */
#include "example.h"
#include "sim/soft_block.h"

#include <math.h>

enum { columns = 33, rows = 9, blocks = 5 };

#define SPACING 0.25

/* Two valleys along x = -2 and x = 2. */
static double height_of(double x) { return (x * x - 4) * (x * x - 4) / 16; }

static vox_body insert_terrain(vox_grid* grid) {
    double heights[columns * rows];
    const double left = -SPACING * (columns - 1) / 2, front = -SPACING * (rows - 1) / 2;
    for (int i = 0; i < columns * rows; ++i) heights[i] = height_of(left + SPACING * (i % columns));
    vox_shape_desc desc = vox_default_shape_desc();
    desc.kind = VOX_SHAPE_HEIGHTFIELD; /* its lowest corner is at the origin of its frame */
    desc.heights = heights;
    desc.columns = columns;
    desc.rows = rows;
    desc.spacing[0] = desc.spacing[1] = SPACING;
    const double matrix[12] = {1, 0, 0, left, 0, 1, 0, front, 0, 0, 1, 0};
    vox_body terrain = VOX_NULL_BODY;
    must(vox_shape_insert(grid, &desc, &terrain));
    must(vox_body_set_transform(grid, terrain, matrix));
    return terrain;
}

int main(void) {
    vox_sim_desc desc = vox_default_sim_desc();
    desc.floor_normal[2] = 0; /* the terrain is the floor */
    desc.friction = 0.1;
    vox_sim* sim = NULL;
    vox_grid* grid = NULL;
    must(vox_sim_create(&desc, &sim));
    must(vox_sim_get_grid(sim, &grid));
    const vox_body terrain = insert_terrain(grid);
    const double fall_at[blocks] = {-3, -1.8, -0.6, 0.4, 1.6};
    vox_body ids[blocks];
    for (int b = 0; b < blocks; ++b) ids[b] = insert_block(sim, 3, fall_at[b], 0, 3 + 1.5 * (b % 2));

    for (int step = 0; step < 600; ++step) must(vox_sim_step(sim, 1.0 / 60));

    for (int b = 0; b < blocks; ++b) {
        vox_sim_energy block;
        must(vox_sim_get_energy(sim, ids[b], &block));
        printf("fell at x = %4.1f, rests in the %s valley\n", fall_at[b],
               block.centre[0] < 0 ? "left" : "right");
    }
    vox_constraint_view found;
    must(vox_grid_get_constraints(grid, &found));
    uint64_t count = 0;
    double deepest = 0;
    for (uint64_t i = 0; i < found.count; ++i) {
        if (found.data[i].body_b != terrain) continue;
        ++count;
        deepest = fmax(deepest, -found.data[i].gap);
    }
    vox_sim_energy all;
    must(vox_sim_get_energy(sim, VOX_NULL_BODY, &all));
    printf("%" PRIu64 " vertices lie on the ground, none deeper than %.3f; the fastest moves at %.2f\n",
           count, deepest, all.max_speed);
    vox_sim_destroy(sim);
    return 0;
}
