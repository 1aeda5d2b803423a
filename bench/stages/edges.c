/* What constraints of edges and within a margin cost: each scene in a grid with constraints of vertices
 * inside alone, in one with VOX_GRID_EDGES and in one with a margin of half an edge, stepped in turn over the
 * same positions, all of which move; the ratio of their lower quartiles of processor time. Usage: bench_edges
 * [frames [tetrahedra of a ball [scene]]], 40, 500000 and every scene by default. */
#include "scenes/counters.h"
#include "scenes/scenes.h"
#include "scenes/solids.h"
#include "timing.h"

#include <stdbool.h>

enum { WITHOUT, WITH, MARGIN, VARIANTS };

typedef struct variant {
    vox_grid* grid;
    double* seconds;
    double* part;
} variant;

static body ball_of(double tets, uint64_t seed) {
    solid s = make_solid_ball(tets, seed);
    body b = {(float*)malloc(3 * sizeof(float) * s.vertex_count), s.tets, s.vertex_count, s.tet_count};
    for (uint32_t i = 0; i < 3 * s.vertex_count; ++i) b.positions[i] = (float)s.positions[i];
    free(s.positions);
    return b;
}

/* Two balls whose centres are `apart` radii from each other. */
static void make_balls(scene* s, double tets, double apart) {
    const double radius = solid_ball_radius(tets);
    s->amplitude = 0.002 * radius;
    s->wave_length = 2 * radius;
    for (int i = 0; i < 2; ++i) {
        body b = ball_of(tets, (uint64_t)i + 1);
        move_body(&b, apart * radius * i, 0.0123 * radius * i, 0.0271 * radius * i);
        add_body(s, b);
    }
}

static int ascending(const void* a, const void* b) {
    const double x = *(const double*)a, y = *(const double*)b;
    return (x > y) - (x < y);
}

static double quartile(double* seconds, int frames) {
    qsort(seconds, (size_t)frames, sizeof *seconds, ascending);
    return seconds[frames / 4];
}

static const double margin = 0.5; /* the edges of all scenes are about 1 long */

static void measure(scene* s, const char* name, int frames) {
    variant variants[VARIANTS];
    grid_counts counters;
    grid_times profile;
    for (int k = 0; k < VARIANTS; ++k) {
        vox_grid_desc desc = vox_default_grid_desc();
        desc.flags = k == WITH ? VOX_GRID_CONSTRAINTS | VOX_GRID_EDGES : VOX_GRID_CONSTRAINTS;
        if (k == MARGIN) desc.margin = margin;
        check(vox_grid_create(&desc, &variants[k].grid));
        variants[k].seconds = (double*)malloc(sizeof(double) * (size_t)frames);
        variants[k].part = (double*)malloc(sizeof(double) * (size_t)frames);
        for (uint32_t i = 0; i < s->count; ++i) {
            vox_mesh_desc mesh = body_desc(&s->bodies[i]);
            vox_body id;
            mesh.filter.flags = s->self_collision ? VOX_FILTER_SELF_COLLISION : 0;
            check(vox_mesh_insert(variants[k].grid, &mesh, &id));
        }
    }
    for (int frame = -2; frame < frames; ++frame) {
        pose_scene(s, frame + 2);
        for (int i = 0; i < VARIANTS; ++i) {
            const int k = (i + frame + 2) % VARIANTS; /* in another order each time */
            const double start = now();
            check(vox_grid_step(variants[k].grid));
            const double end = now();
            if (frame < 0) continue;
            variants[k].seconds[frame] = end - start;
            profile = times_of(variants[k].grid);
            variants[k].part[frame] = 1e-9 * (double)(k == MARGIN ? profile.margin_ns : profile.edges_ns);
        }
    }
    counters = counters_of(variants[WITH].grid);
    const double without = quartile(variants[WITHOUT].seconds, frames),
                 with = quartile(variants[WITH].seconds, frames),
                 edges = quartile(variants[WITH].part, frames),
                 near = quartile(variants[MARGIN].seconds, frames);
    printf("%-8s %8.3f ms without, %8.3f with: %.3f; %.3f of it edges; %llu contacts, %llu edges through "
           "faces of %llu candidates\n",
           name, 1e3 * without, 1e3 * with, with / without, 1e3 * edges,
           (unsigned long long)counters.contacts, (unsigned long long)counters.edge_contacts,
           (unsigned long long)counters.edge_candidates);
    counters = counters_of(variants[MARGIN].grid);
    printf("         margin %g: %8.3f ms: %.3f; %.3f of it margin; %llu vertices within it\n", margin,
           1e3 * near, near / without, 1e3 * quartile(variants[MARGIN].part, frames),
           (unsigned long long)counters.proximities);
    fflush(stdout);
    for (int k = 0; k < VARIANTS; ++k) {
        vox_grid_destroy(variants[k].grid);
        free(variants[k].seconds);
        free(variants[k].part);
    }
    free_scene(s);
    memset(s, 0, sizeof *s);
}

int main(int argc, char** argv) {
    const int frames = argc > 1 ? atoi(argv[1]) : 40;
    const double tets = argc > 2 ? atof(argv[2]) : 500000;
    const char* const names[] = {"light", "overlap", "percent", "deep", "self", "many"};
    const double apart[] = {1.98, 1.85, 1.6, 1}; /* the third: 1 % of the tetrahedra are in contact */
    enum { BALLS = sizeof apart / sizeof *apart };
    static scene s;
    if (frames < 1 || !(tets >= 1000)) return 2;
    bool found = false;
    for (int i = 0; i < BALLS + 2; ++i) {
        if (argc > 3 && strcmp(argv[3], names[i]) != 0) continue;
        if (i < BALLS)
            make_balls(&s, tets, apart[i]);
        else if (i == BALLS)
            make_self(&s, 22);
        else
            make_many(&s, 5, 8);
        measure(&s, names[i], frames);
        found = true;
    }
    return found ? EXIT_SUCCESS : 2;
}
