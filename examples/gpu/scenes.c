/* Two scenes at once, by vox_gpu.h. Link vox_cuda and give pointers to a GPU's memory, or link vox_gpu_host
 * as here: its device memory is the program's own. */
#include <stdio.h>
#include <vox/vox_gpu.h>

int main(void) {
    static const uint32_t tet[4] = {0, 1, 2, 3};
    static const float rest[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    vox_grid* grid = NULL;
    vox_gpu* gpu = NULL;
    vox_gpu_view view;
    vox_body body;
    /* A scene: two tetrahedra. Both scenes have the same. */
    const vox_mesh_desc desc = vox_mesh_desc_floats(rest, 4, tet, 1);
    int ok = vox_grid_create(NULL, &grid) == VOX_OK && vox_mesh_insert(grid, &desc, &body) == VOX_OK &&
             vox_mesh_insert(grid, &desc, &body) == VOX_OK;
    const vox_grid* scenes[2] = {grid, grid};
    ok = ok && vox_gpu_create(NULL, scenes, 2, &gpu) == VOX_OK;
    vox_grid_destroy(grid); /* was read */

    /* Where the vertices of all scenes are; the second tetrahedron of the second scene is far away. */
    float positions[48];
    for (int i = 0; i < 48; ++i)
        positions[i] = rest[i % 12] + (i / 12 == 1 ? 0.2f : i / 12 == 3 ? 5.0f : 0.0f);
    const vox_positions all = vox_float_positions(positions, 16);
    ok = ok && vox_gpu_bind_positions(gpu, &all) == VOX_OK;
    for (int step = 0; ok && step < 3; ++step) {
        positions[12] += 0.1f; /* a kernel of the simulation, in the same stream */
        ok = vox_gpu_step(gpu, NULL) == VOX_OK;
    }
    ok = ok && vox_gpu_finish(gpu, NULL) == VOX_OK && vox_gpu_get_view(gpu, &view) == VOX_OK;
    for (uint32_t s = 0; ok && s < 2; ++s)
        for (uint32_t i = view.scene_offsets[s]; i < view.scene_offsets[s + 1]; ++i)
            printf("scene %u: vertex %u of body %u is in body %u, weight %.2f of its first corner\n", s,
                   view.contacts[i].vertex, view.contacts[i].body_a, view.contacts[i].body_b,
                   (double)view.weights[4 * i]);
    if (!ok) fprintf(stderr, "%s\n", vox_last_error());
    vox_gpu_destroy(gpu);
    return ok ? 0 : 1;
}
