/* A floor is a mesh like any other: a slab of a few large tetrahedra that never moves. It is at rest, so that
 * a step reads its few positions and nothing else, and constraints push what is in it straight up. */
#include "example.h"

#define SIDE 20 /* cubes of the falling body along each axis: 40,000 tetrahedra */

/* A slab 100 by 100 and 4 thick below z = 0, of n * n * 5 tetrahedra. */
static body make_slab(uint32_t n) {
    body slab = make_block(&five_cut, n, n, 1);
    for (uint32_t v = 0; v < slab.vertex_count; ++v) {
        float* p = slab.positions + 3 * v;
        p[0] = 100 * p[0] / (float)n - 50;
        p[1] = 100 * p[1] / (float)n - 50;
        p[2] = 4 * p[2] - 4;
    }
    return slab;
}

/* Steps while a body sinks through z = 0, on a floor of n * n * 5 tetrahedra; none for 0. */
static void measure(uint32_t n) {
    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags = VOX_GRID_CONSTRAINTS;
    vox_grid* grid = NULL;
    must(vox_grid_create(&desc, &grid));
    body box = make_box(SIDE, 0.05f, 0, 0, 0.01f), slab = make_slab(n > 0 ? n : 1);
    const vox_mesh_desc box_desc = body_desc(&box), slab_desc = body_desc(&slab);
    vox_body body_id, slab_id;
    must(vox_mesh_insert(grid, &box_desc, &body_id));
    if (n > 0) must(vox_mesh_insert(grid, &slab_desc, &slab_id));

    uint64_t in_air = UINT64_MAX, on_floor = UINT64_MAX; /* least of 20 steps */
    vox_grid_info info = {.struct_size = sizeof info};
    for (int step = 0; step < 40; ++step) {
        const float down = step == 20 ? 0.012f : step % 2 == 0 ? 0.001f : -0.001f;
        for (uint32_t v = 0; v < box.vertex_count; ++v) box.positions[3 * v + 2] -= down;
        must(vox_grid_step(grid));
        must(vox_grid_get_info(grid, &info));
        uint64_t* least = step < 20 ? &in_air : &on_floor;
        if (info.step_ns < *least) *least = info.step_ns;
    }
    uint64_t inside = 0, straight_up = 0; /* vertices of the body in the floor */
    vox_constraint_view found;
    must(vox_grid_get_constraints(grid, &found));
    for (uint64_t i = 0; i < found.count; ++i) {
        if (found.data[i].body_a != body_id) continue;
        ++inside;
        straight_up += found.data[i].normal[2] > 0.999;
    }
    printf("floor of %5" PRIu64 " tets: %4.0f us a step in the air, %4.0f us on it; meshes moved: %" PRIu64
           ", vertices in the floor: %" PRIu64 ", pushed straight up: %" PRIu64 "\n",
           n > 0 ? (uint64_t)slab.tet_count : 0, 1e-3 * (double)in_air, 1e-3 * (double)on_floor,
           info.moved_bodies, inside, straight_up);
    vox_grid_destroy(grid);
    free_body(&box);
    free_body(&slab);
}

int main(void) {
    measure(0);
    measure(1);
    measure(100);
    return 0;
}
