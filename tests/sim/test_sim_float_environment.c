/* Whatever floating-point environment the caller has set: bodies move the same, and the environment stays as
 * it was. */
#include <string.h>

#include "scenes/bodies.h"
#include "support/float_modes.h"
#include "support/suite.h"

#include <vox/vox_sim.h>

enum { bodies = 2, frames = 5 };

typedef struct log_state {
    uint64_t state; /* the caller's environment */
    int lines, wrong;
} log_state;

static void note(vox_log_level level, const char* text, void* user) {
    log_state* l = (log_state*)user;
    (void)level, (void)text;
    l->lines += 1;
    l->wrong += float_state() != l->state;
}

/* One cube above the other, after some frames; the caller frees it. */
static double* moved(const float_mode* mode, size_t* size) {
    const body cube = make_box(2, 0.25f, 0, 0, 0);
    const size_t count = 3 * (size_t)cube.vertex_count;
    double* positions = (double*)malloc(count * sizeof(double));
    double* out = (double*)malloc(bodies * count * sizeof(double));
    vox_sim_desc settings = vox_default_sim_desc();
    log_state log = {0, 0, 0};
    vox_sim* sim;
    vox_body ids[bodies];
    vox_sim_energy energy;
    set_float_mode(mode);
    log.state = float_state();
    set_float_mode(&float_modes[0]);
    const vox_log log_lines = {note, &log};
    settings.log = &log_lines;
    ck_in_mode(mode, vox_sim_create(&settings, &sim));
    for (int b = 0; b < bodies; ++b) {
        vox_sim_body_desc desc = vox_default_sim_body_desc();
        for (size_t i = 0; i < count; ++i)
            positions[i] = (double)cube.positions[i] + (i % 3 == 2 ? 0.1 + 0.45 * b : 0.03 * b);
        desc.positions = positions;
        desc.vertex_count = cube.vertex_count;
        desc.tets = cube.tets;
        desc.tet_count = cube.tet_count;
        desc.youngs_modulus = 1e30; /* too stiff, which the log says */
        ck_in_mode(mode, vox_sim_body_insert(sim, &desc, &ids[b]));
    }
    for (int frame = 0; frame < frames; ++frame) ck_in_mode(mode, vox_sim_step(sim, 1.0 / 60));
    ck_in_mode(mode, vox_sim_get_energy(sim, VOX_NULL_BODY, &energy));
    for (int b = 0; b < bodies; ++b) {
        vox_sim_body_view view;
        ck_in_mode(mode, vox_sim_body_get_view(sim, ids[b], &view));
        memcpy(out + (size_t)b * count, view.positions, count * sizeof(double));
    }
    out[0] += energy.kinetic;
    ck_assert_int_gt(log.lines, 0);
    ck_assert_msg(log.wrong == 0, "%s: the log saw another environment", mode->name);
    vox_sim_destroy(sim);
    free(positions);
    *size = bodies * count * sizeof(double);
    body done = cube;
    free_body(&done);
    return out;
}

START_TEST(same_motion) {
    size_t size;
    double* expected = moved(&float_modes[0], &size);
    for (int m = 0; m < float_mode_count; ++m) {
        double* found = moved(&float_modes[m], &size);
        ck_assert_msg(memcmp(found, expected, size) == 0, "%s: another motion", float_modes[m].name);
        free(found);
    }
    free(expected);
}
END_TEST

SUITE(sim_float_environment) {
    TCase* tests = add_case(suite, "modes");
    tcase_add_test(tests, same_motion);
}
