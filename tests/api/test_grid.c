/* Life of grids and meshes, and every function with every bad argument. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scenes/bodies.h"
#include "support/suite.h"

/* ---- words and numbers ---- */

START_TEST(version) {
    char text[64];
    ck_assert_uint_eq(vox_version(),
                      VOX_VERSION_MAJOR * 1000000 + VOX_VERSION_MINOR * 1000 + VOX_VERSION_PATCH);
    snprintf(text, sizeof text, "%d.%d.%d", VOX_VERSION_MAJOR, VOX_VERSION_MINOR, VOX_VERSION_PATCH);
    ck_assert_uint_eq(vox_abi_version(), VOX_ABI_VERSION);
    ck_assert_ptr_nonnull(strstr(vox_build_info(), text));
    ck_assert_ptr_null(strstr(vox_build_info(), " ,"));
}
END_TEST

START_TEST(result_names) {
    for (int r = VOX_ERROR_INTERNAL; r < 0; ++r)
        ck_assert_int_eq(strncmp(vox_result_string((vox_result)r), "VOX_ERROR_", 10), 0);
    ck_assert_str_eq(vox_result_string(VOX_OK), "VOX_OK");
    ck_assert_str_eq(vox_result_string((vox_result)77), "unknown vox_result");
}
END_TEST

START_TEST(last_error) {
    char longer[3000];
    memset(longer, 'x', sizeof longer);
    longer[sizeof longer - 1] = 0;
    ck_assert_int_eq(vox_fail(VOX_ERROR_FILE, "one"), VOX_ERROR_FILE);
    ck_assert_str_eq(vox_last_error(), "one");
    ck_assert_int_eq(vox_fail(VOX_ERROR_FILE, vox_last_error()), VOX_ERROR_FILE);
    ck_assert_str_eq(vox_last_error(), "one");
    vox_fail(VOX_ERROR_FILE, longer);
    ck_assert_uint_eq(strlen(vox_last_error()), 1023);
    vox_fail(VOX_ERROR_FILE, NULL);
    ck_assert_str_eq(vox_last_error(), "");
}
END_TEST

/* Wherever a text is cut, the end is that of a character of UTF-8. */
START_TEST(last_error_of_whole_characters) {
    static const char* const characters[] = {"x", "\xc3\xa9", "\xe2\x82\xac", "\xf0\x9f\xa7\x8a"};
    for (size_t size = 1; size <= 4; ++size)
        for (size_t before = 1018; before <= 1024; ++before) {
            char text[1100];
            memset(text, 'x', before);
            for (size_t i = 0; i < 4; ++i) memcpy(text + before + i * size, characters[size - 1], size);
            text[before + 4 * size] = 0;
            size_t expected = before > 1023 ? 1023 : before;
            for (int i = 0; i < 4 && expected + size <= 1023; ++i) expected += size;
            vox_fail(VOX_ERROR_FILE, text);
            ck_assert_uint_eq(strlen(vox_last_error()), expected);
            ck_assert_int_eq(memcmp(vox_last_error(), text, expected), 0);
            /* The part of a character that the caller's own text ends with is the caller's. */
            text[1023] = 0;
            vox_fail(VOX_ERROR_FILE, text);
            ck_assert_str_eq(vox_last_error(), text);
        }
    char no_utf8[1100];
    memset(no_utf8, 0x80, sizeof no_utf8);
    no_utf8[sizeof no_utf8 - 1] = 0;
    vox_fail(VOX_ERROR_FILE, no_utf8);
    ck_assert_uint_eq(strlen(vox_last_error()), 1023);
}
END_TEST

/* ---- growable structs ---- */

START_TEST(struct_sizes) {
    /* A desc of an older program: fields beyond its size have their defaults. */
    unsigned char bytes[sizeof(vox_grid_desc) + 64];
    vox_grid_desc* desc = (vox_grid_desc*)(void*)bytes;
    const uint32_t old = offsetof(vox_grid_desc, margin);
    memset(bytes, 0xab, sizeof bytes);
    const vox_grid_desc whole = vox_default_grid_desc();
    memcpy(desc, &whole, old);
    desc->struct_size = old;
    desc->cell_size = 0.25;
    vox_grid* grid = grid_of(desc); /* the margin and the allocator behind it are not read */
    ck_assert_double_eq(grid_info(grid).cell_size, 0.25);
    vox_grid_destroy(grid);

    /* A desc of a newer program: what this version does not know is not read. */
    memset(bytes, 0xab, sizeof bytes);
    *desc = whole;
    desc->struct_size = sizeof bytes;
    ck_ok(vox_grid_create(desc, &grid));

    /* The same for results. */
    vox_grid_info info[2];
    memset(info, 0xab, sizeof info);
    info[0].struct_size = offsetof(vox_grid_info, cell_size);
    ck_ok(vox_grid_get_info(grid, info));
    ck_assert_uint_eq(info[0].struct_size, offsetof(vox_grid_info, cell_size));
    ck_assert_uint_lt(info[0].epoch, 9);
    ck_assert_uint_eq(info[0].bytes, 0xababababababababu);
    info[0].struct_size = sizeof info;
    ck_ok(vox_grid_get_info(grid, info));
    ck_assert_uint_gt(info[0].bytes, 0);
    ck_assert_uint_eq(info[1].struct_size, 0xabababab);
    vox_grid_destroy(grid);

    const uint32_t bad[] = {0, 3, 65537, 0xffffffff};
    for (int i = 0; i < 4; ++i) {
        vox_grid_desc odd = whole;
        odd.struct_size = bad[i];
        ck_fails(vox_grid_create(&odd, &grid), VOX_ERROR_INVALID_ARGUMENT, "struct_size");
    }
}
END_TEST

/* ---- bad arguments ---- */

START_TEST(grid_desc_fields) {
    vox_grid* const untouched = (vox_grid*)(uintptr_t)16;
    vox_grid* grid = untouched;
#define REFUSED(change, words)                                                                               \
    do {                                                                                                     \
        vox_reference_desc reference = vox_default_reference_desc();                                         \
        vox_allocator allocator = VOX_ZERO;                                                                  \
        vox_grid_desc desc = vox_default_grid_desc();                                                        \
        desc.reference = &reference;                                                                         \
        desc.allocator = &allocator;                                                                         \
        change;                                                                                              \
        ck_fails(vox_grid_create(&desc, &grid), VOX_ERROR_INVALID_ARGUMENT, words);                          \
        ck_assert_ptr_eq(grid, untouched);                                                                   \
    } while (0)
    REFUSED(desc.struct_size = 0, "struct_size is 0");
    REFUSED(desc.max_constraints_per_pair = 257, "max_constraints_per_pair is 257, expected at most 256");
    REFUSED(reference.flags = 7, "reference flags is 0x7, of which 0x4 is unknown");
    REFUSED(reference.struct_size = 3, "reference.struct_size is 3");
    REFUSED(desc.cell_size = -1, "cell_size is -1");
    REFUSED(desc.cell_size = NAN, "cell_size is");
    REFUSED(desc.cell_size = INFINITY, "cell_size is inf");
    REFUSED(reference.world_min[1] = NAN, "axis");
    REFUSED(reference.world_max[2] = 1, "[0, 0] on axis 0");
    REFUSED(reference.world_max[2] = INFINITY, "axis");
    REFUSED((reference.world_min[0] = 2, reference.world_max[0] = 1), "[2, 1] on axis 0");
    REFUSED(reference.hash_table_size = UINT64_MAX, "hash_table_size is 18446744073709551615");
    REFUSED(allocator.allocate = (void* (*)(size_t, size_t, void*))(uintptr_t)8, "allocator");
#undef REFUSED
    vox_grid_desc tiny = vox_default_grid_desc();
    tiny.byte_budget = 16;
    ck_fails(vox_grid_create(&tiny, &grid), VOX_ERROR_BUDGET, "budget is 16");
    ck_assert_ptr_eq(grid, untouched);
    ck_fails(vox_grid_create(NULL, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_grid is null");
}
END_TEST

START_TEST(counters_have_names) {
    vox_grid* grid = grid_of(NULL);
    vox_counter_view before, after;
    ck_ok(vox_grid_get_counters(grid, &before));
    ck_assert_uint_gt(before.count, 40);
    for (uint64_t i = 0; i < before.count; ++i) {
        ck_assert_uint_eq(before.data[i].value, 0);
        for (uint64_t j = 0; j < i; ++j) ck_assert_str_ne(before.data[i].name, before.data[j].name);
    }
    const vox_mesh_desc desc = vox_mesh_desc_floats(unit_tet_positions, 4, unit_tet, 1);
    (void)insert_mesh(grid, &desc);
    ck_ok(vox_grid_step(grid));
    ck_ok(vox_grid_get_counters(grid, &after));
    ck_assert_uint_eq(after.count, before.count);
    ck_assert_str_eq(after.data[2].name, "tets");
    ck_assert_uint_eq(after.data[2].value, 1);
    ck_assert_uint_eq(counter_of(grid, "vertices"), 4);
    ck_assert_uint_gt(counter_of(grid, "step_ns"), 0);
    vox_grid_destroy(grid);
}
END_TEST

START_TEST(null_arguments) {
    vox_grid* grid = grid_of(NULL);
    vox_mesh_desc desc = vox_mesh_desc_floats(unit_tet_positions, 4, unit_tet, 1);
    vox_body other = 77;
    uint64_t count = 5;
    vox_contact_view view = {NULL, 3, NULL};
    vox_grid_info info = {.struct_size = sizeof info, .epoch = 9};
    vox_counter_view counters = {NULL, 9};
    vox_body mesh = insert_mesh(grid, &desc);

    const vox_result bad = VOX_ERROR_INVALID_ARGUMENT;
    ck_fails(vox_grid_clear(NULL), bad, "grid is null");
    ck_fails(vox_grid_set_cell_size(NULL, 1), bad, "grid is null");
    ck_fails(vox_mesh_insert(NULL, &desc, &other), bad, "grid is null");
    ck_fails(vox_mesh_insert(grid, NULL, &other), bad, "desc is null");
    ck_fails(vox_mesh_insert(grid, &desc, NULL), bad, "out_body is null");
    ck_fails(vox_body_remove(NULL, mesh), bad, "grid is null");
    ck_fails(vox_body_get_user_data(NULL, mesh, &count), bad, "grid is null");
    ck_fails(vox_body_get_user_data(grid, mesh, NULL), bad, "out_user_data is null");
    ck_fails(bind_array(NULL, mesh, unit_tet_positions, VOX_FORMAT_FLOAT, 0, 0), bad, "grid is null");
    ck_fails(bind_array(grid, mesh, NULL, VOX_FORMAT_FLOAT, 0, 0), bad, "positions.data is null");
    ck_fails(bind_array(grid, mesh, unit_tet_positions, (vox_format)9, 0, 0), bad, "format is 9");
    ck_fails(bind_array(grid, mesh, unit_tet_positions, VOX_FORMAT_FLOAT, 11, 0), bad, "stride is 11");
    ck_fails(bind_array(grid, mesh, unit_tet_positions, VOX_FORMAT_FLOAT, UINT64_MAX, 0), bad,
             "stride is 18446744073709551615");
    ck_fails(vox_grid_step(NULL), bad, "grid is null");
    ck_fails(vox_grid_get_contacts(NULL, &view), bad, "grid is null");
    ck_fails(vox_grid_get_contacts(grid, NULL), bad, "out_view is null");
    ck_fails(vox_grid_get_hash(NULL, &count), bad, "grid is null");
    ck_fails(vox_grid_get_hash(grid, NULL), bad, "out_hash is null");
    ck_fails(vox_grid_get_info(NULL, &info), bad, "grid is null");
    ck_fails(vox_grid_get_info(grid, NULL), bad, "out_info is null");
    ck_fails(vox_grid_get_counters(NULL, &counters), bad, "grid is null");
    ck_fails(vox_grid_get_counters(grid, NULL), bad, "out_view is null");
    info.struct_size = 0;
    ck_fails(vox_grid_get_info(grid, &info), bad, "struct_size is 0");
    const double sizes[] = {-1, NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 4; ++i) ck_fails(vox_grid_set_cell_size(grid, sizes[i]), bad, "cell_size is");
    ck_assert_uint_eq(vox_body_is_valid(NULL, mesh), 0);
    vox_grid_destroy(NULL);

    /* Nothing was written, nothing has changed. */
    ck_assert_uint_eq(other, 77);
    ck_assert_uint_eq(info.epoch, 9);
    ck_assert_uint_eq(count, 5);
    ck_assert_uint_eq(view.count, 3);
    ck_assert_uint_eq(counters.count, 9);
    ck_assert_uint_eq(grid_info(grid).epoch, 0);
    ck_assert_uint_eq(vox_body_is_valid(grid, mesh), 1);
    ck_ok(vox_grid_step(grid));
    vox_grid_destroy(grid);
}
END_TEST

START_TEST(mesh_desc_fields) {
    vox_grid* grid = grid_of(NULL);
    vox_body mesh = 77;
    uint32_t tets[8] = {0, 1, 2, 3, 0, 1, 2, 4};
#define REFUSED(change, code, words)                                                                         \
    do {                                                                                                     \
        vox_mesh_desc desc = vox_mesh_desc_floats(unit_tet_positions, 4, unit_tet, 1);                       \
        change;                                                                                              \
        ck_fails(vox_mesh_insert(grid, &desc, &mesh), code, words);                                          \
        ck_assert_uint_eq(mesh, 77);                                                                         \
    } while (0)
    REFUSED(desc.struct_size = 0, VOX_ERROR_INVALID_ARGUMENT, "struct_size is 0");
    REFUSED(desc.flags = 0x80, VOX_ERROR_INVALID_ARGUMENT, "0x80");
    REFUSED(desc.positions.reserved = 3, VOX_ERROR_INVALID_ARGUMENT, "reserved is 3");
    REFUSED(desc.positions.format = (vox_format)4, VOX_ERROR_INVALID_ARGUMENT, "format is 4");
    REFUSED(desc.positions.byte_stride = 8, VOX_ERROR_INVALID_ARGUMENT, "stride is 8");
    REFUSED(desc.tets = NULL, VOX_ERROR_INVALID_ARGUMENT, "tets is null");
    REFUSED(desc.positions.count = 1ull << 40, VOX_ERROR_LIMIT, "positions.count is 1099511627776");
    REFUSED(desc.tet_count = 1ull << 62, VOX_ERROR_LIMIT, "tet_count is 4611686018427387904");
    REFUSED((desc.tets = tets, desc.tet_count = 2), VOX_ERROR_INVALID_MESH, "tet 1 names vertex 4 of 4");
    REFUSED(desc.positions.count = 0, VOX_ERROR_INVALID_MESH, "tet 0 names vertex 0 of 0");
#undef REFUSED
    ck_ok(vox_grid_step(grid));
    grid_counts counters = counters_of(grid);
    ck_assert_uint_eq(counters.bodies, 0);
    vox_grid_destroy(grid);
}
END_TEST

/* ---- body ids ---- */

START_TEST(ids) {
    vox_grid* grid = grid_of(NULL);
    vox_grid* foreign = grid_of(NULL);
    const vox_mesh_desc desc = vox_mesh_desc_floats(unit_tet_positions, 4, unit_tet, 1);
    vox_body elsewhere = 0;
    vox_body a = insert_mesh(grid, &desc);
    vox_body b = insert_mesh(grid, &desc);
    for (int i = 0; i < 3; ++i) ck_ok(vox_mesh_insert(foreign, &desc, &elsewhere));
    ck_assert_uint_ne(a, VOX_NULL_BODY);
    ck_assert_uint_lt(a, b);

    const vox_body wrong[] = {VOX_NULL_BODY, elsewhere, 0xffffffffu, a + 1, b ^ 0x800u};
    uint64_t data = 5;
    for (int i = 0; i < 5; ++i) {
        ck_fails(vox_body_remove(grid, wrong[i]), VOX_ERROR_INVALID_HANDLE, "body id");
        ck_fails(vox_body_get_user_data(grid, wrong[i], &data), VOX_ERROR_INVALID_HANDLE, "body id");
        ck_fails(bind_array(grid, wrong[i], unit_tet_positions, VOX_FORMAT_FLOAT, 0, 0),
                 VOX_ERROR_INVALID_HANDLE, "body id");
        ck_assert_uint_eq(vox_body_is_valid(grid, wrong[i]), 0);
    }
    ck_ok(vox_body_remove(grid, a));
    ck_fails(vox_body_remove(grid, a), VOX_ERROR_INVALID_HANDLE, "stale");
    vox_body c = insert_mesh(grid, &desc); /* takes a's slot, not a's id */
    ck_assert_uint_ne(c, a);
    ck_assert_uint_lt(c, b);
    ck_assert_uint_eq(vox_body_is_valid(grid, a), 0);
    ck_ok(vox_grid_clear(grid));
    ck_assert_uint_eq(vox_body_is_valid(grid, b), 0);
    ck_assert_uint_eq(vox_body_is_valid(grid, c), 0);
    vox_grid_destroy(grid);
    vox_grid_destroy(foreign);
}
END_TEST

START_TEST(generations_run_out) {
    enum { most_uses = 4095 }; /* of a slot */
    vox_grid* grid = grid_of(NULL);
    const vox_mesh_desc desc = vox_default_mesh_desc();
    vox_body mesh = 0;
    vox_body first = insert_mesh(grid, &desc);
    ck_ok(vox_body_remove(grid, first));
    for (uint32_t use = 2; use <= most_uses; ++use) {
        ck_ok(vox_mesh_insert(grid, &desc, &mesh));
        ck_assert_uint_eq(vox_body_slot(mesh), 0);
        ck_ok(vox_body_remove(grid, mesh));
    }
    vox_body last = insert_mesh(grid, &desc); /* the slot is retired: another one */
    ck_assert_uint_eq(vox_body_slot(last), 1);
    ck_assert_uint_eq(vox_body_is_valid(grid, first), 0);
    ck_assert_uint_eq(vox_body_is_valid(grid, mesh), 0);
    vox_grid_destroy(grid);
}
END_TEST

START_TEST(user_data) {
    vox_grid* grid = grid_of(NULL);
    vox_mesh_desc desc = vox_default_mesh_desc();
    desc.user_data = 0x123456789abcdef0u;
    uint64_t data = 0;
    vox_body mesh = insert_mesh(grid, &desc);
    ck_ok(vox_body_get_user_data(grid, mesh, &data));
    ck_assert_uint_eq(data, 0x123456789abcdef0u);
    vox_grid_destroy(grid);
}
END_TEST

/* What a grid says of itself is what it was told, and what its counters say of its last step. */
START_TEST(info_of_the_last_step) {
    vox_grid_desc desc = engine_desc();
    desc.flags |= VOX_GRID_SKIP_BAD_BODIES | VOX_GRID_CONSTRAINTS;
    desc.margin = 0.125;
    vox_grid* grid = grid_of(&desc);
    const vox_mesh_desc mesh = vox_mesh_desc_floats(unit_tet_positions, 4, unit_tet, 1);
    static const float infinite[12] = {INFINITY};
    const vox_mesh_desc bad = vox_mesh_desc_floats(infinite, 4, unit_tet, 1);
    insert_mesh(grid, &mesh);
    const vox_body second = insert_mesh(grid, &mesh);
    insert_mesh(grid, &bad);
    ck_ok(vox_grid_step(grid));
    ck_ok(vox_grid_set_flags(grid, VOX_GRID_SKIP_BAD_BODIES));
    ck_ok(vox_body_remove(grid, second));
    ck_ok(vox_grid_step(grid));
    const vox_grid_info info = grid_info(grid);
    grid_counts counters;
    grid_times profile;
    counters = counters_of(grid);
    profile = times_of(grid);
    ck_assert_uint_eq(info.struct_size, sizeof info);
    ck_assert_uint_eq(info.flags, VOX_GRID_SKIP_BAD_BODIES);
    ck_assert_uint_eq(info.epoch, 3); /* two steps and a change of the flags */
    ck_assert_double_eq(info.margin, 0.125);
    ck_assert_uint_eq(info.skipped_bodies, 1);
    ck_assert_uint_eq(info.total_began, 1);
    ck_assert_uint_eq(info.total_ended, 1);
    ck_assert_uint_gt(info.bytes, 0);
    ck_assert_uint_eq(info.bytes, counters.bytes);
    ck_assert_uint_eq(info.peak_bytes, counters.peak_bytes);
    ck_assert_uint_eq(info.moved_bodies, counters.moved_bodies);
    ck_assert_uint_gt(info.step_ns, 0);
    ck_assert_uint_eq(info.step_ns, profile.step_ns);
    vox_grid_destroy(grid);
}
END_TEST

/* ---- cell size ---- */

static char logged[256];
static int log_lines;
static void keep_line(vox_log_level level, const char* text, void* user) {
    ck_assert_int_eq(level, VOX_LOG_INFO);
    ck_assert_ptr_eq(user, logged);
    snprintf(logged, sizeof logged, "%s", text);
    ++log_lines;
}

START_TEST(cell_size_is_chosen) {
    vox_grid_desc desc = vox_default_grid_desc();
    use_engine(&desc, ENGINE_REFERENCE);
    const vox_log log = {keep_line, logged};
    desc.log = &log;
    body box = make_box(4, 0.5f, 0, 0, 0);
    vox_mesh_desc mesh_desc = body_desc(&box);
    double cell_size = -1, again = -1;
    vox_grid* grid = grid_of(&desc);
    cell_size = grid_info(grid).cell_size;
    ck_assert_double_eq(cell_size, 0); /* none yet */
    vox_body mesh = insert_mesh(grid, &mesh_desc);
    ck_ok(vox_grid_step(grid));
    cell_size = grid_info(grid).cell_size;

    /* The model of its engine: over a sample here, over all there. */
    vox_cell_size_result suggestion = {.struct_size = sizeof suggestion};
    ck_ok(vox_grid_suggest_cell_size(grid, NULL, &suggestion));
    vox_cell_size_desc named = vox_default_cell_size_desc();
    vox_cell_size_result same = {.struct_size = sizeof same};
    named.model = VOX_COST_MODEL_REFERENCE;
    ck_ok(vox_grid_suggest_cell_size(grid, &named, &same));
    ck_assert_double_eq(suggestion.cost, same.cost);
    named.model = VOX_COST_MODEL_FAST;
    ck_ok(vox_grid_suggest_cell_size(grid, &named, &same));
    ck_assert_double_ne(suggestion.cost, same.cost);
    ck_assert_double_ge(cell_size, suggestion.zone_min);
    ck_assert_double_le(cell_size, suggestion.zone_max);
    ck_assert_int_eq(log_lines, 1);
    ck_assert_ptr_nonnull(strstr(logged, "cell size"));

    ck_ok(vox_grid_step(grid)); /* nothing new: not chosen again */
    ck_assert_int_eq(log_lines, 1);
    body fine = make_box(8, 0.0625f, 5, 0, 0);
    mesh_desc = body_desc(&fine);
    ck_ok(vox_mesh_insert(grid, &mesh_desc, &mesh));
    ck_ok(vox_grid_step(grid));
    ck_assert_int_eq(log_lines, 2);
    again = grid_info(grid).cell_size;
    ck_assert_double_lt(again, cell_size);

    ck_ok(vox_grid_set_cell_size(grid, 3));
    ck_ok(vox_grid_step(grid));
    again = grid_info(grid).cell_size;
    ck_assert_double_eq(again, 3);
    ck_assert_int_eq(log_lines, 2);
    vox_grid_destroy(grid);
    free_body(&box);
    free_body(&fine);
}
END_TEST

START_TEST(cell_size_without_extent) {
    /* Meshes that suggest nothing: the grid still steps. */
    const float point[12] = {1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3};
    vox_grid_desc grid_desc = vox_default_grid_desc();
    use_engine(&grid_desc, ENGINE_REFERENCE);
    vox_grid* grid = grid_of(&grid_desc);
    ck_ok(vox_grid_step(grid));
    vox_mesh_desc desc = vox_mesh_desc_floats(point, 4, NULL, 0);
    vox_body mesh = insert_mesh(grid, &desc);
    ck_ok(vox_grid_step(grid));
    desc = vox_mesh_desc_floats(point, 4, unit_tet, 1);
    ck_ok(vox_mesh_insert(grid, &desc, &mesh));
    ck_ok(vox_grid_step(grid));
    grid_counts counters = counters_of(grid);
    ck_assert_uint_eq(counters.contacts, 0);
    ck_assert_uint_eq(counters.skipped_degenerate, 1);
    vox_grid_destroy(grid);
}
END_TEST

SUITE(grid) {
    TCase* tests = add_case(suite, "grid");
    tcase_add_each(tests, version, result_names, last_error, last_error_of_whole_characters, struct_sizes,
                   grid_desc_fields, counters_have_names, null_arguments, mesh_desc_fields, ids,
                   generations_run_out, user_data, info_of_the_last_step, cell_size_is_chosen,
                   cell_size_without_extent);
}
