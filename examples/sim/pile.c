/* Bodies dropped in a pile, frame by frame as .vtu files: docs/pile.webp is made from them, and ParaView
 * opens them.
 *
 *     example_pile FOLDER [FRAMES]
 *
 * Balls, boxes, rings and capsules of about a thousand tetrahedra each fall into a fixed ring. Every file
 * holds all tetrahedra, with the number of its body (0: the fixed ring) at each vertex. */
#include "example.h"

#include <math.h>
#include <stdlib.h>
#include <vox/vox_io.h>
#include <vox/vox_sim.h>

#define BODIES 29 /* the fixed ring is the first */
#define STEPS_PER_SECOND 60
#define STEPS_PER_FRAME 2

typedef struct scene {
    vox_sim* sim;
    vox_body bodies[BODIES];
    uint64_t vertex_count;
    uint64_t tet_count;
} scene;

/* Numbers in [-1, 1) that are the same on every machine. */
static double scatter(uint32_t* seed) { return (double)(random_quick(seed) >> 8) / 8388608.0 - 1; }

/* Inserts `mesh`, turned by `tilt` about x and `turn` about z, at (x, y, z). Takes the mesh. */
static vox_body drop(scene* s, vox_io_mesh* mesh, double tilt, double turn, double x, double y, double z,
                     uint32_t flags) {
    vox_io_mesh_view view;
    must(vox_io_mesh_get_arrays(mesh, &view));
    double* positions = malloc(3 * sizeof *positions * view.vertex_count);
    if (!positions) exit(1);
    for (uint64_t v = 0; v < view.vertex_count; ++v) {
        const double* p = view.positions + 3 * v;
        const double q[3] = {p[0], cos(tilt) * p[1] - sin(tilt) * p[2], sin(tilt) * p[1] + cos(tilt) * p[2]};
        positions[3 * v] = cos(turn) * q[0] - sin(turn) * q[1] + x;
        positions[3 * v + 1] = sin(turn) * q[0] + cos(turn) * q[1] + y;
        positions[3 * v + 2] = q[2] + z;
    }
    vox_sim_body_desc desc = vox_default_sim_body_desc();
    desc.flags = flags;
    desc.positions = positions;
    desc.vertex_count = view.vertex_count;
    desc.tets = view.tets;
    desc.tet_count = view.tet_count;
    desc.youngs_modulus = 2e5;
    desc.bulk_modulus = 2e5;
    desc.damping = 0.05;
    vox_body body;
    must(vox_sim_body_insert(s->sim, &desc, &body));
    free(positions);
    vox_io_mesh_destroy(mesh);
    s->vertex_count += view.vertex_count;
    s->tet_count += view.tet_count;
    return body;
}

static void make_scene(scene* s) {
    vox_sim_desc desc = vox_default_sim_desc();
    desc.friction = 0.6;
    must(vox_sim_create(&desc, &s->sim));
    s->vertex_count = s->tet_count = 0;
    vox_io_mesh* mesh;
    must(vox_io_make_torus(2.3, 0.45, 0.25, &mesh));
    s->bodies[0] = drop(s, mesh, 0, 0, 0, 0, 0.35, VOX_SIM_BODY_FIXED);
    uint32_t seed = 7;
    for (int i = 1; i < BODIES; ++i) {
        switch (i % 4) {
        case 0:
            must(vox_io_make_ball(0.5, 0.16, &mesh));
            break;
        case 1:
            must(vox_io_make_box(0.9, 0.7, 0.6, 0.15, &mesh));
            break;
        case 2:
            must(vox_io_make_torus(0.48, 0.2, 0.13, &mesh));
            break;
        default:
            must(vox_io_make_capsule(0.28, 0.75, 0.14, &mesh));
            break;
        }
        /* Layers of four, each turned against the one below. */
        const int layer = (i - 1) / 4;
        const double angle = 1.5708 * i + 0.6 * layer, tilt = 1.5 * scatter(&seed), turn = 3 * scatter(&seed);
        const double x = 0.95 * cos(angle) + 0.05 * scatter(&seed),
                     y = 0.95 * sin(angle) + 0.05 * scatter(&seed);
        s->bodies[i] = drop(s, mesh, tilt, turn, x, y, 0.8 + 1.2 * layer, 0);
    }
}

/* All bodies in one .vtu file. */
static void write_frame(const scene* s, const char* folder, int frame) {
    double* positions = malloc(3 * sizeof *positions * s->vertex_count);
    double* body_of_vertex = malloc(sizeof *body_of_vertex * s->vertex_count);
    uint32_t* tets = malloc(4 * sizeof *tets * s->tet_count);
    if (!positions || !body_of_vertex || !tets) exit(1);
    uint64_t vertices = 0, tet_count = 0;
    for (int b = 0; b < BODIES; ++b) {
        vox_sim_body_view view;
        must(vox_sim_body_get_view(s->sim, s->bodies[b], &view));
        for (uint64_t i = 0; i < 4 * view.tet_count; ++i)
            tets[4 * tet_count + i] = (uint32_t)vertices + view.tets[i];
        for (uint64_t i = 0; i < 3 * view.vertex_count; ++i) positions[3 * vertices + i] = view.positions[i];
        for (uint64_t i = 0; i < view.vertex_count; ++i) body_of_vertex[vertices + i] = b;
        vertices += view.vertex_count;
        tet_count += view.tet_count;
    }
    const vox_io_mesh_view all = {positions, vertices, tets, tet_count, NULL, 0, NULL, NULL, NULL};
    const vox_io_point_data body = {"body", body_of_vertex, 1, 0};
    vox_io_mesh* mesh;
    must(vox_io_mesh_create(&all, &mesh));
    vox_io_write_desc desc = vox_default_io_write_desc();
    desc.binary = 1;
    desc.point_data = &body;
    desc.point_data_count = 1;
    char path[1024];
    snprintf(path, sizeof path, "%s/pile_%04d.vtu", folder, frame);
    must(vox_io_write(mesh, path, &desc));
    vox_io_mesh_destroy(mesh);
    free(positions);
    free(body_of_vertex);
    free(tets);
}

static uint64_t counter(const vox_sim* sim, const char* name) {
    vox_counter_view view;
    must(vox_sim_get_counters(sim, &view));
    for (uint64_t i = 0; i < view.count; ++i)
        if (strcmp(view.data[i].name, name) == 0) return view.data[i].value;
    return 0;
}

int main(int argc, char** argv) {
    if (argc < 2) {
        fprintf(stderr, "usage: %s FOLDER [FRAMES]\n", argv[0]);
        return 2;
    }
    const int frames = argc > 2 ? atoi(argv[2]) : 150;
    scene s;
    make_scene(&s);
    printf("%d bodies, %llu tets\n", BODIES - 1, (unsigned long long)s.tet_count);
    for (int frame = 0; frame < frames; ++frame) {
        write_frame(&s, argv[1], frame);
        for (int i = 0; i < STEPS_PER_FRAME; ++i) must(vox_sim_step(s.sim, 1.0 / STEPS_PER_SECOND));
        vox_sim_energy energy;
        must(vox_sim_get_energy(s.sim, VOX_NULL_BODY, &energy));
        if (frame % 10 == 0 || frame == frames - 1)
            printf("frame %3d: %5llu constraints, fastest particle %5.2f, step %6.2f ms of which detection "
                   "%6.2f ms\n",
                   frame, (unsigned long long)counter(s.sim, "constraints"), energy.max_speed,
                   1e-6 * (double)counter(s.sim, "step_ns"), 1e-6 * (double)counter(s.sim, "detect_ns"));
        fflush(stdout);
    }
    vox_sim_destroy(s.sim);
    return 0;
}
