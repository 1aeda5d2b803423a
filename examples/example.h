/* What the examples share: unit cubes of five tetrahedra, and one way to fail. */
#ifndef VOX_EXAMPLES_EXAMPLE_H
#define VOX_EXAMPLES_EXAMPLE_H

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <vox/vox.h>

#define must(call)                                                                                           \
    do {                                                                                                     \
        if ((call) != VOX_OK) {                                                                              \
            fprintf(stderr, "%s: %s\n", #call, vox_last_error());                                            \
            exit(EXIT_FAILURE);                                                                              \
        }                                                                                                    \
    } while (0)

/* Corner i of a cube has bit 0 of i as x, bit 1 as y, bit 2 as z. */
typedef struct cube {
    float positions[8][3];
} cube;

static const uint32_t cube_tets[5][4] = {
    {0, 1, 2, 4}, {3, 2, 1, 7}, {5, 4, 7, 1}, {6, 7, 4, 2}, {1, 2, 4, 7}};

static inline cube cube_at(float x, float y, float z) {
    cube c;
    for (int i = 0; i < 8; ++i) {
        c.positions[i][0] = x + (float)(i & 1);
        c.positions[i][1] = y + (float)(i >> 1 & 1);
        c.positions[i][2] = z + (float)(i >> 2);
    }
    return c;
}

static inline void move_cube(cube* c, float x, float y, float z) {
    for (int i = 0; i < 8; ++i) {
        c->positions[i][0] += x;
        c->positions[i][1] += y;
        c->positions[i][2] += z;
    }
}

/* The positions are borrowed: move them, and the next step sees it. */
static inline vox_mesh_desc cube_desc(const cube* c) {
    vox_mesh_desc desc = vox_default_mesh_desc();
    desc.positions = c->positions;
    desc.vertex_count = 8;
    desc.tets = cube_tets[0];
    desc.tet_count = 5;
    return desc;
}

static inline vox_mesh insert_cube(vox_grid* grid, const cube* c) {
    const vox_mesh_desc desc = cube_desc(c);
    vox_mesh mesh = VOX_NULL_MESH;
    must(vox_mesh_insert(grid, &desc, &mesh));
    return mesh;
}

static inline uint64_t contact_count(const vox_grid* grid) {
    vox_contact_view view;
    must(vox_grid_contacts(grid, &view));
    return view.count;
}

#endif
