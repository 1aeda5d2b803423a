/* Scenes and formulas shared by the tests of the cell size. */
#ifndef VOX_TESTS_SUGGEST_SCENES_H
#define VOX_TESTS_SUGGEST_SCENES_H

#include "scenes/bodies.h"
#include "support/suite.h"

/* A regular tetrahedron in a unit cube: edge sqrt(2), facet area sqrt(3)/2, volume 1/3, box side 1. */
static const float regular_positions[12] = {0, 0, 0, 1, 1, 0, 1, 0, 1, 0, 1, 1};

static inline vox_suggestion suggest_ok(const vox_suggest_desc* desc, const vox_mesh_desc* meshes,
                                        uint64_t count) {
    vox_suggestion found;
    found.struct_size = sizeof found;
    ck_ok(vox_suggest_cell_size(desc, meshes, count, &found));
    return found;
}

/* A box of 3 * 3 * 3 cubes with its vertices moved about, so that all means differ from one another. */
static inline body make_uneven_box(void) {
    body box = make_box(3, 0.25f, -1.5f, 0.5f, 2);
    uint32_t state = 12345;
    for (uint32_t i = 0; i < 3 * box.vertex_count; ++i)
        box.positions[i] += (float)(random_quick(&state) >> 16) / 65536.0f * 0.125f;
    return box;
}

/* The tests of bad arguments. */
void add_argument_tests(Suite* suite);

#endif
