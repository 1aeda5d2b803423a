/* What an edit costs: so many tetrahedra at a time are switched off, given other corners, and switched on
 * again, in a body with self-collision, with and without the step that follows. Mean processor time of one
 * edit in microseconds: some of them rebuild what they usually repair. Beside it what a new insertion
 * of the body takes. Usage: bench_cutting [largest], thousands of tetrahedra, 1000 by default. */
#include "scenes/bodies.h"
#include "scenes/random.h"
#include "timing.h"

enum { most_changed = 1000, kinds = 3 };

/* Microseconds of an edit of `changed` tets, by kind; steps[0] is the step after one, steps[1] one without
 * edit. */
static void measure(vox_grid* grid, vox_body mesh, const body* box, uint32_t changed, double* micros,
                    double* steps) {
    static uint32_t tets[most_changed], corners[4 * most_changed];
    uint64_t random = 1;
    const int rounds = changed < 100 ? 300 : 60, stepped = 6;
    double spent[kinds] = {0, 0, 0}, step[2] = {0, 0};
    for (int round = 0; round < rounds; ++round) {
        const uint32_t first = random_below(&random, box->tet_count - changed);
        for (uint32_t i = 0; i < changed; ++i) {
            tets[i] = first + i;
            for (uint32_t c = 0; c < 4; ++c) /* turned inside out: the same facets */
                corners[4 * i + c] = box->tets[4 * tets[i] + (c < 2 ? c : 5 - c)];
        }
        double t[kinds + 1];
        t[0] = now();
        check(vox_mesh_set_tets_enabled(grid, mesh, tets, changed, 0));
        t[1] = now();
        check(vox_mesh_set_tets_enabled(grid, mesh, tets, changed, 1));
        t[2] = now();
        check(vox_mesh_replace_tets(grid, mesh, tets, changed, corners));
        t[3] = now();
        check(vox_mesh_replace_tets(grid, mesh, tets, changed, box->tets + 4 * first));
        for (int k = 0; k < kinds; ++k) spent[k] += t[k + 1] - t[k];
        if (round >= stepped) continue;
        for (int k = 0; k < 2; ++k) {
            const double start = now();
            check(vox_body_mark_moved(grid, mesh));
            check(vox_grid_step(grid));
            step[k] += now() - start;
        }
    }
    for (int k = 0; k < kinds; ++k) micros[k] = 1e6 * spent[k] / rounds;
    for (int k = 0; k < 2; ++k) steps[k] = 1e6 * step[k] / stepped;
}

int main(int argc, char** argv) {
    const uint32_t largest = argc > 1 ? (uint32_t)atoi(argv[1]) : 1000;
    static const uint32_t sides[] = {13, 27, 58}; /* 11, 98 and 976 thousand tetrahedra */
    static const uint32_t changes[] = {1, 10, 100, 1000};
    printf("%9s %8s %10s %10s %10s %10s %10s %10s\n", "tets", "changed", "off us", "on us", "replace us",
           "step us", "no edit us", "insert us");
    for (size_t s = 0; s < sizeof sides / sizeof *sides; ++s) {
        body box = make_box(sides[s], 1, 0, 0, 0);
        if (s > 0 && box.tet_count > 1000 * largest) {
            free_body(&box);
            break;
        }
        for (size_t c = 0; c < sizeof changes / sizeof *changes; ++c) {
            vox_grid* grid = NULL;
            vox_body mesh = VOX_NULL_BODY;
            vox_mesh_desc desc = body_desc(&box);
            double micros[kinds], steps[2];
            const uint32_t none = 0;
            desc.filter.flags = VOX_FILTER_SELF_COLLISION;
            check(vox_grid_create(NULL, &grid));
            const double start = now();
            check(vox_mesh_insert(grid, &desc, &mesh));
            const double inserted = now() - start;
            check(vox_mesh_set_tets_enabled(grid, mesh, &none, 1,
                                            0)); /* the first is in proportion to the mesh */
            check(vox_mesh_set_tets_enabled(grid, mesh, &none, 1, 1));
            check(vox_grid_step(grid));
            measure(grid, mesh, &box, changes[c], micros, steps);
            printf("%9u %8u %10.1f %10.1f %10.1f %10.0f %10.0f %10.0f\n", box.tet_count, changes[c],
                   micros[0], micros[1], micros[2], steps[0], steps[1], 1e6 * inserted);
            fflush(stdout);
            vox_grid_destroy(grid);
        }
        free_body(&box);
    }
    return 0;
}
