/* Scenes and formulas shared by the tests of the cell size. */
#ifndef VOX_TESTS_SUGGEST_SCENES_H
#define VOX_TESTS_SUGGEST_SCENES_H

#include <string.h>
#include <vox/vox_cell_size.h>

#include "scenes/bodies.h"
#include "support/suite.h"

/* A regular tetrahedron in a unit cube: edge sqrt(2), facet area sqrt(3)/2, volume 1/3, box side 1. */
static const float regular_positions[12] = {0, 0, 0, 1, 1, 0, 1, 0, 1, 0, 1, 1};

static inline vox_cell_size_result suggest_ok(const vox_cell_size_desc* desc, const vox_mesh_desc* meshes,
                                              uint64_t count) {
    vox_cell_size_result found;
    found.struct_size = sizeof found;
    ck_ok(vox_suggest_cell_size(desc, meshes, count, &found));
    return found;
}

static inline vox_geometry geometry_of(const vox_mesh_desc* meshes, uint64_t count) {
    vox_geometry geometry;
    geometry.struct_size = sizeof geometry;
    ck_ok(vox_measure_geometry(meshes, count, &geometry));
    return geometry;
}

/* The first rule with these words in its name. */
static inline vox_cell_size_rule rule_of(const vox_cell_size_result* found, const char* words) {
    for (uint32_t i = 0; i < found->rule_count; ++i)
        if (strstr(found->rules[i].name, words)) return found->rules[i];
    ck_abort_msg("no rule with \"%s\" in its name", words);
    return found->rules[0];
}

static inline double rule_size(const vox_cell_size_result* found, const char* words) {
    return rule_of(found, words).cell_size;
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
