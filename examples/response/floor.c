/* A floor is a rigid shape: five lines, without vertices or tetrahedra. A body sinks through it, and
 * constraints push what is in it straight up. */
#include "example.h"

#define SIDE 20 /* cubes of the falling body along each axis: 40,000 tetrahedra */

static vox_body add_floor(vox_grid* grid) {
    vox_shape_desc desc = vox_default_shape_desc();
    desc.kind = VOX_SHAPE_HALF_SPACE; /* all z <= 0; vox_body_set_transform turns and lifts it */
    vox_body floor = VOX_NULL_BODY;
    must(vox_shape_insert(grid, &desc, &floor));
    return floor;
}

/* Steps while a body sinks through z = 0. */
static void measure(int with_floor) {
    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags = VOX_GRID_CONSTRAINTS;
    vox_grid* grid = NULL;
    must(vox_grid_create(&desc, &grid));
    body box = make_box(SIDE, 0.05f, 0, 0, 0.01f);
    const vox_mesh_desc box_desc = body_desc(&box);
    vox_body body_id;
    must(vox_mesh_insert(grid, &box_desc, &body_id));
    const vox_body floor_id = with_floor ? add_floor(grid) : VOX_NULL_BODY;

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
    /* The constraints of a vertex in the floor are those of a vertex in a mesh, but for their only vertex. */
    uint64_t inside = 0, straight_up = 0;
    vox_constraint_view found;
    must(vox_grid_get_constraints(grid, &found));
    for (uint64_t i = 0; i < found.count; ++i) {
        const vox_constraint* c = &found.data[i];
        if (c->body_b != floor_id) continue;
        ++inside;
        straight_up += c->count == 1 && c->normal[2] == 1 && c->gap == box.positions[3 * c->vertices[0] + 2];
    }
    printf("%s: %4.0f us a step in the air, %4.0f us on it; vertices in the floor: %" PRIu64
           ", pushed straight up: %" PRIu64 "\n",
           with_floor ? "a floor" : "no floor", 1e-3 * (double)in_air, 1e-3 * (double)on_floor, inside,
           straight_up);
    vox_grid_destroy(grid);
    free_body(&box);
}

int main(void) {
    measure(0);
    measure(1);
    return 0;
}
