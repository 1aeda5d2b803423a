/* Pairs: a cube passes through another one; a third disappears while it touches. */
#include "example.h"

int main(void) {
    static const char* const states[] = {"near", "touching begins", "touching goes on", "touching ends"};
    vox_grid* grid = NULL;
    must(vox_grid_create(NULL, &grid));
    cube cubes[3] = {cube_at(0, 0, 0), cube_at(-1.6f, 0.3f, 0.3f), cube_at(0.2f, -0.7f, 0.2f)};
    vox_body ids[3];
    for (unsigned i = 0; i < 3; ++i) {
        vox_mesh_desc desc = cube_desc(&cubes[i]);
        desc.user_data = i + 1;
        must(vox_mesh_insert(grid, &desc, &ids[i]));
    }
    for (int frame = 0; frame < 6; ++frame, move_cube(&cubes[1], 0.9f, 0, 0)) {
        if (frame == 2) must(vox_body_remove(grid, ids[2])); /* its pair ends all the same */
        must(vox_grid_step(grid));
        vox_pair_view pairs;
        must(vox_grid_get_pairs(grid, &pairs));
        for (uint64_t i = 0; i < pairs.count; ++i) {
            const vox_pair* p = &pairs.data[i];
            printf("frame %d: cube %u and cube %u: %s, %" PRIu64 " contacts\n", frame,
                   (unsigned)p->user_data_a, (unsigned)p->user_data_b, states[p->state], p->contact_count);
        }
    }
    vox_grid_destroy(grid);
    return 0;
}
