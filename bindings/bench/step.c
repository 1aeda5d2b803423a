/* Steps the scene of a file. For every line on stdin with a number of passes it prints a line: a sum of the
 * hashes of all frames, then for each frame the least nanoseconds of a step and of reading all contacts.
 * Positions are written in between, which is not timed. The programs in the other languages do the same.
 * usage: step SCENE */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <vox/vox.h>

static uint64_t now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

static void check(vox_result result) {
    if (result == VOX_OK) return;
    fprintf(stderr, "%s\n", vox_last_error());
    exit(1);
}

int main(int argc, char** argv) {
    static uint32_t words[1 << 20];
    FILE* in = argc == 2 ? fopen(argv[1], "rb") : NULL;
    if (!in || fread(words, 4, sizeof words / 4, in) < 2) return fprintf(stderr, "usage: step SCENE\n"), 1;
    fclose(in);
    const uint32_t bodies = words[0], frames = words[1];
    const uint32_t *counts = words + 2, *tets = counts + 2 * bodies, *positions = tets;
    for (uint32_t b = 0; b < bodies; ++b) positions += 4 * counts[2 * b + 1];

    vox_grid* grid;
    vox_body* meshes = (vox_body*)malloc(bodies * sizeof *meshes);
    check(vox_grid_create(NULL, &grid));
    const uint32_t* xyz = positions;
    for (uint32_t b = 0; b < bodies; ++b) {
        vox_mesh_desc desc = vox_mesh_desc_floats((const float*)xyz, counts[2 * b], tets, counts[2 * b + 1]);
        desc.flags = VOX_MESH_COPY_POSITIONS;
        check(vox_mesh_insert(grid, &desc, &meshes[b]));
        xyz += 3 * counts[2 * b];
        tets += 4 * counts[2 * b + 1];
    }

    char line[32];
    uint64_t* least = (uint64_t*)malloc(2 * frames * sizeof *least);
    while (fgets(line, sizeof line, stdin)) {
        uint64_t hashes = 0, read = 0;
        memset(least, 0xff, 2 * frames * sizeof *least);
        for (int pass = atoi(line); pass > 0; --pass) {
            xyz = positions;
            for (uint32_t f = 0; f < frames; ++f) {
                for (uint32_t b = 0; b < bodies; ++b) {
                    void* at;
                    check(vox_mesh_map_positions(grid, meshes[b], &at));
                    memcpy(at, xyz, 12 * (size_t)counts[2 * b]);
                    xyz += 3 * counts[2 * b];
                }
                const uint64_t begin = now();
                check(vox_grid_step(grid));
                const uint64_t stepped = now();
                vox_contact_view contacts;
                check(vox_grid_get_contacts(grid, &contacts));
                for (uint64_t i = 0; i < contacts.count; ++i) read += contacts.data[i].vertex;
                const uint64_t end = now();
                if (stepped - begin < least[2 * f]) least[2 * f] = stepped - begin;
                if (end - stepped < least[2 * f + 1]) least[2 * f + 1] = end - stepped;
                uint64_t hash;
                check(vox_grid_get_hash(grid, &hash));
                hashes += hash;
            }
        }
        printf("%016" PRIx64, hashes + read);
        for (uint32_t i = 0; i < 2 * frames; ++i) printf(" %" PRIu64, least[i]);
        printf("\n");
        fflush(stdout);
    }
    free(least);
    free(meshes);
    vox_grid_destroy(grid);
    return 0;
}
