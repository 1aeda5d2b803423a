/* A game: who began or stopped to touch whom, and where the blow was hardest, for sounds, sparks and damage.
 * The bodies follow a script here; xpbd.c moves bodies by their constraints. */
#include "example.h"

enum { ground, crate, barrel, zone, entities };
enum { solid = 1, scenery = 2, trigger = 4 }; /* categories */

static const char* const names[entities] = {"ground", "crate", "barrel", "zone"};

static void touched(int frame, const vox_pair* pair, int begins) {
    printf("frame %d: %s and %s %s\n", frame, names[pair->user_data_a], names[pair->user_data_b],
           begins ? "touch" : "part");
}

static void play_sound(const double position[3], double loudness) {
    printf("         a blow of %.2f at (%.2f, %.2f, %.2f)\n", loudness, position[0], position[1],
           position[2]);
}

static void report(const vox_grid* grid, int frame) {
    vox_pair_view pairs;
    vox_constraint_view points;
    must(vox_grid_get_pairs(grid, &pairs));
    must(vox_grid_get_constraints(grid, &points));
    for (uint64_t p = 0; p < pairs.count; ++p) {
        const vox_pair* pair = &pairs.data[p];
        if (pair->state != VOX_PAIR_BEGAN && pair->state != VOX_PAIR_ENDED) continue;
        touched(frame, pair, pair->state == VOX_PAIR_BEGAN);
        const vox_constraint* hardest = NULL; /* none for sensors, and for pairs that ended */
        for (uint64_t i = points.pair_offsets[p]; i < points.pair_offsets[p + 1]; ++i)
            if (!hardest || points.data[i].gap < hardest->gap) hardest = &points.data[i];
        if (hardest) play_sound(hardest->position, -hardest->gap);
    }
}

static vox_body insert(vox_grid* grid, const cube* c, uint64_t entity) {
    vox_mesh_desc desc = cube_desc(c);
    desc.user_data = entity;
    desc.filter.category = entity == zone ? trigger : entity == ground ? scenery : solid;
    if (entity == zone) {
        desc.filter.flags = VOX_FILTER_SENSOR; /* it reports who is inside, and pushes nobody */
        desc.filter.mask = solid;
    }
    vox_body id = VOX_NULL_BODY;
    must(vox_mesh_insert(grid, &desc, &id));
    return id;
}

int main(void) {
    cube shapes[entities] = {cube_at(0, 0, -1), cube_at(0, 0, 1), cube_at(2.5f, 0.25f, 0.5f),
                             cube_at(-3, 0, 0)};
    for (int v = 0; v < 8; ++v) { /* the ground is large, and the crate leans */
        for (int k = 0; k < 2; ++k) shapes[ground].positions[v][k] = 20 * shapes[ground].positions[v][k] - 10;
        float* p = shapes[crate].positions[v];
        p[2] += p[0] / 8 + p[1] / 16;
    }
    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags = VOX_GRID_CONSTRAINTS | VOX_GRID_EDGES;
    vox_grid* grid = NULL;
    must(vox_grid_create(&desc, &grid));
    vox_body ids[entities];
    for (uint64_t e = 0; e < entities; ++e) ids[e] = insert(grid, &shapes[e], e);
    for (int frame = 0; frame < 6; ++frame) {
        if (frame == 1) move_cube(&shapes[crate], 0, 0, -1.0703125f); /* it falls, */
        if (frame == 2) move_cube(&shapes[crate], 0, 0, 0.0703125f);  /* and stands on a corner. */
        if (frame == 3) move_cube(&shapes[barrel], -1.625f, 0, 0);    /* Something hits it, */
        if (frame == 4) move_cube(&shapes[crate], -2.5f, 0, 0);       /* knocks it into the zone, */
        if (frame == 5)
            must(vox_body_remove(grid, ids[crate])); /* and it is gone. Its pairs end all the same. */
        must(vox_grid_step(grid));
        report(grid, frame);
    }
    vox_grid_destroy(grid);
    return 0;
}
