/* Shared by the suites: checks of results, grids and meshes in one call, cases, one case an engine. */
#ifndef VOX_TESTS_SUITE_H
#define VOX_TESTS_SUITE_H

#include <check.h>
/* Check writes every assertion that holds into a file, to name the last one before a crash: half of the time
 * of tests that assert something of each tetrahedron. A debugger names it too. */
#define _mark_point(file, line) ((void)0)
#include <stdio.h>
#include <stdlib.h>
#include <vox/vox.h>

#include "scenes/counters.h"
#include "scenes/engines.h"

#define ck_ok(call)                                                                                          \
    do {                                                                                                     \
        const vox_result result_ = (call);                                                                   \
        ck_assert_msg(result_ == VOX_OK, "%s: %s (%s)", #call, vox_result_string(result_),                   \
                      vox_last_error());                                                                     \
    } while (0)

/* The call fails with `code`, and its text contains `words`. */
#define ck_fails(call, code, words)                                                                          \
    do {                                                                                                     \
        const vox_result result_ = (call);                                                                   \
        ck_assert_msg(result_ == (code), "%s: %s, expected %s (%s)", #call, vox_result_string(result_),      \
                      vox_result_string(code), vox_last_error());                                            \
        ck_assert_msg(strstr(vox_last_error(), (words)) != NULL,                                             \
                      "%s: the text is \"%s\", expected \"%s\" in it", #call, vox_last_error(), (words));    \
    } while (0)

static inline vox_grid* grid_of(const vox_grid_desc* desc) {
    vox_grid* grid = NULL;
    ck_ok(vox_grid_create(desc, &grid));
    return grid;
}

static inline vox_grid_info grid_info(const vox_grid* grid) {
    vox_grid_info info;
    info.struct_size = sizeof info;
    ck_ok(vox_grid_get_info(grid, &info));
    return info;
}

static inline vox_filter plain_filter(void) {
    const vox_filter filter = VOX_ZERO;
    return filter;
}

static inline vox_result get_filter(const vox_grid* grid, vox_body body, vox_filter* out) {
    vox_body_info info;
    info.struct_size = sizeof info;
    const vox_result result = vox_body_get_info(grid, body, &info);
    if (result == VOX_OK) *out = info.filter;
    return result;
}

static inline vox_body insert_mesh(vox_grid* grid, const vox_mesh_desc* desc) {
    vox_body mesh = VOX_NULL_BODY;
    ck_ok(vox_mesh_insert(grid, desc, &mesh));
    return mesh;
}

/* A description of `data` as one position for each vertex of the mesh. */
static inline vox_positions positions_for(const vox_grid* grid, vox_body mesh, const void* data,
                                          vox_format format, uint64_t byte_stride,
                                          uint64_t component_byte_stride) {
    vox_body_info info;
    info.struct_size = sizeof info;
    if (vox_body_get_info(grid, mesh, &info) != VOX_OK) info.positions.count = 0;
    const vox_positions positions = {data, info.positions.count, format,
                                     0,    byte_stride,          component_byte_stride};
    return positions;
}

static inline vox_result bind_array(vox_grid* grid, vox_body mesh, const void* data, vox_format format,
                                    uint64_t byte_stride, uint64_t component_byte_stride) {
    const vox_positions positions =
        positions_for(grid, mesh, data, format, byte_stride, component_byte_stride);
    return vox_mesh_bind_positions(grid, mesh, &positions);
}

static inline vox_result bind_previous_array(vox_grid* grid, vox_body mesh, const void* data,
                                             vox_format format, uint64_t byte_stride,
                                             uint64_t component_byte_stride) {
    const vox_positions positions =
        positions_for(grid, mesh, data, format, byte_stride, component_byte_stride);
    return vox_mesh_bind_previous_positions(grid, mesh, &positions);
}

/* Views: a count that is not written shows. */
static inline vox_contact_view contacts_of(const vox_grid* grid) {
    vox_contact_view view = {NULL, 99, NULL};
    ck_ok(vox_grid_get_contacts(grid, &view));
    return view;
}

static inline vox_pair_view pairs_of(const vox_grid* grid) {
    vox_pair_view view = {NULL, 99, NULL};
    ck_ok(vox_grid_get_pairs(grid, &view));
    return view;
}

/* How many pairs of the last step are in that state. */
static inline uint64_t count_pairs(const vox_grid* grid, vox_pair_state state) {
    const vox_pair_view view = pairs_of(grid);
    uint64_t count = 0;
    for (uint64_t i = 0; i < view.count; ++i) count += view.data[i].state == state;
    return count;
}

static inline vox_constraint_view constraints_of(const vox_grid* grid) {
    vox_constraint_view view = {NULL, 99, NULL, 99};
    ck_ok(vox_grid_get_constraints(grid, &view));
    return view;
}

/* Steps the grid; the hash of the contacts that it found. */
static inline uint64_t hash_of_step(vox_grid* grid) {
    uint64_t hash = 0;
    ck_ok(vox_grid_step(grid));
    ck_ok(vox_grid_get_hash(grid, &hash));
    return hash;
}

/* A case of the suite. CK_EXCLUDE_TAGS leaves out what would take minutes: "long" under valgrind, "large"
 * there and under the sanitizers. A slow machine is no failure: there is no timeout. */
static inline TCase* add_tagged_case(Suite* suite, const char* name, const char* tag) {
    TCase* tests = tcase_create(name);
    tcase_set_timeout(tests, 0);
    tcase_set_tags(tests, tag);
    suite_add_tcase(suite, tests);
    return tests;
}

static inline TCase* add_case(Suite* suite, const char* name) { return add_tagged_case(suite, name, ""); }

/* tcase_add_each(tests, a, b, c): tests that run once each. */
#define tcase_add_each(tests, ...)                                                                           \
    do {                                                                                                     \
        const TTest* const each_[] = {__VA_ARGS__};                                                          \
        for (size_t i_ = 0; i_ < sizeof each_ / sizeof *each_; ++i_) tcase_add_test(tests, each_[i_]);       \
    } while (0)

/* Tests that hold for every engine: add_tests(tcase) is called for a case per engine, with `suite_engine`
 * set. */
static engine_kind suite_engine = ENGINE_FAST;
static inline void use_reference(void) { suite_engine = ENGINE_REFERENCE; }
static inline void use_fast(void) { suite_engine = ENGINE_FAST; }
static inline vox_grid_desc engine_desc(void) {
    vox_grid_desc desc = vox_default_grid_desc();
    use_engine(&desc, suite_engine);
    return desc;
}
static inline vox_grid* engine_grid(void) {
    const vox_grid_desc desc = engine_desc();
    return grid_of(&desc);
}

static inline void add_tagged_for_each_engine(Suite* suite, void (*add_tests)(TCase*), const char* tag) {
    static const char* const names[] = {"reference", "fast"};
    static void (*const setups[])(void) = {use_reference, use_fast};
    for (int i = 0; i < 2; ++i) {
        TCase* tests = add_tagged_case(suite, names[i], tag);
        tcase_add_checked_fixture(tests, setups[i], NULL);
        add_tests(tests);
    }
}

static inline void add_for_each_engine(Suite* suite, void (*add_tests)(TCase*)) {
    add_tagged_for_each_engine(suite, add_tests, "");
}

static inline uint64_t number_from(const char* variable, uint64_t usual) {
    const char* text = getenv(variable);
    return text ? strtoull(text, NULL, 10) : usual;
}
/* How many random scenes to try, or how many steps to take. VOX_TEST_VOLUME multiplies the usual numbers, for
 * long runs. */
static inline uint64_t test_volume(void) { return number_from("VOX_TEST_VOLUME", 1); }
static inline uint64_t volume_from(const char* variable, uint64_t usual) {
    return number_from(variable, usual * test_volume());
}

/* Whether the meshes from outside the tree are there, by one of their files. A suite that adds no case
 * without them is skipped. */
static inline int have_meshes(const char* path) {
    FILE* file = fopen(path, "rb");
    if (file) {
        fclose(file);
        return 1;
    }
    const int required = getenv("VOX_REQUIRE_MESHES") != NULL;
    printf("%s: there is no %s\n", required ? "failed" : "skipped", path);
    if (required) exit(EXIT_FAILURE);
    return 0;
}

/* SUITE(pairs) { add_case(suite, ...) ... } adds the cases of the suite, which ctest knows by this name. */
#if defined(__cplusplus)
#define SUITE_LINKAGE_ extern "C"
#else
#define SUITE_LINKAGE_
#endif
#define SUITE(name)                                                                                          \
    SUITE_LINKAGE_ void suite_##name(Suite* suite);                                                          \
    void suite_##name(Suite* suite)

#endif
