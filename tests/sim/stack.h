/* Slabs that rest on each other. */
#ifndef VOX_TESTS_SIM_STACK_H
#define VOX_TESTS_SIM_STACK_H

#include "sim/scene.h"

/* `count` slabs of about `tets` tets on top of each other, each turned against the one below. They stay where
 * they are, and their total energy stays below where it began. */
static inline void rests_stacked(int count, double cell, int frames) {
    vox_sim_desc desc = vox_default_sim_desc();
    desc.substeps = 20;
    desc.detect_every = 4;
    vox_sim* sim = open_sim(&desc);
    vox_sim_body_desc like = vox_default_sim_body_desc();
    like.youngs_modulus = 5e6;
    like.bulk_modulus = 5e6;
    vox_io_mesh* mesh = box(2, 2, 0.7, cell);
    vox_body bodies[10];
    vox_sim_energy start[10];
    for (int i = 0; i < count; ++i) {
        bodies[i] = insert(sim, mesh, &like, 0.3 * i, 0, 0, 0.351 + 0.701 * i);
        start[i] = energy_of(sim, bodies[i]);
    }
    const vox_sim_energy before = energy_of(sim, VOX_NULL_BODY);
    double fastest = 0; /* in the last tenth */
    for (int frame = 0; frame < frames; ++frame) {
        ck_ok(vox_sim_step(sim, 1.0 / 60));
        const vox_sim_energy now = energy_of(sim, VOX_NULL_BODY);
        ck_assert_msg(total(&now) <= total(&before), "frame %d: energy %.3f, at first %.3f", frame,
                      total(&now), total(&before));
        ck_assert_msg(now.max_speed < 3, "frame %d: %g", frame, now.max_speed);
        if (frame >= frames - frames / 10) fastest = fmax(fastest, now.max_speed);
    }
    const vox_sim_energy after = energy_of(sim, VOX_NULL_BODY);
    double drift = 0, sunk = 0;
    for (int i = 0; i < count; ++i) {
        const vox_sim_energy now = energy_of(sim, bodies[i]);
        drift = fmax(drift, hypot(now.centre[0] - start[i].centre[0], now.centre[1] - start[i].centre[1]));
        sunk = fmax(sunk, fabs(now.centre[2] - start[i].centre[2]) / start[i].centre[2]);
    }
    printf("%d slabs of %u tets, %d frames: drift %.4f, sunk %.2f %%, fastest at the end %.3f, energy %.1f "
           "-> %.1f\n",
           count, (unsigned)view_of(sim, bodies[0]).tet_count, frames, drift, 100 * sunk, fastest,
           total(&before), total(&after));
    ck_assert_double_le(drift, 0.05); /* of a width of 2 */
    ck_assert_double_le(sunk, 0.05);
    ck_assert_double_le(fastest, 1);
    ck_assert_uint_gt(counter(sim, "constraints"), 0);
    vox_io_mesh_destroy(mesh);
    vox_sim_destroy(sim);
}

#endif
