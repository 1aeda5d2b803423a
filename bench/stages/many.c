/* Many small scenes on one core: 4096 grids of two bodies of 1000 tetrahedra each, which move in every frame,
 * stepped by a loop in C and by one call of vox_grids_step. See bench/README.md.
 *
 *     bench_many [SCENES] [ROUNDS] */
#include "../timing.h"
#include "scenes/counters.h"

#include "scenes/bodies.h"

#include <stdio.h>
#include <stdlib.h>

enum { FRAMES = 8 }; /* of positions, which the scenes go through */

typedef struct scene {
    vox_grid* grid;
    vox_body meshes[2];
    uint32_t first_frame;
} scene;

/* Two blocks of 10 by 10 by 2 cubes, one `aside` cubes to the side of the other; frame after frame, the upper
 * one goes down into the other, and all of both quivers. */
static body blocks[2][FRAMES];

static void make_blocks(float aside) {
    uint32_t random = 1;
    for (int b = 0; b < 2; ++b)
        for (int f = 0; f < FRAMES; ++f) {
            blocks[b][f] = make_block(&five_cut, 10, 10, 2);
            for (uint32_t i = 0; i < 3 * blocks[b][f].vertex_count; ++i) {
                float* x = blocks[b][f].positions + i;
                *x += ((float)(random_quick(&random) >> 16) / 65536.0f - 0.5f) * 0.3f;
                if (b && i % 3 == 2) *x += 2.0f - 0.1f * (float)f;
                if (b && i % 3 == 0) *x += aside;
            }
        }
}

static void show(scene* scenes, uint32_t count, uint32_t frame) {
    for (uint32_t s = 0; s < count; ++s)
        for (int b = 0; b < 2; ++b) {
            const body* now = &blocks[b][(scenes[s].first_frame + frame) % FRAMES];
            check(
                vox_mesh_bind_floats(scenes[s].grid, scenes[s].meshes[b], now->positions, now->vertex_count));
        }
}

static uint64_t contacts_of(const scene* scenes, uint32_t count) {
    uint64_t all = 0;
    for (uint32_t s = 0; s < count; ++s) {
        vox_contact_view view;
        check(vox_grid_get_contacts(scenes[s].grid, &view));
        all += view.count;
    }
    return all;
}

static void run(const char* name, uint32_t flags, uint32_t count, uint32_t rounds) {
    scene* scenes = (scene*)calloc(count, sizeof *scenes);
    vox_grid** grids = (vox_grid**)calloc(count, sizeof *grids);
    if (!scenes || !grids) exit(EXIT_FAILURE);
    for (uint32_t s = 0; s < count; ++s) {
        vox_grid_desc desc = vox_default_grid_desc();
        desc.flags = flags;
        check(vox_grid_create(&desc, &scenes[s].grid));
        grids[s] = scenes[s].grid;
        scenes[s].first_frame = s % FRAMES;
        for (int b = 0; b < 2; ++b) {
            const body* shape = &blocks[b][scenes[s].first_frame];
            vox_mesh_desc mesh =
                vox_mesh_desc_floats(shape->positions, shape->vertex_count, shape->tets, shape->tet_count);
            mesh.flags = VOX_MESH_BORROW_TETS;
            check(vox_mesh_insert(scenes[s].grid, &mesh, &scenes[s].meshes[b]));
        }
    }
    double loop = 1e9, batch = 1e9;
    uint64_t contacts[2] = {0, 0};
    for (uint32_t round = 0; round < 2 * rounds + 2;
         ++round) { /* the first of each is not timed; both see the same frames */
        show(scenes, count, round / 2);
        const double start = now();
        if (round % 2 == 0)
            for (uint32_t s = 0; s < count; ++s) check(vox_grid_step(grids[s]));
        else
            check(vox_grids_step(grids, count, 1, NULL, NULL));
        const double seconds = now() - start;
        contacts[round % 2] += contacts_of(scenes, count);
        if (round >= 2 && round % 2 == 0 && seconds < loop) loop = seconds;
        if (round >= 2 && round % 2 == 1 && seconds < batch) batch = seconds;
        /* Bodies at rest would cost next to nothing, so the frame between is neither this one nor the next.
         */
        show(scenes, count, round / 2 + FRAMES / 2);
        for (uint32_t s = 0; s < count; ++s) check(vox_grid_step(grids[s]));
    }
    if (contacts[0] != contacts[1]) {
        fprintf(stderr, "the loop finds %llu contacts, the call %llu\n", (unsigned long long)contacts[0],
                (unsigned long long)contacts[1]);
        exit(EXIT_FAILURE);
    }
    uint64_t bytes = 0;
    for (uint32_t s = 0; s < count; ++s) {
        grid_counts counters;
        counters = counters_of(grids[s]);
        bytes += counters.bytes;
    }
    printf("%-26s %8.1f contacts a scene  %10.0f scene-steps/s in a loop  %10.0f in one call  %+5.1f %%  "
           "%6.0f MB of grids\n",
           name, (double)contacts[0] / (rounds + 1) / count, count / loop, count / batch,
           100 * (batch / loop - 1), (double)bytes / 1e6);
    for (uint32_t s = 0; s < count; ++s) vox_grid_destroy(grids[s]);
    free(grids);
    free(scenes);
}

int main(int argc, char** argv) {
    const uint32_t count = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : 4096;
    const uint32_t rounds = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : 9;
    for (int aside = 2; aside < 10; aside += 3) {
        make_blocks((float)aside);
        run("contacts", 0, count, rounds);
        run("constraints", VOX_GRID_CONSTRAINTS, count, rounds);
        for (int b = 0; b < 2; ++b)
            for (int f = 0; f < FRAMES; ++f) free_body(&blocks[b][f]);
    }
    return 0;
}
