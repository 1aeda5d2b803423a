/* A grasper: two capsules close around a soft block, lift it by friction, hold it and let it fall. The jaws
 * are shapes in the grid of a simulation, which moves them to where they are placed before each step. */
#include "example.h"
#include "sim/soft_block.h"

#define STEPS 60 /* a second */

typedef struct grasper {
    vox_sim* sim;
    vox_grid* grid; /* of the simulation */
    vox_body jaws[2], block;
    double opening, height; /* of the jaws */
} grasper;

/* A capsule along y, to the left or right. */
static void place_jaws(const grasper* g) {
    for (int side = 0; side < 2; ++side) {
        const double x = (side == 0 ? -0.5 : 0.5) * g->opening;
        const double matrix[12] = {1, 0, 0, x, 0, 0, -1, 0, 0, 1, 0, g->height};
        must(vox_body_set_transform(g->grid, g->jaws[side], matrix));
    }
}

/* Moves the jaws to `opening` and `height` within a second, and lets the block come to rest in another. */
static void move_jaws(grasper* g, double opening, double height, const char* what) {
    const double by[2] = {(opening - g->opening) / STEPS, (height - g->height) / STEPS};
    for (int step = 0; step < 2 * STEPS; ++step) {
        if (step < STEPS) g->opening += by[0], g->height += by[1];
        place_jaws(g);
        must(vox_sim_step(g->sim, 1.0 / STEPS));
    }
    vox_constraint_view found;
    must(vox_grid_get_constraints(g->grid, &found));
    uint64_t held[2] = {0, 0};
    for (uint64_t i = 0; i < found.count; ++i)
        for (int side = 0; side < 2; ++side) held[side] += found.data[i].body_b == g->jaws[side];
    vox_sim_energy block;
    must(vox_sim_get_energy(g->sim, g->block, &block));
    printf("%-8s the block is at height %.2f, in the left jaw %2" PRIu64 " vertices, in the right %2" PRIu64
           "\n",
           what, block.centre[2], held[0], held[1]);
}

int main(void) {
    vox_sim_desc desc = vox_default_sim_desc(); /* with gravity, and a floor at z = 0 */
    grasper g = {.opening = 1.5, .height = 0.5};
    must(vox_sim_create(&desc, &g.sim));
    must(vox_sim_get_grid(g.sim, &g.grid));
    g.block = insert_block(g.sim, 4, 0, 0, 0.5);

    vox_shape_desc jaw = vox_default_shape_desc();
    jaw.kind = VOX_SHAPE_CAPSULE;
    jaw.radius = 0.2;
    jaw.half_length = 0.6;
    for (int side = 0; side < 2; ++side) must(vox_shape_insert(g.grid, &jaw, &g.jaws[side]));

    move_jaws(&g, 1.5, 0.5, "open:");
    move_jaws(&g, 1.1, 0.5, "closed:");
    move_jaws(&g, 1.1, 1.5, "lifted:");
    move_jaws(&g, 1.1, 1.5, "held:");
    move_jaws(&g, 1.5, 1.5, "dropped:");
    vox_sim_destroy(g.sim);
    return 0;
}
