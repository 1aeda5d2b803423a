/* Isolated scenes in one grid: copies of a scene at the same place, such as those of an optimiser or of a
 * learner, that do not see each other, since each is a world of its own. */
#include "example.h"

enum { scenes = 100 };

static cube cubes[scenes][2];

static void insert_into(vox_grid* grid, const cube* c, int scene) {
    const vox_body mesh = insert_cube(grid, c);
    vox_filter filter = VOX_ZERO;
    filter.world = (uint32_t)scene;
    must(vox_body_set_filter(grid, mesh, &filter));
}

int main(void) {
    vox_grid* grid = NULL;
    must(vox_grid_create(NULL, &grid));
    for (int s = 0; s < scenes; ++s)
        for (int i = 0; i < 2; ++i) {
            /* The second cube of every other scene is out of reach of the first. */
            cubes[s][i] =
                cube_at(0.75f * (float)i, 0.25f * (float)i, i == 1 && s % 2 == 1 ? 5.0f : 0.25f * (float)i);
            insert_into(grid, &cubes[s][i], s);
        }
    must(vox_grid_step(grid));

    vox_pair_view pairs;
    must(vox_grid_get_pairs(grid, &pairs));
    uint64_t contacts = 0;
    for (uint64_t i = 0; i < pairs.count; ++i) contacts += pairs.data[i].contact_count;
    printf("%d scenes in one place: %" PRIu64 " pairs touch, with %" PRIu64 " contacts each\n", scenes,
           pairs.count, contacts / pairs.count);
    vox_grid_destroy(grid);
    return 0;
}
