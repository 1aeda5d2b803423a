/* Readings: where each contact is, the surface next to it and the way there, for a program that answers or
 * draws it. */
#include "example.h"

int main(void) {
    vox_grid* grid = NULL;
    must(vox_grid_create(NULL, &grid));
    cube first = cube_at(0, 0, 0), second = cube_at(0.5f, 0.875f, 0.25f);
    vox_mesh_desc desc = cube_desc(&first);
    desc.user_data = 1;
    vox_body a, b;
    must(vox_mesh_insert(grid, &desc, &a));
    desc = cube_desc(&second);
    desc.user_data = 2;
    must(vox_mesh_insert(grid, &desc, &b));
    must(vox_grid_step(grid));
    must(vox_grid_prepare_readings(grid)); /* where they are wanted, once a step */

    vox_reading_view view;
    must(vox_grid_readings(grid, &view));
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_reading* r = &view.data[i]; /* of contact i */
        if (!(r->known & VOX_READING_SURFACE)) continue;
        printf("cube %u in cube %u at (%g, %g, %g): %g from triangle %u %u %u, normal (%g, %g, %g)\n",
               (unsigned)r->user_data_a, (unsigned)r->user_data_b, r->position[0], r->position[1],
               r->position[2], r->distance, (unsigned)r->triangle[0], (unsigned)r->triangle[1],
               (unsigned)r->triangle[2], r->normal[0], r->normal[1], r->normal[2]);
    }

    /* One field of all readings is an array with a stride: here for the middle of the contacts. */
    double middle[3] = {0, 0, 0};
    const char* position = view.count ? (const char*)view.data->position : NULL;
    for (uint64_t i = 0; i < view.count; ++i, position += view.byte_stride)
        for (int axis = 0; axis < 3; ++axis)
            middle[axis] += ((const double*)(const void*)position)[axis] / (double)view.count;

    /* What one pair has, copied out: it may be kept. */
    vox_reading kept[16];
    uint64_t count = 0;
    must(vox_pair_copy_readings(grid, a, b, kept, 16, &count));
    printf("%" PRIu64 " contacts between the two, around (%g, %g, %g)\n", count, middle[0], middle[1],
           middle[2]);

    /* Parts of them, for one pair: without its surface, a reading costs little more than a copy of it. */
    vox_readings_desc part = vox_default_readings_desc();
    part.what = VOX_READING_POSITION | VOX_READING_DEPTH;
    part.body_a = a;
    part.body_b = b;
    must(vox_grid_prepare_readings_of(grid, &part));
    vox_depth_view depths; /* in double */
    must(vox_grid_reading_depths(grid, &depths));
    double deepest = 0;
    for (uint64_t i = 0; i < depths.count; ++i)
        if (depths.data[i].depth > deepest) deepest = depths.data[i].depth;
    printf("the deepest is %.4g inside\n", deepest);
    vox_grid_destroy(grid);
    return 0;
}
