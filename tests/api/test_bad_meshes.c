/* Meshes with coordinates that are not allowed: which one made a step fail, and steps that leave them out. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scenes/bodies.h"
#include "support/ledger.h"
#include "support/locators.h"

enum { most = 4 };

typedef struct scene {
    vox_grid* grid;
    body bodies[most];
    vox_body ids[most];
} scene;

/* Boxes in a row, each in the next. */
static scene new_scene(uint32_t flags, ledger* memory) {
    scene s;
    vox_grid_desc desc = engine_desc();
    desc.flags = flags | VOX_GRID_CONSTRAINTS;
    if (memory) desc.allocator = ledger_allocator(memory);
    s.grid = grid_of(&desc);
    for (int b = 0; b < most; ++b) {
        s.bodies[b] = make_box(3, 0.5f, 1.1f * (float)b, 0.1f * (float)b, 0.07f * (float)b);
        vox_mesh_desc mesh = body_desc(&s.bodies[b]);
        mesh.user_data = 100 + (uint64_t)b;
        s.ids[b] = insert_mesh(s.grid, &mesh);
    }
    return s;
}

static void free_scene(scene* s) {
    vox_grid_destroy(s->grid);
    for (int b = 0; b < most; ++b) free_body(&s->bodies[b]);
}

static vox_failure failure_of(const vox_grid* grid, uint32_t index) {
    vox_failure failure;
    memset(&failure, 0x55, sizeof failure);
    failure.struct_size = sizeof failure;
    ck_ok(vox_grid_get_failure(grid, index, &failure));
    ck_assert_uint_eq(failure.struct_size, sizeof failure);
    return failure;
}

static void no_failure(const vox_grid* grid, uint32_t index) {
    const vox_failure failure = failure_of(grid, index);
    ck_assert_int_eq(failure.result, VOX_OK);
    ck_assert_uint_eq(failure.body, VOX_NULL_BODY);
    ck_assert_uint_eq(failure.vertex, VOX_NONE);
}

static void is_failure(vox_failure failure, const scene* s, int b, uint32_t vertex, vox_result result) {
    ck_assert_int_eq(failure.result, result);
    ck_assert_uint_eq(failure.body, s->ids[b]);
    ck_assert_uint_eq(failure.user_data, 100 + (uint64_t)b);
    ck_assert_uint_eq(failure.vertex, vertex);
    for (int axis = 0; axis < 3; ++axis) {
        const double expected =
            vertex == VOX_NONE ? 0 : (double)s->bodies[b].positions[3 * vertex + (uint32_t)axis];
        ck_assert(failure.position[axis] == expected || (isnan(failure.position[axis]) && isnan(expected)));
    }
}

typedef struct messages {
    int count;
    char last[400];
} messages;

static void write_message(vox_log_level level, const char* text, void* user) {
    messages* to = (messages*)user;
    if (level != VOX_LOG_WARNING || !strstr(text, "left out of the step")) return;
    ++to->count;
    snprintf(to->last, sizeof to->last, "%s", text);
}

/* Once a mesh, until it is well again. */
START_TEST(what_is_left_out_is_logged_once) {
    messages log = {0, ""};
    vox_grid_desc desc = engine_desc();
    desc.flags |= VOX_GRID_SKIP_BAD_BODIES;
    const vox_log log_lines = {write_message, &log};
    desc.log = &log_lines;
    vox_grid* grid = grid_of(&desc);
    body bodies[2];
    for (int b = 0; b < 2; ++b) {
        bodies[b] = make_box(3, 0.5f, (float)b, 0, 0);
        const vox_mesh_desc mesh = body_desc(&bodies[b]);
        (void)insert_mesh(grid, &mesh);
    }
    float kept[2];
    for (int b = 0; b < 2; ++b) kept[b] = bodies[b].positions[7];
    bodies[1].positions[7] = NAN;
    for (int i = 0; i < 3; ++i) ck_ok(vox_grid_step(grid));
    ck_assert_int_eq(log.count, 1);
    ck_assert_ptr_nonnull(strstr(log.last, "body 4097 (slot 1, user data 0), vertex 2: position ("));
    bodies[0].positions[7] = INFINITY;
    for (int i = 0; i < 3; ++i) ck_ok(vox_grid_step(grid));
    ck_assert_int_eq(log.count, 2);
    ck_assert_ptr_nonnull(strstr(log.last, "slot 0"));
    bodies[1].positions[7] = kept[1];
    ck_ok(vox_grid_step(grid));
    bodies[1].positions[7] = NAN;
    ck_ok(vox_grid_step(grid));
    ck_assert_int_eq(log.count, 3);
    ck_assert_ptr_nonnull(strstr(log.last, "slot 1"));
    vox_grid_destroy(grid);
    for (int b = 0; b < 2; ++b) free_body(&bodies[b]);
}
END_TEST

START_TEST(which_mesh_failed) {
    scene s = new_scene(0, NULL);
    const double huge[12] = {1e300, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0};
    vox_failure failure;
    failure.struct_size = sizeof failure;
    ck_fails(vox_grid_get_failure(NULL, 0, &failure), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_get_failure(s.grid, 0, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_failure is null");
    no_failure(s.grid, 0);
    ck_ok(vox_grid_step(s.grid));
    no_failure(s.grid, 0);

    float* const coordinate = &s.bodies[2].positions[3 * 11 + 1];
    const float kept = *coordinate;
    *coordinate = NAN;
    ck_fails(vox_grid_step(s.grid), VOX_ERROR_NON_FINITE,
             "body 8193 (slot 2, user data 102), vertex 11: position (");
    is_failure(failure_of(s.grid, 0), &s, 2, 11, VOX_ERROR_NON_FINITE);
    no_failure(s.grid, 1);
    vox_locator* locator = NULL;
    ck_fails(vox_grid_update_locator(s.grid, &locator), VOX_ERROR_NON_FINITE,
             "body 8193 (slot 2, user data 102), vertex 11");
    *coordinate = kept;
    ck_ok(vox_grid_step(s.grid));
    no_failure(s.grid, 0);

    ck_ok(vox_body_set_transform(s.grid, s.ids[1], huge));
    ck_fails(vox_grid_step(s.grid), VOX_ERROR_LIMIT, "body 4097 (slot 1, user data 101), vertex ");
    failure = failure_of(s.grid, 0);
    ck_assert_int_eq(failure.result, VOX_ERROR_LIMIT);
    ck_assert_double_gt(fabs(failure.position[0]), 1e299);
    ck_ok(vox_body_set_transform(s.grid, s.ids[1], NULL));

    /* A mesh that has no positions, and may be removed before anyone asks. */
    vox_mesh_desc bare = body_desc(&s.bodies[0]);
    bare.positions.data = NULL;
    bare.user_data = 7;
    const vox_body mesh = insert_mesh(s.grid, &bare);
    ck_fails(vox_grid_step(s.grid), VOX_ERROR_INVALID_STATE, "(slot 4, user data 7) has no positions");
    ck_ok(vox_body_remove(s.grid, mesh));
    failure = failure_of(s.grid, 0);
    ck_assert_int_eq(failure.result, VOX_ERROR_INVALID_STATE);
    ck_assert_uint_eq(failure.body, mesh);
    ck_assert_uint_eq(failure.user_data, 7);
    ck_assert_uint_eq(failure.vertex, VOX_NONE);
    ck_ok(vox_grid_step(s.grid));
    no_failure(s.grid, 0);
    *coordinate = INFINITY;
    ck_fails(vox_grid_step(s.grid), VOX_ERROR_NON_FINITE, "slot 2");
    ck_ok(vox_grid_clear(s.grid));
    no_failure(s.grid, 0);
    free_scene(&s);
}
END_TEST

/* What a grid finds without some meshes: they are disabled there. */
static uint64_t hash_without(const scene* s, const int* out, int count) {
    scene other = new_scene(0, NULL);
    for (int b = 0; b < most; ++b)
        memcpy(other.bodies[b].positions, s->bodies[b].positions,
               3 * sizeof(float) * s->bodies[b].vertex_count);
    for (int i = 0; i < count; ++i) ck_ok(vox_body_set_enabled(other.grid, other.ids[out[i]], 0));
    const uint64_t hash = hash_of_step(other.grid);
    free_scene(&other);
    return hash;
}

START_TEST(bad_meshes_are_left_out) {
    scene s = new_scene(VOX_GRID_SKIP_BAD_BODIES, NULL);
    const int one[] = {1}, two[] = {1, 3};
    ck_assert_uint_eq(grid_info(s.grid).flags, VOX_GRID_CONSTRAINTS | VOX_GRID_SKIP_BAD_BODIES);
    const uint64_t all = hash_of_step(s.grid);
    ck_assert_uint_eq(all, hash_without(&s, NULL, 0));
    ck_assert_uint_eq(counters_of(s.grid).skipped_bodies, 0);

    float* const x = &s.bodies[1].positions[3 * 20];
    float* const y = &s.bodies[3].positions[3 * 5 + 1];
    const float kept_x = *x, kept_y = *y;
    for (int again = 0; again < 3; ++again) { /* at rest before, and back in their old place */
        *x = NAN;
        const uint64_t without_one = hash_without(&s, one, 1);
        ck_assert_uint_ne(without_one, all);
        for (int step = 0; step < 3; ++step) {
            ck_assert_uint_eq(hash_of_step(s.grid), without_one);
            ck_assert_uint_eq(counters_of(s.grid).skipped_bodies, 1);
            ck_assert_uint_eq(counters_of(s.grid).bodies, 3);
            ck_assert_uint_eq(counters_of(s.grid).disabled_bodies, 0);
            is_failure(failure_of(s.grid, 0), &s, 1, 20, VOX_ERROR_NON_FINITE);
            no_failure(s.grid, 1);
        }
        if (suite_engine == ENGINE_FAST) /* the others are at rest, and are carried over */
            ck_assert_uint_eq(counters_of(s.grid).carried_contacts, contacts_of(s.grid).count);
        *y = -INFINITY;
        s.bodies[1].positions[1] = NAN; /* an earlier vertex */
        ck_assert_uint_eq(hash_of_step(s.grid), hash_without(&s, two, 2));
        ck_assert_uint_eq(counters_of(s.grid).skipped_bodies, 2);
        is_failure(failure_of(s.grid, 0), &s, 1, 0, VOX_ERROR_NON_FINITE);
        is_failure(failure_of(s.grid, 1), &s, 3, 5, VOX_ERROR_NON_FINITE);
        no_failure(s.grid, 2);
        /* The other questions leave them out, too. */
        vox_cell_size_result suggestion;
        suggestion.struct_size = sizeof suggestion;
        vox_locator* locator = take_locator(s.grid);
        for (uint32_t b = 0; b < 4; ++b) {
            uint64_t user_data = 0;
            ck_assert_int_eq(vox_locator_get_user_data(locator, s.ids[b], &user_data),
                             b % 2 ? VOX_ERROR_INVALID_HANDLE : VOX_OK);
        }
        vox_locator_release(locator);
        ck_ok(vox_grid_suggest_cell_size(s.grid, NULL, &suggestion));
        ck_assert_double_eq_tol(suggestion.cells_per_axis * suggestion.cell_size, 2 * 1.1 + 3 * 0.5,
                                1e-5); /* from the first body to the third */
        ck_ok(vox_grid_find_constraints(s.grid, NULL));

        s.bodies[1].positions[1] = s.bodies[0].positions[1] + 0.1f;
        *x = kept_x;
        *y = kept_y;
        ck_assert_uint_eq(hash_of_step(s.grid), all);
        ck_assert_uint_eq(counters_of(s.grid).skipped_bodies, 0);
        no_failure(s.grid, 0);
        ck_assert_uint_eq(hash_of_step(s.grid), all);
    }
    /* Only coordinates: a mesh without positions is a mistake of the program. */
    vox_mesh_desc bare = body_desc(&s.bodies[0]);
    bare.positions.data = NULL;
    const vox_body mesh = insert_mesh(s.grid, &bare);
    ck_fails(vox_grid_step(s.grid), VOX_ERROR_INVALID_STATE, "has no positions");
    ck_ok(vox_body_remove(s.grid, mesh));
    /* Without the flag the step fails again. */
    *x = NAN;
    ck_assert_uint_eq(hash_of_step(s.grid), hash_without(&s, one, 1));
    ck_ok(vox_grid_set_flags(s.grid, VOX_GRID_CONSTRAINTS));
    ck_fails(vox_grid_step(s.grid), VOX_ERROR_NON_FINITE, "slot 1");
    free_scene(&s);
}
END_TEST

/* All of them bad, and the first step of all. */
START_TEST(all_are_bad) {
    scene s = new_scene(VOX_GRID_SKIP_BAD_BODIES, NULL);
    float kept[most];
    for (int b = 0; b < most; ++b) kept[b] = s.bodies[b].positions[7], s.bodies[b].positions[7] = NAN;
    ck_ok(vox_grid_step(s.grid));
    ck_assert_uint_eq(contacts_of(s.grid).count, 0);
    ck_assert_uint_eq(counters_of(s.grid).skipped_bodies, most);
    for (int b = 0; b < most; ++b)
        is_failure(failure_of(s.grid, (uint32_t)b), &s, b, 2, VOX_ERROR_NON_FINITE);
    for (int b = 0; b < most; ++b) s.bodies[b].positions[7] = kept[b];
    ck_assert_uint_eq(hash_of_step(s.grid), hash_without(&s, NULL, 0));
    free_scene(&s);
}
END_TEST

/* They end and begin once. */
START_TEST(pairs_of_a_mesh_that_is_left_out) {
    scene s = new_scene(VOX_GRID_SKIP_BAD_BODIES, NULL);
    ck_ok(vox_grid_step(s.grid));
    s.bodies[0].positions[0] = NAN;
    for (int step = 0; step < 2; ++step) {
        ck_ok(vox_grid_step(s.grid));
        ck_assert_uint_eq(count_pairs(s.grid, VOX_PAIR_ENDED), step == 0);
        ck_assert_uint_eq(count_pairs(s.grid, VOX_PAIR_BEGAN), 0);
        for (uint64_t i = 0; i < constraints_of(s.grid).count; ++i)
            ck_assert_uint_ne(constraints_of(s.grid).data[i].body_a, s.ids[0]);
    }
    s.bodies[0].positions[0] = 0;
    ck_ok(vox_grid_step(s.grid));
    ck_assert_uint_eq(count_pairs(s.grid, VOX_PAIR_BEGAN), 1);
    ck_assert_uint_eq(count_pairs(s.grid, VOX_PAIR_ENDED), 0);
    free_scene(&s);
}
END_TEST

/* With meshes that are left out the steady state allocates nothing either, moving or not. */
START_TEST(steady_state) {
    ledger memory = {0};
    scene s = new_scene(VOX_GRID_SKIP_BAD_BODIES, &memory);
    uint64_t calls = 0;
    s.bodies[2].positions[10] = NAN;
    for (int step = 0; step < 40; ++step) {
        if (step == 20) calls = memory.calls;
        for (uint32_t v = 0; v < s.bodies[1].vertex_count; ++v)
            s.bodies[1].positions[3 * v] += step % 2 ? 0.01f : -0.01f;
        ck_ok(vox_grid_step(s.grid));
        ck_assert_uint_eq(counters_of(s.grid).skipped_bodies, 1);
    }
    ck_assert_uint_eq(memory.calls, calls);
    free_scene(&s);
}
END_TEST

/* Every allocation of such a step may fail: then the step does, and the next one is right. */
START_TEST(failing_allocations) {
    for (uint64_t n = 1; n < 60; ++n) {
        ledger memory = {0};
        scene s = new_scene(VOX_GRID_SKIP_BAD_BODIES, &memory);
        const int one[] = {2};
        s.bodies[2].positions[10] = NAN;
        memory.fail_at = memory.calls + n;
        if (vox_grid_step(s.grid) != VOX_OK) ck_assert_uint_eq(contacts_of(s.grid).count, 0);
        memory.fail_at = 0;
        ck_assert_uint_eq(hash_of_step(s.grid), hash_without(&s, one, 1));
        free_scene(&s);
        ck_assert_uint_eq(memory.bytes, 0);
    }
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, which_mesh_failed, what_is_left_out_is_logged_once, bad_meshes_are_left_out,
                   all_are_bad, pairs_of_a_mesh_that_is_left_out, steady_state, failing_allocations);
}

SUITE(bad_meshes) { add_for_each_engine(suite, add_tests); }
