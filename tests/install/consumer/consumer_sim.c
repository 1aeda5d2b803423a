#include <stdio.h>
#include <vox/vox_sim.h>

/* A tetrahedron falls. */
int main(void) {
    static const double positions[] = {0, 0, 9, 1, 0, 9, 0, 1, 9, 0, 0, 10};
    static const uint32_t tet[] = {0, 1, 2, 3};
    vox_sim_body_desc desc = vox_default_sim_body_desc();
    vox_sim_body_view view;
    vox_sim* sim;
    vox_body body;
    desc.positions = positions;
    desc.vertex_count = 4;
    desc.tets = tet;
    desc.tet_count = 1;
    if (vox_sim_create(NULL, &sim) != VOX_OK) return puts(vox_last_error()), 1;
    if (vox_sim_body_insert(sim, &desc, &body) != VOX_OK) return puts(vox_last_error()), 1;
    if (vox_sim_step(sim, 0.02) != VOX_OK) return puts(vox_last_error()), 1;
    if (vox_sim_body_get_view(sim, body, &view) != VOX_OK || view.positions[2] >= 9) return 1;
    vox_sim_destroy(sim);
    return 0;
}
