/* What is easily got wrong is refused or said: doubles under the format of floats, structs that were zeroed,
 * meshes whose edges and faces collide with nothing. And whether a contact is interior. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scenes/bodies.h"
#include "support/ledger.h"
#include "support/locators.h"
#include "support/oracle.h"

/* ---- the log ---- */

typedef struct lines {
    char text[4096];
    uint32_t warnings;
    vox_log log;
} lines;

static void keep_line(vox_log_level level, const char* text, void* user) {
    lines* l = (lines*)user;
    if (level != VOX_LOG_WARNING) return;
    ++l->warnings;
    snprintf(l->text + strlen(l->text), sizeof l->text - strlen(l->text), "%s\n", text);
}

static const vox_log* log_to(lines* l) {
    memset(l, 0, sizeof *l);
    l->log.write = keep_line;
    l->log.user = l;
    return &l->log;
}

static int says(const lines* l, const char* words) { return strstr(l->text, words) != NULL; }

/* ---- doubles and floats ---- */

/* In doubles, of one decimal and scaled, as programs have them. */
static double* doubles_of(const body* b, double scale) {
    double* positions = (double*)malloc(3 * sizeof(double) * b->vertex_count);
    for (size_t i = 0; i < 3 * (size_t)b->vertex_count; ++i)
        positions[i] = scale * (round(10 * (double)b->positions[i]) / 10);
    return positions;
}

START_TEST(doubles_under_floats_are_refused) {
    body box = make_box(4, 0.3f, 0.1f, 0.2f, 0.3f), other = make_box(4, 0.3f, 0.5f, 0.4f, 0.3f);
    const double scales[] = {1, 0.1, 1e-3, 3e5 / 7, 3.7};
    for (size_t i = 0; i < sizeof scales / sizeof *scales; ++i) {
        double* positions = doubles_of(&box, scales[i]);
        vox_mesh_desc desc = vox_mesh_desc_doubles(positions, box.vertex_count, box.tets, box.tet_count);
        vox_cell_size_result suggestion;
        vox_body mesh = VOX_NULL_BODY;
        desc.user_data = 77;
        desc.positions.format = VOX_FORMAT_FLOAT; /* the mistake */
        suggestion.struct_size = sizeof suggestion;

        /* At the first step that reads them, as borrowed ones may be written until then. */
        vox_grid* grid = engine_grid();
        vox_mesh_desc good =
            vox_mesh_desc_floats(other.positions, other.vertex_count, other.tets, other.tet_count);
        (void)insert_mesh(grid, &good);
        mesh = insert_mesh(grid, &desc);
        ck_fails(vox_grid_step(grid), VOX_ERROR_INVALID_ARGUMENT, "its positions are doubles");
        ck_assert_ptr_nonnull(strstr(vox_last_error(), "body 4097 (slot 1, user data 77)"));
        vox_failure failure;
        failure.struct_size = sizeof failure;
        ck_ok(vox_grid_get_failure(grid, 0, &failure));
        ck_assert_int_eq(failure.result, VOX_ERROR_INVALID_ARGUMENT);
        ck_assert_uint_eq(failure.body, mesh);
        ck_assert_uint_eq(failure.vertex, VOX_NONE);
        ck_fails(vox_grid_suggest_cell_size(grid, NULL, &suggestion), VOX_ERROR_INVALID_ARGUMENT,
                 "are doubles");
        vox_locator* locator = NULL;
        ck_fails(vox_grid_update_locator(grid, &locator), VOX_ERROR_INVALID_ARGUMENT, "are doubles");
        ck_assert_ptr_null(locator);
        ck_ok(vox_mesh_bind_doubles(grid, mesh, positions, desc.positions.count));
        ck_ok(vox_grid_step(grid));
        ck_ok(vox_mesh_bind_floats(grid, mesh, (const float*)(const void*)positions, desc.positions.count));
        ck_fails(vox_grid_step(grid), VOX_ERROR_INVALID_ARGUMENT, "are doubles");

        /* At once where they are copied, and where only they are used. */
        desc.flags = VOX_MESH_COPY_POSITIONS;
        ck_fails(vox_mesh_insert(grid, &desc, &mesh), VOX_ERROR_INVALID_ARGUMENT, "are doubles");
        ck_fails(vox_suggest_cell_size(NULL, &desc, 1, &suggestion), VOX_ERROR_INVALID_ARGUMENT,
                 "mesh 0 (user data 77): its positions are doubles");
        vox_grid_destroy(grid);
        free(positions);
    }
    free_body(&box);
    free_body(&other);
}
END_TEST

/* A mesh that is too small to tell is looked at again when it has grown. */
START_TEST(doubles_that_come_later) {
    body box = make_box(4, 0.3f, 0.1f, 0.2f, 0.3f);
    double* positions = doubles_of(&box, 0.1);
    for (uint64_t before = 0; before <= 8; before += 8) {
        vox_grid* grid = engine_grid();
        vox_mesh_desc desc = vox_mesh_desc_floats((const float*)(const void*)positions, before, NULL, 0);
        desc.flags = VOX_MESH_COPY_POSITIONS;
        const vox_body mesh = insert_mesh(grid, &desc);
        ck_ok(vox_grid_step(grid));
        vox_vertices_desc vertices = vox_default_vertices_desc();
        uint32_t first;
        vertices.count = box.vertex_count - before;
        vertices.positions =
            vox_float_positions((const float*)(const void*)positions + 3 * before, vertices.count);
        ck_ok(vox_mesh_append_vertices(grid, mesh, &vertices, &first));
        ck_fails(vox_grid_step(grid), VOX_ERROR_INVALID_ARGUMENT, "are doubles");
        vox_grid_destroy(grid);
    }
    free(positions);
    free_body(&box);
}
END_TEST

/* Floats of any size are taken: alike, of every size at once, tiny, huge, zeros. */
START_TEST(floats_are_never_refused) {
    body box = make_box(4, 0.25f, 0, 0, 0);
    const float scales[] = {1, 1e-30f, 1e30f, 0x1p-140f, 0x1p100f};
    float* positions = (float*)malloc(3 * sizeof(float) * box.vertex_count);
    vox_grid* grid = engine_grid();
    const vox_mesh_desc desc = vox_mesh_desc_floats(positions, box.vertex_count, box.tets, box.tet_count);
    uint64_t random = 5;
    for (int axes = 1; axes < 8; ++axes) /* scaled or wild along some axes, as they are along the others */
        for (size_t s = 0; s < sizeof scales / sizeof *scales + 2; ++s) {
            for (size_t i = 0; i < 3 * (size_t)box.vertex_count; ++i) {
                positions[i] = box.positions[i];
                if (!(axes & 1 << i % 3)) continue;
                if (s < sizeof scales / sizeof *scales)
                    positions[i] *= scales[s];
                else
                    do
                        random = random * 6364136223846793005u + 1442695040888963407u,
                        memcpy(&positions[i], (char*)&random + 4, sizeof(float));
                    while (!isfinite(positions[i]));
            }
            const vox_body mesh = insert_mesh(grid, &desc); /* another one, as each is looked at once */
            ck_ok(vox_grid_step(grid));
            ck_ok(vox_body_remove(grid, mesh));
        }
    vox_grid_destroy(grid);
    free(positions);
    free_body(&box);
}
END_TEST

/* A mesh whose borrowed memory holds doubles when it is inserted, and floats when it is stepped, is fine. */
START_TEST(what_the_memory_held_before_does_not_matter) {
    body box = make_box(4, 0.3f, 0.1f, 0.2f, 0.3f);
    double* memory = doubles_of(&box, 0.1);
    vox_grid* grid = engine_grid();
    const vox_mesh_desc desc =
        vox_mesh_desc_floats((const float*)(const void*)memory, box.vertex_count, box.tets, box.tet_count);
    (void)insert_mesh(grid, &desc);
    memcpy(memory, box.positions, 3 * sizeof(float) * box.vertex_count);
    ck_ok(vox_grid_step(grid));
    vox_grid_destroy(grid);
    free(memory);
    free_body(&box);
}
END_TEST

START_TEST(typed_helpers) {
    const float floats[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const double doubles[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const uint32_t tets[4] = {0, 1, 2, 3};
    vox_mesh_desc expected = vox_default_mesh_desc();
    expected.positions.data = floats;
    expected.positions.count = 4;
    expected.tets = tets;
    expected.tet_count = 1;
    vox_mesh_desc desc = vox_mesh_desc_floats(floats, 4, tets, 1);
    ck_assert_mem_eq(&desc, &expected, sizeof desc);
    expected.positions.data = doubles;
    expected.positions.format = VOX_FORMAT_DOUBLE;
    desc = vox_mesh_desc_doubles(doubles, 4, tets, 1);
    ck_assert_mem_eq(&desc, &expected, sizeof desc);
}
END_TEST

/* ---- zeroed structs ---- */

/* Zeroed structs are the defaults, so nothing is refused and nothing said. */
START_TEST(zero_is_the_default) {
    body box = make_box(2, 0.5f, 0, 0, 0), other = make_box(2, 0.5f, 0.3f, 0.3f, 0.3f);
    lines log;
    vox_grid_desc settings;
    memset(&settings, 0, sizeof settings);
    settings.struct_size = sizeof settings;
    settings.log = log_to(&log);
    vox_grid *grid = grid_of(&settings), *usual = grid_of(NULL);
    vox_mesh_desc a = body_desc(&box), b = body_desc(&other);
    memset(&a.filter, 0, sizeof a.filter);
    for (int g = 0; g < 2; ++g) {
        (void)insert_mesh(g ? usual : grid, &a);
        const vox_body mesh = insert_mesh(g ? usual : grid, &b);
        if (!g) ck_ok(vox_body_set_filter(grid, mesh, &a.filter));
    }
    const uint64_t hash = hash_of_step(grid);
    ck_assert_uint_gt(contacts_of(grid).count, 0);
    ck_assert_uint_eq(hash, hash_of_step(usual));
    vox_constraint_desc wanted;
    memset(&wanted, 0, sizeof wanted);
    wanted.struct_size = sizeof wanted;
    ck_ok(vox_grid_find_constraints(grid, &wanted));
    ck_ok(vox_grid_find_constraints(usual, NULL));
    const vox_constraint_view found = constraints_of(grid), expected = constraints_of(usual);
    ck_assert_uint_gt(found.count, 0);
    ck_assert_uint_eq(found.count, expected.count);
    ck_assert_mem_eq(found.data, expected.data, found.count * sizeof *found.data);
    ck_assert_uint_eq(log.warnings, 0);
    vox_grid_destroy(grid);
    vox_grid_destroy(usual);

    /* Without the flag a grid has no constraints, and says how to get them. */
    grid = engine_grid();
    vox_constraint_view view;
    ck_ok(vox_grid_step(grid));
    ck_fails(vox_grid_get_constraints(grid, &view), VOX_ERROR_INVALID_STATE, "or set VOX_GRID_CONSTRAINTS");
    vox_grid_destroy(grid);
    free_body(&box);
    free_body(&other);
}
END_TEST

/* ---- meshes without tetrahedra ---- */

START_TEST(edges_collide_with_nothing) {
    /* A blade through a tetrahedron: no vertex of either is in the other. */
    const float organ[12] = {0, 0, 0, 4, 0, 0, 0, 4, 0, 0, 0, 4},
                blade[9] = {-9, -9, 0.5f, 9, 0, 0.5f, 0, 9, 0.5f};
    const uint32_t tets[4] = {0, 1, 2, 3};
    lines log;
    vox_grid_desc settings = engine_desc();
    settings.log = log_to(&log);
    vox_grid* grid = grid_of(&settings);
    const vox_mesh_desc a = vox_mesh_desc_floats(organ, 4, tets, 1);
    vox_mesh_desc b = vox_mesh_desc_floats(blade, 3, NULL, 0);
    b.user_data = 12;
    (void)insert_mesh(grid, &a);
    ck_assert_uint_eq(log.warnings, 0);
    (void)insert_mesh(grid, &b);
    ck_assert_uint_eq(log.warnings, 1);
    ck_assert(says(&log, "body 4097 (slot 1, user data 12) has no tetrahedra"));
    ck_assert(says(&log, "its edges and faces with nothing"));
    (void)insert_mesh(grid, &b);
    ck_assert_uint_eq(log.warnings, 1);
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(contacts_of(grid).count, 0);
    const grid_counts counters = counters_of(grid);
    ck_assert_uint_eq(counters.bodies, 3);
    ck_assert_uint_eq(counters.bodies_without_tets, 2);
    vox_grid_destroy(grid);
}
END_TEST

/* ---- interior or boundary ---- */

/* Compares with the oracle; returns how many contacts are on a boundary. */
static uint64_t check_interiors(const vox_grid* grid, const body* bodies, uint32_t count) {
    oracle_mesh meshes[3];
    oracle_contact* expected = NULL;
    for (uint32_t b = 0; b < count; ++b) {
        const oracle_mesh mesh = {bodies[b].positions, bodies[b].tets, bodies[b].vertex_count,
                                  bodies[b].tet_count, 0};
        meshes[b] = mesh;
    }
    const size_t contacts = oracle_contacts(meshes, count, &expected);
    const vox_contact_view view = contacts_of(grid);
    uint64_t boundary = 0;
    ck_assert_uint_eq(view.count, contacts);
    for (size_t i = 0; i < contacts; ++i) {
        const uint8_t interior = view.interiors[i];
        ck_assert_uint_eq(interior, (uint8_t)(expected[i].interior != 0));
        boundary += !interior;
    }
    free(expected);
    return boundary;
}

START_TEST(interior_and_boundary) {
    body bodies[3] = {make_box(3, 0.5f, 0, 0, 0), make_box(3, 0.5f, 0.5f, 0.25f, 0),
                      make_box(2, 0.5f, 0.3f, 0.4f, 0.6f)};
    vox_grid* grid = engine_grid();
    ck_assert_uint_eq(contacts_of(grid).count, 0);
    for (int b = 0; b < 3; ++b) {
        const vox_mesh_desc desc = body_desc(&bodies[b]);
        (void)insert_mesh(grid, &desc);
    }
    for (int step = 0; step < 6; ++step) { /* new, at rest, and with one that moves among others at rest */
        ck_ok(vox_grid_step(grid));
        const uint64_t boundary = check_interiors(grid, bodies, 3);
        ck_assert_uint_gt(boundary, 10);
        ck_assert_uint_lt(boundary + 10, contacts_of(grid).count);
        if (step >= 2)
            for (uint32_t v = 0; v < bodies[2].vertex_count; ++v) bodies[2].positions[3 * v] += 0.03125f;
    }
    bodies[0].positions[0] = NAN;
    ck_fails(vox_grid_step(grid), VOX_ERROR_NON_FINITE, "not finite");
    ck_assert_uint_eq(contacts_of(grid).count, 0);
    bodies[0].positions[0] = 0;
    ck_ok(vox_grid_step(grid));
    (void)check_interiors(grid, bodies, 3);
    ck_ok(vox_grid_clear(grid));
    ck_assert_uint_eq(contacts_of(grid).count, 0);
    vox_grid_destroy(grid);
    for (int b = 0; b < 3; ++b) free_body(&bodies[b]);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, doubles_under_floats_are_refused, doubles_that_come_later, floats_are_never_refused,
                   what_the_memory_held_before_does_not_matter, edges_collide_with_nothing,
                   interior_and_boundary);
}

SUITE(traps) {
    add_for_each_engine(suite, add_tests);
    tcase_add_each(add_case(suite, "both engines, or none"), typed_helpers, zero_is_the_default);
}
