/* A simulation in the memory of the caller. */
#include "sim/scene.h"
#include "support/ledger.h"

/* Two balls and a shape collide; sets *out to a hash of where they are, and fails as the calls do. */
static vox_result run(const vox_sim_desc* desc, const vox_io_mesh* mesh, uint64_t* out) {
    vox_sim* sim = NULL;
    vox_result result = vox_sim_create(desc, &sim);
    vox_io_mesh_view view;
    vox_body bodies[2] = {VOX_NULL_BODY, VOX_NULL_BODY};
    ck_ok(vox_io_mesh_get_arrays(mesh, &view));
    double* positions = placed(&view, 0.3, 0.7, 0.1, 0.2);
    vox_sim_body_desc body = vox_default_sim_body_desc();
    body.vertex_count = view.vertex_count;
    body.tets = view.tets;
    body.tet_count = view.tet_count;
    for (int b = 0; b < 2 && result == VOX_OK; ++b) {
        body.positions = b ? positions : view.positions;
        result = vox_sim_body_insert(sim, &body, &bodies[b]);
    }
    vox_shape_desc shape = vox_default_shape_desc();
    shape.kind = VOX_SHAPE_SPHERE;
    shape.radius = 0.5;
    vox_grid* grid = NULL;
    vox_body pushing = VOX_NULL_BODY;
    if (result == VOX_OK) result = vox_sim_get_grid(sim, &grid);
    if (result == VOX_OK) result = vox_shape_insert(grid, &shape, &pushing);
    for (int i = 0; i < 3 && result == VOX_OK; ++i) {
        const double matrix[12] = {1, 0, 0, 0.1 * i - 0.9, 0, 1, 0, 0, 0, 0, 1, 0};
        result = vox_body_set_transform(grid, pushing, matrix);
        if (result == VOX_OK) result = vox_sim_step(sim, 1.0 / 60);
    }
    *out = 0;
    for (int b = 0; b < 2 && result == VOX_OK; ++b) {
        vox_sim_body_view state;
        ck_ok(vox_sim_body_get_view(sim, bodies[b], &state));
        for (uint64_t i = 0; i < 3 * state.vertex_count; ++i) {
            uint64_t bits;
            memcpy(&bits, &state.positions[i], sizeof bits);
            *out = (*out ^ bits) * 0x9fb21c651e98df25u;
        }
    }
    if (result == VOX_OK) result = vox_sim_body_remove(sim, bodies[0]);
    vox_sim_destroy(sim);
    free(positions);
    return result;
}

START_TEST(in_memory_of_the_caller) {
    vox_io_mesh* mesh = NULL;
    ck_ok(vox_io_make_lattice_ball(200, 0.5, &mesh));
    vox_sim_desc desc = weightless();
    ledger memory = {0}, of_grid = {0};
    uint64_t usual = 0, hash = 0;
    ck_ok(run(&desc, mesh, &usual));
    desc.allocator = ledger_allocator(&memory);
    ck_ok(run(&desc, mesh, &hash));
    ck_assert_uint_eq(hash, usual);
    ck_assert_uint_eq(memory.bytes, 0);
    const uint64_t calls = memory.calls, peak = memory.peak;
    ck_assert_uint_gt(calls, 100);

    /* The grid's own allocator goes first. */
    vox_grid_desc grid = vox_default_grid_desc();
    grid.allocator = ledger_allocator(&of_grid);
    desc.grid = &grid;
    memory.peak = memory.calls = 0;
    ck_ok(run(&desc, mesh, &hash));
    ck_assert_uint_eq(hash, usual);
    ck_assert_uint_gt(of_grid.peak, 100000);
    ck_assert_uint_gt(memory.peak, 10000);
    ck_assert_uint_lt(memory.peak, peak);
    ck_assert_uint_eq(of_grid.bytes, 0);
    desc.grid = NULL;

    uint64_t failed = 0, tried = 0;
    for (uint64_t n = 1; n <= calls; n += 1 + n / 8, ++tried) {
        memory.calls = 0;
        memory.fail_at = n;
        const vox_result result = run(&desc, mesh, &hash);
        failed += result == VOX_ERROR_OUT_OF_MEMORY;
        if (result == VOX_OK) /* a list kept room that it would have given back */
            ck_assert_uint_eq(hash, usual);
        else
            ck_assert_msg(result == VOX_ERROR_OUT_OF_MEMORY, "call %d: %s", (int)n,
                          vox_result_string(result));
        ck_assert_uint_eq(memory.bytes, 0);
    }
    ck_assert_uint_ge(failed, tried - tried / 8);
    memory.allocator.allocate = NULL;
    ck_fails(run(&desc, mesh, &hash), VOX_ERROR_INVALID_ARGUMENT, "one of allocate and release");
    vox_io_mesh_destroy(mesh);
}
END_TEST

SUITE(sim_memory) { tcase_add_test(add_case(suite, "sim_memory"), in_memory_of_the_caller); }
