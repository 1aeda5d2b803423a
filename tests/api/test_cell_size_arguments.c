/* The cell size: every bad argument gives its code, a text with the numbers in it, and leaves the result
 * alone; structs may be smaller or larger than this library's. */
#include "support/ledger.h"
#include "support/suggest_scenes.h"

#include <limits.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

/* The call fails as said and does not touch the result. */
static void fails(const vox_cell_size_desc* desc, const vox_mesh_desc* meshes, uint64_t count,
                  vox_result code, const char* words) {
    vox_cell_size_result out, before;
    memset(&out, 0x5a, sizeof out);
    out.struct_size = sizeof out;
    before = out;
    ck_fails(vox_suggest_cell_size(desc, meshes, count, &out), code, words);
    ck_assert_mem_eq(&out, &before, sizeof out);
}

/* The same of both functions that take meshes. */
static void meshes_fail(const vox_mesh_desc* meshes, uint64_t count, vox_result code, const char* words) {
    fails(NULL, meshes, count, code, words);
    vox_geometry out, before;
    memset(&out, 0x5a, sizeof out);
    out.struct_size = sizeof out;
    before = out;
    ck_fails(vox_measure_geometry(meshes, count, &out), code, words);
    ck_assert_mem_eq(&out, &before, sizeof out);
}

static vox_mesh_desc good_mesh(void) { return vox_mesh_desc_floats(regular_positions, 4, unit_tet, 1); }

/* ---- settings --------------------------------------------------------------------------------- */

START_TEST(defaults) {
    const vox_mesh_desc mesh = good_mesh();
    const vox_cell_size_desc zeros = vox_default_cell_size_desc();
    vox_cell_size_desc named = zeros;
    ck_assert_uint_eq(zeros.struct_size, sizeof zeros);
    named.p_nc = 0.99;
    named.cost_ratio = 5;
    named.zone_loss = 0.05;
    const vox_cell_size_result a = suggest_ok(NULL, &mesh, 1), b = suggest_ok(&zeros, &mesh, 1),
                               c = suggest_ok(&named, &mesh, 1);
    ck_assert_mem_eq(&a, &b, sizeof a);
    ck_assert_mem_eq(&a, &c, sizeof a);
}
END_TEST

static const struct {
    size_t offset;
    double value;
    const char* words;
} bad_numbers[] = {
    {offsetof(vox_cell_size_desc, p_nc), 1, "p_nc is 1,"},
    {offsetof(vox_cell_size_desc, p_nc), -0.5, "p_nc is -0.5,"},
    {offsetof(vox_cell_size_desc, p_nc), NAN, "p_nc is"},
    {offsetof(vox_cell_size_desc, cost_ratio), -1, "cost_ratio is -1,"},
    {offsetof(vox_cell_size_desc, cost_ratio), INFINITY, "cost_ratio is inf,"},
    {offsetof(vox_cell_size_desc, cost_ratio), NAN, "cost_ratio is"},
    {offsetof(vox_cell_size_desc, cost_ratio), 1e300, "cost_ratio 1e+300"},
    {offsetof(vox_cell_size_desc, cost_ratio), 1e-300, "cost_ratio 1e-300"},
    {offsetof(vox_cell_size_desc, world_edge), -4, "world_edge is -4,"},
    {offsetof(vox_cell_size_desc, world_edge), INFINITY, "world_edge is inf,"},
    {offsetof(vox_cell_size_desc, world_edge), NAN, "world_edge is"},
    {offsetof(vox_cell_size_desc, zone_loss), -0.01, "zone_loss is -0.01,"},
    {offsetof(vox_cell_size_desc, zone_loss), 1e7, "zone_loss is 10000000,"},
    {offsetof(vox_cell_size_desc, zone_loss), NAN, "zone_loss is"},
};

START_TEST(bad_number) {
    const vox_mesh_desc mesh = good_mesh();
    vox_cell_size_desc desc = vox_default_cell_size_desc();
    memcpy((char*)&desc + bad_numbers[_i].offset, &bad_numbers[_i].value, sizeof(double));
    fails(&desc, &mesh, 1, VOX_ERROR_INVALID_ARGUMENT, bad_numbers[_i].words);
}
END_TEST

START_TEST(bad_model) {
    static const int32_t values[] = {4, -1, INT_MAX, INT_MIN};
    const vox_mesh_desc mesh = good_mesh();
    for (size_t v = 0; v < sizeof values / sizeof values[0]; ++v) {
        vox_cell_size_desc desc = vox_default_cell_size_desc();
        memcpy(&desc.model, &values[v], sizeof values[v]);
        fails(&desc, &mesh, 1, VOX_ERROR_INVALID_ARGUMENT, "model is");
    }
}
END_TEST

START_TEST(bad_bits) {
    const vox_mesh_desc mesh = good_mesh();
    vox_cell_size_desc desc = vox_default_cell_size_desc();
    desc.reference_flags = 6;
    fails(&desc, &mesh, 1, VOX_ERROR_INVALID_ARGUMENT, "reference_flags is 0x6, of which 0x4 is unknown");
    desc = vox_default_cell_size_desc();
    desc.reserved = 5;
    fails(&desc, &mesh, 1, VOX_ERROR_INVALID_ARGUMENT, "reserved is 5,");
}
END_TEST

/* ---- meshes ----------------------------------------------------------------------------------- */

START_TEST(bad_mesh) {
    vox_mesh_desc meshes[2] = {good_mesh(), good_mesh()};
    vox_mesh_desc* bad = &meshes[1];
#define BAD(change, code, words)                                                                             \
    do {                                                                                                     \
        *bad = good_mesh();                                                                                  \
        bad->change;                                                                                         \
        meshes_fail(meshes, 2, code, words);                                                                 \
    } while (0)

    BAD(flags = 8, VOX_ERROR_INVALID_ARGUMENT, "mesh 1 (user data 0): flags is 0x8");
    BAD(positions.reserved = 7, VOX_ERROR_INVALID_ARGUMENT, "mesh 1 (user data 0): positions.reserved is 7");
    BAD(positions.data = NULL, VOX_ERROR_INVALID_ARGUMENT,
        "mesh 1 (user data 0): positions.data is null, positions.count is 4");
    BAD(tets = NULL, VOX_ERROR_INVALID_ARGUMENT, "mesh 1 (user data 0): tets is null, tet_count is 1");
    BAD(tets = (const uint32_t*)((const char*)unit_tet + 1), VOX_ERROR_INVALID_ARGUMENT,
        "mesh 1 (user data 0): tets is not aligned");
    BAD(positions.byte_stride = 11, VOX_ERROR_INVALID_ARGUMENT,
        "mesh 1 (user data 0): positions.byte_stride is 11");
    BAD(positions.byte_stride = UINT64_MAX, VOX_ERROR_INVALID_ARGUMENT, "too large for 4 positions");
    BAD(positions.format = (vox_format)77, VOX_ERROR_INVALID_ARGUMENT,
        "mesh 1 (user data 0): positions.format is 77");
    BAD(positions.count = 3, VOX_ERROR_INVALID_MESH, "mesh 1 (user data 0): tet 0 names vertex 3 of 3");
    BAD(positions.count = 1ull << 40, VOX_ERROR_LIMIT,
        "mesh 1 (user data 0): positions.count is 1099511627776");
    BAD(tet_count = 1ull << 40, VOX_ERROR_LIMIT, "mesh 1 (user data 0): tet_count is 1099511627776");
    BAD(struct_size = 0, VOX_ERROR_INVALID_ARGUMENT, "meshes[1].struct_size is 0");
    BAD(struct_size = sizeof(vox_mesh_desc) + 8, VOX_ERROR_INVALID_ARGUMENT, "that of meshes[0] is");
#undef BAD

    static const uint32_t tets[8] = {0, 1, 2, 3, 0, 1, 900, 3};
    *bad = vox_mesh_desc_floats(regular_positions, 4, tets, 2);
    meshes_fail(meshes, 2, VOX_ERROR_INVALID_MESH, "mesh 1 (user data 0): tet 1 names vertex 900 of 4");

    *bad = good_mesh();
    meshes[0].struct_size = 3;
    meshes_fail(meshes, 2, VOX_ERROR_INVALID_ARGUMENT, "struct_size is 3");
    meshes[0].struct_size = sizeof meshes[0] + 1;
    meshes_fail(meshes, 2, VOX_ERROR_INVALID_ARGUMENT, "expected a multiple of 8");
    meshes[0].struct_size = 1u << 20;
    meshes_fail(meshes, 2, VOX_ERROR_INVALID_ARGUMENT, "struct_size is 1048576");

    meshes[0] = good_mesh();
    meshes_fail(NULL, 1, VOX_ERROR_INVALID_ARGUMENT, "meshes is null");
    meshes_fail(meshes, VOX_MAX_BODIES + 1u, VOX_ERROR_LIMIT, "mesh_count is 1048577");
}
END_TEST

START_TEST(non_finite_positions) {
    static const float values[] = {NAN, INFINITY, -INFINITY};
    float positions[15] = {0, 0, 0, 1, 1, 0, 1, 0, 1, 0, 1, 1, 0, 0, 0}; /* the last vertex is in no tet */
    vox_mesh_desc meshes[2] = {good_mesh(), vox_mesh_desc_floats(positions, 5, unit_tet, 1)};
    for (int c = 0; c < 15; ++c)
        for (int v = 0; v < 3; ++v) {
            char words[40];
            const float good = positions[c];
            positions[c] = values[v];
            snprintf(words, sizeof words, "mesh 1 (user data 0), vertex %d:", c / 3);
            meshes_fail(meshes, 2, VOX_ERROR_NON_FINITE, words);
            positions[c] = good;
        }
}
END_TEST

START_TEST(nothing_to_measure) {
    static const float one_place[12] = {5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5};
    static const float on_a_line[12] = {0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3};
    static const uint32_t twice[4] = {0, 1, 2, 2};
    static const uint32_t closed[8] = {0, 1, 2, 3, 3, 1, 2, 0};

    fails(NULL, NULL, 0, VOX_ERROR_INVALID_ARGUMENT, "no tetrahedra: 0 vertices");
    vox_mesh_desc mesh = vox_mesh_desc_floats(NULL, 0, NULL, 0);
    fails(NULL, &mesh, 1, VOX_ERROR_INVALID_ARGUMENT, "no tetrahedra: 0 vertices");
    mesh = vox_mesh_desc_floats(regular_positions, 4, NULL, 0);
    fails(NULL, &mesh, 1, VOX_ERROR_INVALID_ARGUMENT, "no tetrahedra: 4 vertices");
    mesh = vox_mesh_desc_floats(one_place, 4, unit_tet, 1);
    fails(NULL, &mesh, 1, VOX_ERROR_INVALID_ARGUMENT, "1 tets of no size: mean edge 0");
    mesh = vox_mesh_desc_floats(on_a_line, 4, unit_tet, 1);
    fails(NULL, &mesh, 1, VOX_ERROR_INVALID_ARGUMENT, "mean facet area 0");
    mesh = vox_mesh_desc_floats(regular_positions, 4, twice, 1);
    fails(NULL, &mesh, 1, VOX_ERROR_INVALID_ARGUMENT, "1 tets of no size");

    /* Two tets over the same corners have no boundary, but a size. */
    mesh = vox_mesh_desc_floats(regular_positions, 4, closed, 2);
    ck_assert_double_gt(suggest_ok(NULL, &mesh, 1).cell_size, 0);
    const vox_geometry of_closed = geometry_of(&mesh, 1), of_none = geometry_of(NULL, 0);
    ck_assert_uint_eq(of_closed.boundary_facets, 0);
    ck_assert_double_eq(of_closed.mean_boundary_facet_area, 0);
    ck_assert_uint_eq(of_none.vertices, 0);
    ck_assert_double_eq(of_none.mean_edge, 0);
}
END_TEST

/* ---- growing structs -------------------------------------------------------------------------- */

START_TEST(bad_struct_sizes) {
    const vox_mesh_desc mesh = good_mesh();
    static const uint32_t sizes[] = {0, 3, 65537, UINT32_MAX};
    ck_fails(vox_suggest_cell_size(NULL, &mesh, 1, NULL), VOX_ERROR_INVALID_ARGUMENT, "out is null");
    ck_fails(vox_measure_geometry(&mesh, 1, NULL), VOX_ERROR_INVALID_ARGUMENT, "out is null");
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
        vox_cell_size_desc desc = vox_default_cell_size_desc();
        desc.struct_size = sizes[i];
        fails(&desc, &mesh, 1, VOX_ERROR_INVALID_ARGUMENT, "struct_size is");
        vox_cell_size_result out;
        out.struct_size = sizes[i];
        ck_fails(vox_suggest_cell_size(NULL, &mesh, 1, &out), VOX_ERROR_INVALID_ARGUMENT,
                 "out.struct_size is");
        vox_geometry geometry;
        geometry.struct_size = sizes[i];
        ck_fails(vox_measure_geometry(&mesh, 1, &geometry), VOX_ERROR_INVALID_ARGUMENT, "out.struct_size is");
    }
}
END_TEST

/* An old program knows only the first fields: the rest is neither read nor written. */
START_TEST(smaller_structs) {
    const vox_mesh_desc mesh = good_mesh();
    vox_cell_size_desc desc;
    memset(&desc, 0xff, sizeof desc); /* NaN wherever the library must not look */
    const uint32_t known = offsetof(vox_cell_size_desc, cost_ratio);
    const vox_cell_size_desc defaults = vox_default_cell_size_desc();
    memcpy(&desc, &defaults, known);
    desc.struct_size = known;
    const vox_cell_size_result whole = suggest_ok(NULL, &mesh, 1);
    ck_assert_double_eq(suggest_ok(&desc, &mesh, 1).cell_size, whole.cell_size);

    vox_cell_size_result out, expected;
    memset(&out, 0x5a, sizeof out);
    out.struct_size = offsetof(vox_cell_size_result, zone_min);
    expected = out;
    expected.warnings = 0;
    expected.cell_size = whole.cell_size;
    ck_ok(vox_suggest_cell_size(&desc, &mesh, 1, &out));
    ck_assert_mem_eq(&out, &expected, sizeof out);

    /* Mesh descriptions that end before user_data, packed as an old program would have them. */
    enum { old_size = offsetof(vox_mesh_desc, user_data) };
    union {
        unsigned char bytes[2 * old_size];
        vox_mesh_desc align;
    } old_meshes;
    vox_mesh_desc old = mesh;
    old.struct_size = old_size;
    memcpy(old_meshes.bytes, &old, old_size);
    memcpy(old_meshes.bytes + old_size, &old, old_size);
    ck_ok(vox_suggest_cell_size(NULL, (const vox_mesh_desc*)old_meshes.bytes, 2, &out));
    ck_assert_double_eq_tol(out.cell_size, whole.cell_size, 1e-14);
    ck_assert_uint_eq(geometry_of((const vox_mesh_desc*)old_meshes.bytes, 2).tets, 2);
}
END_TEST

/* A new program has fields that this library does not know: they are left alone. */
START_TEST(larger_structs) {
    struct new_mesh {
        vox_mesh_desc known;
        uint64_t later[2];
    } meshes[3];
    struct new_desc {
        vox_cell_size_desc known;
        double later;
    } desc;
    struct new_result {
        vox_cell_size_result known;
        uint64_t later;
    } out;
    memset(meshes, 0xff, sizeof meshes);
    for (int i = 0; i < 3; ++i) {
        meshes[i].known = good_mesh();
        meshes[i].known.struct_size = sizeof meshes[i];
    }
    desc.later = 7;
    desc.known = vox_default_cell_size_desc();
    desc.known.struct_size = sizeof desc;
    out.later = 0x1234;
    out.known.struct_size = sizeof out;
    ck_ok(vox_suggest_cell_size(&desc.known, &meshes[0].known, 3, &out.known));
    ck_assert_uint_eq(out.later, 0x1234);
    ck_assert_uint_eq(out.known.struct_size, sizeof out);
    ck_assert_uint_eq(geometry_of(&meshes[0].known, 3).tets, 3);
}
END_TEST

/* All models, in the memory of the caller: the same answer, nothing left behind, and every call may fail. */
START_TEST(memory_of_the_caller) {
    body box = make_box(6, 0.25f, 0, 0, 0), other = make_box(6, 0.25f, 1, 0.4f, 0.3f);
    vox_mesh_desc meshes[2] = {body_desc(&box), body_desc(&other)};
    vox_cell_size_desc desc = vox_default_cell_size_desc();
    vox_cell_size_result* out = (vox_cell_size_result*)calloc(2, sizeof *out);
    ledger memory = {0};
    meshes[0].filter.flags = VOX_FILTER_SELF_COLLISION;
    desc.model = (vox_cost_model)_i;
    out[0].struct_size = out[1].struct_size = sizeof *out;
    ck_ok(vox_suggest_cell_size(&desc, meshes, 2, &out[0]));
    desc.allocator = ledger_allocator(&memory);
    ck_ok(vox_suggest_cell_size(&desc, meshes, 2, &out[1]));
    ck_assert_mem_eq(&out[0], &out[1], sizeof *out);
    ck_assert_uint_gt(memory.peak, 30 * (uint64_t)box.tet_count);
    ck_assert_uint_eq(memory.bytes, 0);
    const uint64_t calls = memory.calls;
    uint64_t failed = 0, tried = 0;
    for (uint64_t n = 1; n <= calls;
         n += 1 + n / 16, ++tried) { /* a list that cannot be made shorter stays longer */
        memory.calls = 0;
        memory.fail_at = n;
        const vox_result result = vox_suggest_cell_size(&desc, meshes, 2, &out[1]);
        ck_assert(result == VOX_OK || result == VOX_ERROR_OUT_OF_MEMORY);
        failed += result != VOX_OK;
        ck_assert_mem_eq(&out[0], &out[1], sizeof *out);
        ck_assert_uint_eq(memory.bytes, 0);
    }
    ck_assert_uint_gt(failed, tried / 2);
    memory.fail_at = 0;

    /* Of a grid, too: what does not fit on the stack. */
    vox_grid* grid = grid_of(NULL);
    for (int b = 0; b < 2; ++b) (void)insert_mesh(grid, &meshes[b]);
    ck_ok(vox_grid_suggest_cell_size(grid, &desc, &out[1]));
    ck_assert_uint_eq(memory.bytes, 0);
    vox_grid_destroy(grid);
    memory.allocator.release = NULL;
    ck_fails(vox_suggest_cell_size(&desc, meshes, 2, &out[1]), VOX_ERROR_INVALID_ARGUMENT,
             "desc.allocator has one of allocate and release");
    free(out);
    free_body(&box);
    free_body(&other);
}
END_TEST

void add_argument_tests(Suite* suite) {
    TCase* tests = add_case(suite, "arguments");
    tcase_add_test(tests, defaults);
    tcase_add_loop_test(tests, memory_of_the_caller, 0, 3);
    tcase_add_loop_test(tests, bad_number, 0, sizeof bad_numbers / sizeof bad_numbers[0]);
    tcase_add_each(tests, bad_model, bad_bits, bad_mesh, non_finite_positions, nothing_to_measure,
                   bad_struct_sizes, smaller_structs, larger_structs);
}
