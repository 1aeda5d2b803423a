/* Soft blocks in a simulation. */
#ifndef VOX_EXAMPLES_SOFT_BLOCK_H
#define VOX_EXAMPLES_SOFT_BLOCK_H

#include "example.h"

#include <vox/vox_sim.h>

/* A cube of edge 1 around (x, y, z), as soft as rubber, of `cubes` small ones along each edge. */
static inline vox_body insert_block(vox_sim* sim, uint32_t cubes, double x, double y, double z) {
    body block = make_box(cubes, 1.0f / (float)cubes, -0.5f, -0.5f, -0.5f);
    double* positions = malloc(3 * sizeof *positions * block.vertex_count);
    if (!positions) exit(EXIT_FAILURE);
    const double at[3] = {x, y, z};
    for (uint32_t i = 0; i < 3 * block.vertex_count; ++i) positions[i] = at[i % 3] + block.positions[i];
    vox_sim_body_desc desc = vox_default_sim_body_desc();
    desc.positions = positions;
    desc.vertex_count = block.vertex_count;
    desc.tets = block.tets;
    desc.tet_count = block.tet_count;
    desc.youngs_modulus = desc.bulk_modulus = 2e5;
    desc.damping = 0.05;
    vox_body id = VOX_NULL_BODY;
    must(vox_sim_body_insert(sim, &desc, &id));
    free(positions);
    free_body(&block);
    return id;
}

#endif
