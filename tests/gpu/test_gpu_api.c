/* vox_gpu.h from C, by the library that runs on the processor: the same contacts as a grid's step. */
#include "scenes/bodies.h"
#include "support/suite.h"

#include <math.h>
#include <vox/vox_gpu.h>

typedef struct pair {
    vox_grid* grid;
    body bodies[2];
    vox_body ids[2];
    float* packed; /* positions of both */
    uint64_t count;
} pair;

static pair make_pair_of_balls(void) {
    pair p;
    p.grid = grid_of(NULL);
    p.count = 0;
    for (uint64_t b = 0; b < 2; ++b) {
        p.bodies[b] = make_lattice_ball(&five_cut, 3, 3);
        jitter_body(&p.bodies[b], 0.1, b + 1);
        move_body(&p.bodies[b], 2.0 * (double)b, 1.0 * (double)b, 0);
        const vox_mesh_desc desc = body_desc(&p.bodies[b]);
        p.ids[b] = insert_mesh(p.grid, &desc);
        p.count += p.bodies[b].vertex_count;
    }
    p.packed = (float*)malloc(3 * sizeof(float) * p.count);
    for (uint64_t b = 0, n = 0; b < 2; n += 3 * p.bodies[b++].vertex_count)
        memcpy(p.packed + n, p.bodies[b].positions, 3 * sizeof(float) * p.bodies[b].vertex_count);
    return p;
}

static void free_pair(pair* p) {
    vox_grid_destroy(p->grid);
    for (int b = 0; b < 2; ++b) free_body(&p->bodies[b]);
    free(p->packed);
}

static vox_gpu* gpu_of(const vox_gpu_desc* desc, const pair* p) {
    const vox_grid* grids[2];
    vox_gpu* gpu = NULL;
    grids[0] = grids[1] = p->grid;
    ck_ok(vox_gpu_create(desc, grids, 2, &gpu));
    return gpu;
}

/* Both scenes have the contacts of the grid. */
static void check_contacts_of(vox_gpu* gpu, const pair* p) {
    vox_gpu_view view;
    ck_ok(vox_grid_step(p->grid));
    const vox_contact_view expected = contacts_of(p->grid);
    ck_assert_uint_gt(expected.count, 50);
    ck_ok(vox_gpu_get_view(gpu, &view));
    ck_assert_uint_eq(view.status->contact_count, 2 * expected.count);
    for (uint32_t scene = 0; scene < 2; ++scene) {
        const uint32_t first = view.scene_offsets[scene];
        ck_assert_uint_eq(view.scene_offsets[scene + 1] - first, expected.count);
        ck_assert(memcmp(view.contacts + first, expected.data, expected.count * sizeof *expected.data) == 0);
        ck_assert(memcmp(view.interiors + first, expected.interiors, expected.count) == 0);
        for (uint64_t i = 0; i < expected.count; ++i) {
            const float* w = view.weights + 4 * (first + i);
            ck_assert(fabs((double)w[0] + (double)w[1] + (double)w[2] + (double)w[3] - 1) < 1e-6);
        }
    }
}

START_TEST(steps) {
    pair p = make_pair_of_balls();
    vox_gpu_desc desc = vox_default_gpu_desc();
    vox_gpu_status status;
    desc.contact_capacity = 3;
    vox_gpu* gpu = gpu_of(&desc, &p);
    ck_fails(vox_gpu_step(gpu, NULL), VOX_ERROR_INVALID_STATE, "have no positions");
    /* Two scenes: the positions of one after the other. */
    float* both = (float*)malloc(2 * 3 * sizeof(float) * p.count);
    for (int scene = 0; scene < 2; ++scene)
        memcpy(both + 3 * p.count * (uint64_t)scene, p.packed, 3 * sizeof(float) * p.count);
    vox_positions positions = vox_float_positions(both, 2 * p.count);
    ck_ok(vox_gpu_bind_positions(gpu, &positions));
    ck_ok(vox_gpu_step(gpu, NULL));
    ck_fails(vox_gpu_finish(gpu, &status), VOX_ERROR_LIMIT, "step again");
    ck_assert(status.contact_count == 0 && (status.faults & VOX_GPU_FAULT_CONTACTS));
    ck_ok(vox_gpu_step(gpu, NULL));
    ck_ok(vox_gpu_finish(gpu, &status));
    ck_assert_uint_eq(status.faults, 0);
    check_contacts_of(gpu, &p);
    both[3 * (p.count + p.bodies[0].vertex_count + 4)] = NAN;
    ck_ok(vox_gpu_step(gpu, NULL));
    ck_fails(vox_gpu_finish(gpu, NULL), VOX_ERROR_NON_FINITE, "vertex 4 of body");
    vox_gpu_destroy(gpu);
    free(both);
    free_pair(&p);
}
END_TEST

START_TEST(refuses) {
    pair p = make_pair_of_balls();
    const vox_grid* grids[1];
    vox_gpu* gpu = NULL;
    vox_gpu_desc desc = vox_default_gpu_desc();
    vox_positions positions = vox_float_positions(p.packed, p.count);
    grids[0] = p.grid;
    desc.cell_size = NAN;
    ck_fails(vox_gpu_create(&desc, grids, 1, &gpu), VOX_ERROR_INVALID_ARGUMENT, "cell_size is nan");
    desc = vox_default_gpu_desc();
    desc.byte_budget = 1000;
    ck_fails(vox_gpu_create(&desc, grids, 1, &gpu), VOX_ERROR_BUDGET, "budget of 1000 bytes");
    desc = vox_default_gpu_desc();
    desc.device = 1;
    ck_fails(vox_gpu_create(&desc, grids, 1, &gpu), VOX_ERROR_UNSUPPORTED, "device 1");
    ck_fails(vox_gpu_create(NULL, NULL, 1, &gpu), VOX_ERROR_INVALID_ARGUMENT, "grids is null");
    ck_fails(vox_gpu_create(NULL, grids, 1, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_gpu is null");
    ck_assert(gpu == NULL);
    gpu = gpu_of(NULL, &p);
    ck_fails(vox_gpu_bind_positions(gpu, &positions), VOX_ERROR_INVALID_ARGUMENT, "positions->count is");
    positions.count *= 2;
    positions.format = VOX_FORMAT_DOUBLE;
    ck_fails(vox_gpu_bind_positions(gpu, &positions), VOX_ERROR_UNSUPPORTED, "floats");
    positions.format = VOX_FORMAT_FLOAT;
    positions.byte_stride = 8;
    ck_fails(vox_gpu_bind_positions(gpu, &positions), VOX_ERROR_INVALID_ARGUMENT, "byte_stride is 8");
    ck_fails(vox_gpu_step(NULL, NULL), VOX_ERROR_INVALID_ARGUMENT, "gpu is null");
    vox_gpu_destroy(gpu);
    vox_gpu_destroy(NULL);
    free_pair(&p);
}
END_TEST

SUITE(gpu_api) {
    TCase* tests = add_case(suite, "C");
    tcase_add_each(tests, steps, refuses);
}
