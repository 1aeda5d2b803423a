/* What the examples share: unit cubes of five tetrahedra, and how to stop when a call fails. */
#ifndef VOX_EXAMPLES_EXAMPLE_H
#define VOX_EXAMPLES_EXAMPLE_H

#include "scenes/bodies.h"

#include <vox/vox.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#define must(call)                                                                                           \
    do {                                                                                                     \
        if ((call) != VOX_OK) {                                                                              \
            fprintf(stderr, "%s: %s\n", #call, vox_last_error());                                            \
            exit(EXIT_FAILURE);                                                                              \
        }                                                                                                    \
    } while (0)

typedef struct cube {
    float positions[8][3];
    uint32_t tets[5][4];
} cube;

static inline void move_cube(cube* c, float x, float y, float z) {
    for (int i = 0; i < 8; ++i) {
        c->positions[i][0] += x;
        c->positions[i][1] += y;
        c->positions[i][2] += z;
    }
}

/* The unit cube with its lowest corner at (x, y, z). */
static inline cube cube_at(float x, float y, float z) {
    cube c;
    write_lattice_positions(1, 1, 1, c.positions[0]);
    write_lattice_tets(&five_cut, 1, 1, 1, c.tets[0]);
    move_cube(&c, x, y, z);
    return c;
}

/* The positions are borrowed: after a move the next step reads the new ones. */
static inline vox_mesh_desc cube_desc(const cube* c) {
    return vox_mesh_desc_floats(c->positions[0], 8, c->tets[0], 5);
}

static inline vox_body insert_cube(vox_grid* grid, const cube* c) {
    const vox_mesh_desc desc = cube_desc(c);
    vox_body id = VOX_NULL_BODY;
    must(vox_mesh_insert(grid, &desc, &id));
    return id;
}

static inline uint64_t contact_count(const vox_grid* grid) {
    vox_contact_view view;
    must(vox_grid_get_contacts(grid, &view));
    return view.count;
}

#endif
