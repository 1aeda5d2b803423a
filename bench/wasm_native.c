/* The native side of bench/wasm.mjs: prints the least time of a step, in milliseconds, and the hash of the last one.
 * usage: wasm_native SCENE OFFSET STEPS */
#include <vox/vox.h>

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static void check(vox_result result) {
    if (result == VOX_OK) return;
    fprintf(stderr, "%s\n", vox_last_error());
    exit(1);
}

static double now_ms(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

int main(int argc, char** argv) {
    if (argc != 4) return 2;
    FILE* const file = fopen(argv[1], "rb");
    uint32_t counts[2];
    if (!file || fread(counts, 4, 2, file) != 2) return 2;
    float* const positions = malloc(12 * (size_t)counts[0]);
    uint32_t* const tets = malloc(16 * (size_t)counts[1]);
    if (!positions || !tets || fread(positions, 12, counts[0], file) != counts[0] ||
        fread(tets, 16, counts[1], file) != counts[1])
        return 2;
    fclose(file);

    vox_grid* grid;
    vox_mesh still, body;
    const vox_mesh_desc desc = vox_mesh_desc_floats(positions, counts[0], tets, counts[1]);
    check(vox_grid_create(NULL, &grid));
    check(vox_mesh_insert(grid, &desc, &still));
    check(vox_mesh_insert(grid, &desc, &body));
    double least = 1e300;
    for (int i = 0; i < atoi(argv[3]); ++i) {
        const double matrix[12] = {1, 0, 0, atof(argv[2]) + 0.001 * (i % 2), 0, 1, 0, 0.013, 0, 0, 1, 0.017};
        check(vox_mesh_set_transform(grid, body, matrix));
        const double began = now_ms();
        check(vox_grid_step(grid));
        const double took = now_ms() - began;
        if (took < least) least = took;
    }
    uint64_t hash;
    check(vox_grid_hash(grid, &hash));
    printf("%.6f %016llx\n", least, (unsigned long long)hash);
    vox_grid_destroy(grid);
    free(positions);
    free(tets);
    return 0;
}
