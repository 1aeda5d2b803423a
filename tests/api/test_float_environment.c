/* Whatever floating-point environment the caller has set: the same bits, and the environment stays as it was.
 */
#include <pthread.h>

#include "scenes/bodies.h"
#include "support/aligned.h"
#include "support/float_modes.h"
#include "support/suite.h"

#include <vox/vox_query.h>

/* ---- what a run finds, as bytes ---- */

typedef struct record {
    unsigned char* bytes;
    size_t size;
} record;

static void put(record* r, const void* data, size_t size) {
    r->bytes = (unsigned char*)realloc(r->bytes, r->size + size + 1);
    if (size > 0) memcpy(r->bytes + r->size, data, size);
    r->size += size;
}

/* ---- callbacks, which see the caller's environment ---- */

typedef struct callbacks {
    uint64_t state; /* the caller's */
    uint32_t calls[4], wrong[4];
    const float_mode* mode;
    vox_task* task;
    void* context;
    uint64_t items;
} callbacks;
enum { in_allocator, in_log, in_enqueue, in_finish };

static void note(callbacks* c, int which) {
    c->calls[which] += 1;
    c->wrong[which] += c->state != 0 && float_state() != c->state;
}

static void* noted_allocate(size_t size, size_t alignment, void* user) {
    note((callbacks*)user, in_allocator);
    return allocate_aligned(size, alignment);
}
static void noted_release(void* memory, size_t size, size_t alignment, void* user) {
    (void)size, (void)alignment, (void)user;
    free_aligned(memory);
}
static void noted_log(vox_log_level level, const char* text, void* user) {
    (void)level, (void)text;
    note((callbacks*)user, in_log);
}

/* Threads that have an environment of their own. */
static void* upper_half(void* user) {
    const callbacks* c = (const callbacks*)user;
    set_float_mode(c->mode);
    c->task(c->items / 2, c->items, 1, c->context);
    return NULL;
}
static void* noted_enqueue(vox_task* task, uint64_t items, uint64_t min_range, void* context, void* user) {
    callbacks* c = (callbacks*)user;
    (void)min_range;
    note(c, in_enqueue);
    c->task = task;
    c->context = context;
    c->items = items;
    return c;
}
static void noted_finish(void* handle, void* user) {
    callbacks* c = (callbacks*)user;
    pthread_t thread;
    ck_assert_ptr_eq(handle, user);
    note(c, in_finish);
    ck_assert_int_eq(pthread_create(&thread, NULL, upper_half, c), 0);
    c->task(0, c->items / 2, 0, c->context);
    pthread_join(thread, NULL);
    note(c, in_finish);
}

/* ---- scenes ---- */

static const float s = 0x1p-149f; /* the least float above 0 */

/* Makes the meshes of a scene; its positions may be static. */
static void insert(vox_grid* grid, const float_mode* mode, vox_mesh_desc desc) {
    vox_body mesh;
    ck_in_mode(mode, vox_mesh_insert(grid, &desc, &mesh));
}
static void insert_doubles(vox_grid* grid, const float_mode* mode, const double* positions, uint64_t vertices,
                           int has_tet) {
    vox_mesh_desc desc = vox_mesh_desc_floats(NULL, vertices, has_tet ? unit_tet : NULL, has_tet ? 1 : 0);
    desc.positions.data = positions;
    desc.positions.format = VOX_FORMAT_DOUBLE;
    insert(grid, mode, desc);
}

static void insert_odd_floats(vox_grid* grid, const float_mode* mode) {
    static float tiny[12], inside[6];
    static const float big[12] = {0, 0, 0, 0x1p101f, 0, 0, 0, 0x1p101f, 0, 0, 0, 0x1p101f};
    static const float far_away[9] = {-0x1p100f, 0x1p99f, 0x1p99f, 0x1p99f, 0x1p99f,
                                      -0x1p100f, 0x1p99f, 0x1p99f, 0x1p99f};
    for (int i = 0; i < 12; ++i) tiny[i] = unit_tet_positions[i] * 8 * s;
    for (int i = 0; i < 6; ++i) inside[i] = s;
    inside[3] = 9 * s;
    insert(grid, mode, vox_mesh_desc_floats(tiny, 4, unit_tet, 1));
    insert(grid, mode, vox_mesh_desc_floats(inside, 2, NULL, 0));
    insert(grid, mode, vox_mesh_desc_floats(big, 4, unit_tet, 1));
    insert(grid, mode, vox_mesh_desc_floats(far_away, 3, NULL, 0));
}

static void insert_odd_doubles(vox_grid* grid, const float_mode* mode) {
    static const double tets[3][12] = {{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1},
                                       {0, 0, 0x1p-1060, 1, 0, 0x1p-1050, 0, 1, 0x1p-1070, 0, 0, 1},
                                       {0, 0, 0, 1, 0, 0x1p-1074, 0, 1, 0, 0, 0, 1}};
    static const double points[3][6] = {{0.25, 0.25, 0x1p-1074, 0.25, 0.25, -0x1p-1074},
                                        {0.25, 0.25, 0x1p-1072, 0.25, 0.25, 0.25},
                                        {0.5, 0.25, 0.25, 0.25, 0.25, 0.25}};
    for (int i = 0; i < 3; ++i) {
        insert_doubles(grid, mode, tets[i], 4, 1);
        insert_doubles(grid, mode, points[i], 2, 0);
    }
}

/* Two boxes in one another, one folded into itself: every stage has something to round. */
static body boxes[2];
static void insert_boxes(vox_grid* grid, const float_mode* mode) {
    const double turned[12] = {0.8, -0.6, 0, 0.3, 0.6, 0.8, 0, 0.1, 0, 0, 1, 1.0 / 3};
    for (int i = 0; i < 2; ++i) {
        vox_body mesh;
        vox_mesh_desc desc = body_desc(&boxes[i]);
        vox_filter filter = plain_filter();
        filter.flags = (uint32_t)i ? VOX_FILTER_SELF_COLLISION : 0u;
        filter.self_rest_distance = 0.1;
        desc.filter = filter;
        ck_in_mode(mode, vox_mesh_insert(grid, &desc, &mesh));
        if (i == 0) ck_in_mode(mode, vox_body_set_transform(grid, mesh, turned));
    }
}

static void make_boxes(void) {
    boxes[0] = make_box(9, 0.17f, 0.1f, 0, 0.03f);
    boxes[1] = make_box(9, 0.15f, 0.3f, 0.4f, 0.7f);
    for (uint32_t v = 0; v < boxes[1].vertex_count; ++v)
        if (boxes[1].positions[3 * v] > 1.1f) boxes[1].positions[3 * v] = 2.0f - boxes[1].positions[3 * v];
}

static void (*const scenes[])(vox_grid*, const float_mode*) = {insert_odd_floats, insert_odd_doubles,
                                                               insert_boxes};
enum { scene_count = 3, scene_of_boxes = 2 };

/* ---- a run in one mode ---- */

#define put_view(r, mode, type, element, function)                                                           \
    do {                                                                                                     \
        type view_;                                                                                          \
        ck_in_mode(mode, function(grid, &view_));                                                            \
        put(r, &view_.count, sizeof view_.count);                                                            \
        put(r, view_.data, (size_t)view_.count * sizeof(element));                                           \
    } while (0)

static void put_answers(record* r, vox_grid* grid, const float_mode* mode) {
    enum { n = 4, room = 64 };
    static vox_point_hit points[room];
    static vox_box_hit boxes[room];
    static vox_ray_hit rays[room];
    const double at[n][3] = {{0.7, 0.6, 0.9}, {1.0 / 3, 0.5, 1.1}, {1, 1, 1}, {0x1p-1074, 0.25, 0.25}};
    const double far_away[n][3] = {{3, 3.1, 2.9}, {3, 3.1, 2.9}, {3, 3.1, 2.9}, {3, 3.1, 2.9}};
    const double a_third[3] = {1.0 / 3, 1.0 / 3, 2.0 / 3};
    const vox_positions from = vox_double_positions(at[0], n), to = vox_double_positions(far_away[0], n);
    const vox_positions low = vox_double_positions(a_third, 1), high = vox_double_positions(at[0], 1);
    vox_query_desc near = vox_default_query_desc();
    near.max_distance = 0.7;
    vox_closest_hit closest[n];
    uint8_t blocked[n];
    uint64_t count;
    vox_locator* locator = NULL;
    ck_in_mode(mode, vox_grid_update_locator(grid, &locator));
    ck_in_mode(mode, vox_locator_find_point_hits(locator, &from, NULL, points, room, &count));
    ck_assert_uint_le(count, room);
    put(r, points, (size_t)count * sizeof *points);
    ck_in_mode(mode, vox_locator_find_closest(locator, &from, &near, closest));
    put(r, closest, sizeof closest);
    ck_in_mode(mode, vox_locator_find_ray_hits(locator, &from, &to, NULL, rays, room, &count));
    ck_assert_uint_le(count, room);
    put(r, rays, (size_t)count * sizeof *rays);
    ck_in_mode(mode, vox_locator_test_rays(locator, &from, &to, NULL, blocked));
    put(r, blocked, sizeof blocked);
    ck_in_mode(mode, vox_locator_find_box_hits(locator, &low, &high, NULL, boxes, room, &count));
    put(r, &count, sizeof count);
    vox_locator_release(locator);
}

static record results(int scene, const float_mode* mode, uint32_t workers, callbacks* c) {
    record r = {NULL, 0};
    vox_grid* grid;
    vox_grid_desc desc = engine_desc();
    vox_cell_size_result suggestion;
    uint64_t size = 0;
    memset(c, 0, sizeof *c);
    memset(&suggestion, 0, sizeof suggestion);
    suggestion.struct_size = sizeof suggestion;
    c->mode = mode;
    set_float_mode(mode);
    c->state = float_state();
    set_float_mode(&float_modes[0]);
    const vox_allocator allocator = {noted_allocate, noted_release, c};
    desc.allocator = &allocator;
    const vox_log log = {noted_log, c};
    desc.log = &log;
    desc.flags = VOX_GRID_CONSTRAINTS;
    desc.worker_count = workers;
    const vox_task_system tasks = {noted_enqueue, noted_finish, c};
    if (workers > 1) desc.tasks = &tasks;
    ck_in_mode(mode, vox_grid_create(&desc, &grid));
    scenes[scene](grid, mode);
    ck_in_mode(mode, vox_grid_step(grid));
    put_view(&r, mode, vox_contact_view, vox_contact, vox_grid_get_contacts);
    put_view(&r, mode, vox_pair_view, vox_pair, vox_grid_get_pairs);
    put_view(&r, mode, vox_constraint_view, vox_constraint, vox_grid_get_constraints);
    vox_constraint_desc closest = vox_default_constraint_desc();
    closest.method = VOX_DEPTH_METHOD_CLOSEST;
    ck_in_mode(mode, vox_grid_find_constraints(grid, &closest));
    put_view(&r, mode, vox_constraint_view, vox_constraint, vox_grid_get_constraints);
    vox_grid_info info = {.struct_size = sizeof info};
    ck_in_mode(mode, vox_grid_get_info(grid, &info));
    put(&r, &info.cell_size, sizeof info.cell_size);
    if (scene == scene_of_boxes) {
        ck_in_mode(mode, vox_grid_suggest_cell_size(grid, NULL, &suggestion));
        put(&r, &suggestion, sizeof suggestion);
        vox_cell_size_desc suggest = vox_default_cell_size_desc();
        const vox_mesh_desc described[2] = {body_desc(&boxes[0]), body_desc(&boxes[1])};
        const uint32_t calls = c->calls[in_allocator];
        suggest.allocator = desc.allocator;
        ck_in_mode(mode, vox_suggest_cell_size(&suggest, described, 2, &suggestion));
        ck_assert_uint_gt(c->calls[in_allocator], calls);
        put(&r, &suggestion, sizeof suggestion);
    }
    put_answers(&r, grid, mode);
    ck_in_mode(mode, vox_grid_save(grid, NULL, 0, &size));
    void* bytes = malloc((size_t)size);
    ck_in_mode(mode, vox_grid_save(grid, bytes, size, &size));
    put(&r, bytes, (size_t)size);
    free(bytes);
    c->state = 0; /* destroying is no call that computes */
    vox_grid_destroy(grid);
    return r;
}

/* ---- tests ---- */

static void check_scene(int scene, uint32_t workers) {
    callbacks c;
    const record expected = results(scene, &float_modes[0], 1, &c);
    for (int m = 0; m < float_mode_count; ++m) {
        const record found = results(scene, &float_modes[m], workers, &c);
        ck_assert_msg(found.size == expected.size && memcmp(found.bytes, expected.bytes, found.size) == 0,
                      "scene %d, %s, %u workers: other results", scene, float_modes[m].name, workers);
        for (int i = 0; i < 4; ++i)
            ck_assert_msg(c.wrong[i] == 0, "scene %d, %s: %u of %u callbacks %d saw another environment",
                          scene, float_modes[m].name, c.wrong[i], c.calls[i], i);
        ck_assert_uint_gt(c.calls[in_allocator], 0);
        if (suite_engine == ENGINE_REFERENCE) ck_assert_uint_gt(c.calls[in_log], 0); /* the cell size */
        if (scene == scene_of_boxes && workers > 1 && suite_engine == ENGINE_FAST)
            ck_assert_uint_gt(c.calls[in_finish], 0);
        free(found.bytes);
    }
    free(expected.bytes);
}

START_TEST(same_bits_serial) {
    make_boxes();
    check_scene(_i, 1);
    for (int i = 0; i < 2; ++i) free_body(&boxes[i]);
}
END_TEST

START_TEST(same_bits_with_threads_that_have_their_own) {
    make_boxes();
    check_scene(scene_of_boxes, 2);
    for (int i = 0; i < 2; ++i) free_body(&boxes[i]);
}
END_TEST

/* Numbers of the caller's that only look like zero. */
START_TEST(arguments) {
    for (int m = 0; m < float_mode_count; ++m) {
        const float_mode* mode = &float_modes[m];
        vox_grid* grid = engine_grid();
        const double denormal = 0x1p-1074;
        vox_grid_info info = {.struct_size = sizeof info};
        ck_in_mode(mode, vox_grid_set_cell_size(grid, denormal));
        ck_in_mode(mode, vox_grid_get_info(grid, &info));
        ck_assert_mem_eq(&info.cell_size, &denormal, sizeof denormal);
        set_float_mode(mode);
        const vox_result negative = vox_grid_set_cell_size(grid, -denormal);
        set_float_mode(&float_modes[0]);
        ck_assert_msg(negative == VOX_ERROR_INVALID_ARGUMENT, "%s: %d", mode->name, (int)negative);
        vox_grid_destroy(grid);
    }
}
END_TEST

/* Flags that the caller has raised stay, and the library raises none. */
START_TEST(flags) {
    make_boxes();
    (void)feclearexcept(FE_ALL_EXCEPT); /* those that making the boxes raised */
    (void)feraiseexcept(FE_DIVBYZERO);
    vox_grid* grid = engine_grid();
    const vox_mesh_desc desc = body_desc(&boxes[1]);
    insert_mesh(grid, &desc);
    ck_ok(vox_grid_step(grid));
    ck_assert_int_eq(fetestexcept(FE_ALL_EXCEPT), FE_DIVBYZERO);
    vox_grid_destroy(grid);
    for (int i = 0; i < 2; ++i) free_body(&boxes[i]);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_loop_test(tests, same_bits_serial, 0, scene_count);
    tcase_add_each(tests, same_bits_with_threads_that_have_their_own, arguments, flags);
}

SUITE(float_environment) { add_for_each_engine(suite, add_tests); }
