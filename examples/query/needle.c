/* A needle goes into an organ: the force that a hand feels, from the tetrahedra on its way. Each holds the
 * shaft by friction along the length inside it, and the tip has to cut the one that it is in. */
#include "example.h"

#include <vox/vox_query.h>

#include <math.h>

enum { cubes = 20, skin = 0, flesh = 1, tumour = 2 };

#define SIDE 100.0f /* of the organ, in mm */

static const char* const names[3] = {"skin", "flesh", "tumour"};
static const double friction[3] = {0.06, 0.02, 0.08}; /* N for a mm of the shaft */
static const double resistance[3] = {1.6, 0.4, 1.1};  /* N against the tip */

/* The upper cubes are skin, and around the middle there is a tumour. */
static int tissue_of(const body* organ, uint32_t tet) {
    double middle[3] = {0, 0, 0};
    for (uint32_t c = 0; c < 4; ++c)
        for (uint32_t k = 0; k < 3; ++k) middle[k] += organ->positions[3 * organ->tets[4 * tet + c] + k] / 4;
    if (middle[2] > -SIDE / cubes) return skin;
    middle[2] += SIDE / 2;
    return sqrt(middle[0] * middle[0] + middle[1] * middle[1] + middle[2] * middle[2]) < 20 ? tumour : flesh;
}

int main(void) {
    vox_grid* grid = NULL;
    must(vox_grid_create(NULL, &grid));
    body organ = make_box(cubes, SIDE / cubes, -SIDE / 2, -SIDE / 2, -SIDE); /* its top is at z = 0 */
    const vox_mesh_desc desc = body_desc(&organ);
    vox_body id = VOX_NULL_BODY;
    must(vox_mesh_insert(grid, &desc, &id));
    vox_locator* locator = NULL;
    must(vox_grid_step(grid));
    must(vox_grid_update_locator(grid, &locator));

    const double way[3] = {0.1, 0.05, -sqrt(1 - 0.1 * 0.1 - 0.05 * 0.05)}; /* of length 1 */
    double along[3] = {0, 0, 0};                                           /* mm in each tissue */
    for (int depth = -4; depth <= 92; depth += 8) {
        const double length = 120; /* of the needle: its hub stays outside */
        double hub[3], tip[3];
        for (int k = 0; k < 3; ++k) {
            tip[k] = depth * way[k] + (k < 2 ? -4 : 0);
            hub[k] = tip[k] - length * way[k];
        }
        const vox_positions from = vox_double_positions(hub, 1), to = vox_double_positions(tip, 1);
        vox_track_piece pieces[256];
        uint64_t count = 0;
        must(vox_locator_find_tracks(locator, &from, &to, NULL, pieces, 256, &count));
        double force = 0;
        for (int k = 0; k < 3; ++k) along[k] = 0;
        for (uint64_t i = 0; i < count; ++i) {
            const int tissue = tissue_of(&organ, pieces[i].tet);
            const double inside = (pieces[i].t_out - pieces[i].t_in) * length;
            along[tissue] += inside;
            force += friction[tissue] * inside;
            if (pieces[i].t_out == 1) force += resistance[tissue];
        }
        printf("%3d mm  %2u tets  %4.1f N  ", depth, (unsigned)count, force);
        for (int mark = 0; mark < (int)(8 * force + 0.5); ++mark) putchar('#');
        putchar('\n');
    }
    for (int k = 0; k < 3; ++k) printf("%s %.1f mm%s", names[k], along[k], k < 2 ? ", " : "\n");
    vox_locator_release(locator);
    vox_grid_destroy(grid);
    free_body(&organ);
    return 0;
}
