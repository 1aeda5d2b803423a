/* Cutting: a bar of two cubes is cut in two, a tetrahedron is switched off, and the bar grows. Every index
 * stays. */
#include "example.h"

enum { corners_of_bar = 12, corners_on_cut = 4, most_vertices = 20 };

/* Cubes from x = 0 to 1 and from 1 to 2; their facets at x = 1 match. */
static const uint32_t bar_tets[10][4] = {{0, 1, 3, 6},   {4, 3, 1, 10}, {7, 6, 10, 1}, {9, 10, 6, 3},
                                         {1, 3, 6, 10},  {2, 1, 8, 5},  {4, 1, 10, 5}, {7, 8, 1, 10},
                                         {11, 8, 10, 5}, {1, 8, 5, 10}};

static void report(vox_grid* grid, const char* what) {
    must(vox_grid_step(grid));
    printf("%s: %" PRIu64 " contacts\n", what, contact_count(grid));
}

int main(void) {
    vox_grid* grid = NULL;
    must(vox_grid_create(NULL, &grid));

    float positions[most_vertices][3]; /* with room for what will come */
    for (int i = 0; i < corners_of_bar; ++i) {
        positions[i][0] = (float)(i % 3);
        positions[i][1] = (float)(i / 3 % 2);
        positions[i][2] = (float)(i / 6);
    }
    vox_mesh_desc desc = vox_default_mesh_desc();
    desc.positions = vox_float_positions(positions[0], corners_of_bar);
    desc.tets = bar_tets[0];
    desc.tet_count = 10;
    vox_body bar = VOX_NULL_BODY, probe = VOX_NULL_BODY;
    must(vox_mesh_insert(grid, &desc, &bar));

    const float points[2][3] = {{0.5f, 0.5f, 0.5f}, {1.5f, 0.5f, 0.5f}}; /* one in each cube */
    vox_mesh_desc sensors = vox_default_mesh_desc();
    sensors.positions = vox_float_positions(points[0], 2);
    must(vox_mesh_insert(grid, &sensors, &probe));
    report(grid, "whole");

    /* The cut at x = 1: its vertices 1, 4, 7, 10 are copied, and the right half names the copies. */
    const uint32_t on_cut[corners_on_cut] = {1, 4, 7, 10};
    for (int i = 0; i < corners_on_cut; ++i)
        for (int axis = 0; axis < 3; ++axis) positions[corners_of_bar + i][axis] = positions[on_cut[i]][axis];
    vox_vertices_desc copies = vox_default_vertices_desc();
    copies.count = corners_on_cut;
    copies.copies_of = on_cut;
    copies.positions = vox_float_positions(positions[0], corners_of_bar + corners_on_cut); /* longer now */
    uint32_t first = 0;
    must(vox_mesh_append_vertices(grid, bar, &copies, &first));

    uint32_t right[5], corners[5][4];
    for (uint32_t t = 0; t < 5; ++t) {
        right[t] = 5 + t;
        for (int c = 0; c < 4; ++c) {
            corners[t][c] = bar_tets[5 + t][c];
            for (uint32_t i = 0; i < corners_on_cut; ++i)
                if (corners[t][c] == on_cut[i]) corners[t][c] = first + i;
        }
    }
    must(vox_mesh_replace_tets(grid, bar, right, 5, corners[0]));
    report(grid, "cut");

    const uint32_t right_vertices[4] = {2, 5, 8, 11};
    for (uint32_t i = 0; i < 4; ++i) {
        positions[right_vertices[i]][0] += 3; /* the right half falls away */
        positions[first + i][0] += 3;
    }
    report(grid, "right half gone");

    const uint32_t middle = 4;
    must(vox_mesh_set_tets_enabled(grid, bar, &middle, 1, 0));
    report(grid, "a hole");
    must(vox_mesh_set_tets_enabled(grid, bar, &middle, 1, 1));

    /* One more vertex, and a tetrahedron from the cut to it, over the second probe. */
    vox_vertices_desc tip = vox_default_vertices_desc();
    tip.count = 1;
    tip.positions = vox_float_positions(positions[0], corners_of_bar + corners_on_cut + 1);
    positions[16][0] = 3;
    positions[16][1] = positions[16][2] = 0.5f;
    must(vox_mesh_append_vertices(grid, bar, &tip, &first));
    const uint32_t spike[8] = {1, 4, 10, first, 1, 10, 7, first};
    must(vox_mesh_append_tets(grid, bar, spike, 2, &first));
    report(grid, "grown");
    vox_grid_destroy(grid);
    return 0;
}
