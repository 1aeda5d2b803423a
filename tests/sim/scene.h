/* Bodies from vox_io put into a simulation. */
#ifndef VOX_TESTS_SIM_SCENE_H
#define VOX_TESTS_SIM_SCENE_H

#include "support/suite.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <vox/vox_io.h>
#include <vox/vox_sim.h>

/* The lines that a simulation has logged, one after the other. */
typedef struct log_book {
    int lines;
    char text[4096];
} log_book;

static inline void write_log(vox_log_level level, const char* text, void* user) {
    log_book* book = (log_book*)user;
    (void)level;
    ++book->lines;
    if (strlen(book->text) + strlen(text) + 2 < sizeof book->text) strcat(strcat(book->text, text), "\n");
}

/* No gravity and no floor: bodies meet only each other. */
static inline vox_sim_desc weightless(void) {
    vox_sim_desc desc = vox_default_sim_desc();
    desc.gravity[2] = 0;
    desc.floor_normal[2] = 0;
    return desc;
}

static inline vox_sim* open_sim(const vox_sim_desc* desc) {
    vox_sim* sim = NULL;
    ck_ok(vox_sim_create(desc, &sim));
    return sim;
}

/* A copy of the mesh's positions, turned about z and moved. The caller frees it. */
static inline double* placed(const vox_io_mesh_view* view, double turn, double x, double y, double z) {
    double* positions = (double*)malloc(3 * sizeof(double) * view->vertex_count);
    for (uint64_t v = 0; v < view->vertex_count; ++v) {
        const double* p = view->positions + 3 * v;
        positions[3 * v] = cos(turn) * p[0] - sin(turn) * p[1] + x;
        positions[3 * v + 1] = sin(turn) * p[0] + cos(turn) * p[1] + y;
        positions[3 * v + 2] = p[2] + z;
    }
    return positions;
}

/* Inserts `mesh` with the settings of `like` (null: defaults). */
static inline vox_body insert(vox_sim* sim, const vox_io_mesh* mesh, const vox_sim_body_desc* like,
                              double turn, double x, double y, double z) {
    vox_sim_body_desc desc = like ? *like : vox_default_sim_body_desc();
    vox_io_mesh_view view;
    vox_body body = VOX_NULL_BODY;
    ck_ok(vox_io_mesh_get_arrays(mesh, &view));
    double* positions = placed(&view, turn, x, y, z);
    desc.positions = positions;
    desc.vertex_count = view.vertex_count;
    desc.tets = view.tets;
    desc.tet_count = view.tet_count;
    ck_ok(vox_sim_body_insert(sim, &desc, &body));
    free(positions);
    return body;
}

static inline vox_io_mesh* box(double x, double y, double z, double cell) {
    vox_io_mesh* mesh = NULL;
    ck_ok(vox_io_make_box(x, y, z, cell, &mesh));
    return mesh;
}

static inline vox_io_mesh* ball(double radius, double cell) {
    vox_io_mesh* mesh = NULL;
    ck_ok(vox_io_make_ball(radius, cell, &mesh));
    return mesh;
}

static inline vox_sim_body_view view_of(const vox_sim* sim, vox_body body) {
    vox_sim_body_view view;
    ck_ok(vox_sim_body_get_view(sim, body, &view));
    return view;
}

static inline void set_velocity(vox_sim* sim, vox_body body, double x, double y, double z) {
    const vox_sim_body_view view = view_of(sim, body);
    double* velocities = (double*)malloc(3 * sizeof(double) * view.vertex_count);
    for (uint64_t v = 0; v < view.vertex_count; ++v) {
        velocities[3 * v] = x;
        velocities[3 * v + 1] = y;
        velocities[3 * v + 2] = z;
    }
    ck_ok(vox_sim_body_set_state(sim, body, NULL, velocities));
    free(velocities);
}

static inline vox_sim_energy energy_of(const vox_sim* sim, vox_body body) {
    vox_sim_energy energy;
    ck_ok(vox_sim_get_energy(sim, body, &energy));
    return energy;
}

static inline double total(const vox_sim_energy* e) { return e->kinetic + e->potential + e->elastic; }

static inline uint64_t counter(const vox_sim* sim, const char* name) {
    vox_counter_view view;
    ck_ok(vox_sim_get_counters(sim, &view));
    for (uint64_t i = 0; i < view.count; ++i)
        if (strcmp(view.data[i].name, name) == 0) return view.data[i].value;
    ck_abort_msg("no counter %s", name);
    return 0;
}

static inline void steps(vox_sim* sim, int count) {
    for (int i = 0; i < count; ++i) ck_ok(vox_sim_step(sim, 1.0 / 60));
}

/* All positions and velocities of the body are finite. */
static inline void ck_finite(const vox_sim* sim, vox_body body) {
    const vox_sim_body_view view = view_of(sim, body);
    for (uint64_t i = 0; i < 3 * view.vertex_count; ++i)
        ck_assert(isfinite(view.positions[i]) && isfinite(view.velocities[i]));
}

#endif
