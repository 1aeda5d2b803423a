/* Limits that no other test comes near: each is passed by one, which is an error with both numbers in it, and
 * changes nothing. */
#include <math.h>
#include <string.h>

#include "scenes/bodies.h"
#include "support/suite.h"

static vox_grid* new_grid(uint64_t byte_budget) {
    vox_grid_desc desc = engine_desc();
    desc.byte_budget = byte_budget;
    return grid_of(&desc);
}

/* A mesh without positions as yet takes no memory for its vertices. */
static vox_mesh_desc points(uint64_t count) {
    vox_mesh_desc desc = vox_default_mesh_desc();
    desc.positions.count = count;
    return desc;
}

START_TEST(vertices_of_a_grid) {
    vox_grid* grid = new_grid(0);
    vox_body mesh = 7;
    vox_mesh_desc desc = points(VOX_MAX_VERTICES);
    vox_body all = insert_mesh(grid, &desc);
    desc = points(1);
    ck_fails(vox_mesh_insert(grid, &desc, &mesh), VOX_ERROR_LIMIT,
             "holds 2147483647 vertices and cannot take 1 more, the limit is 2147483647");
    ck_assert_uint_eq(mesh, 7);
    desc = points(0);
    ck_ok(vox_mesh_insert(grid, &desc, &mesh));
    ck_ok(vox_body_remove(grid, all));
    desc = points(VOX_MAX_VERTICES);
    ck_ok(vox_mesh_insert(grid, &desc, &mesh));
    ck_ok(vox_body_remove(grid, mesh));
    desc = points(VOX_MAX_VERTICES + 1ull);
    ck_fails(vox_mesh_insert(grid, &desc, &mesh), VOX_ERROR_LIMIT,
             "positions.count is 2147483648, the limit is 2147483647");
    vox_grid_destroy(grid);
}
END_TEST

/* More than a gigabyte, where the machine has it. */
START_TEST(meshes_of_a_grid) {
    vox_grid* grid = new_grid(0);
    const vox_mesh_desc desc = points(0);
    vox_body mesh = 0, last = 0;
    vox_result result = vox_grid_reserve(grid, VOX_MAX_BODIES, 0);
    for (uint32_t i = 0; i < VOX_MAX_BODIES && result == VOX_OK; ++i) {
        result = vox_mesh_insert(grid, &desc, &mesh);
        ck_assert(mesh > last || result != VOX_OK);
        last = mesh;
    }
    if (result == VOX_OK) {
        ck_fails(vox_mesh_insert(grid, &desc, &mesh), VOX_ERROR_LIMIT,
                 "holds 1048576 body slots and cannot take 1 more, the limit is 1048576");
        ck_ok(vox_body_remove(grid, last));
        ck_ok(vox_mesh_insert(grid, &desc, &mesh)); /* in its place */
        ck_assert_uint_ne(mesh, last);
        ck_fails(vox_mesh_insert(grid, &desc, &last), VOX_ERROR_LIMIT, "1048576");
        ck_ok(vox_grid_step(grid));
    } else {
        ck_assert_int_eq(result, VOX_ERROR_OUT_OF_MEMORY);
    }
    vox_grid_destroy(grid);
}
END_TEST

/* 1290^3 cells are fewer than 2^31, and too many bytes; 1291^3 are more. */
START_TEST(cells_of_dense_storage) {
    for (int more = 0; more < 2; ++more) {
        vox_grid_desc desc = vox_default_grid_desc();
        const vox_mesh_desc body = vox_mesh_desc_floats(unit_tet_positions, 4, unit_tet, 1);
        vox_reference_desc reference = vox_default_reference_desc();
        reference.flags = VOX_REFERENCE_DENSE;
        desc.reference = &reference;
        desc.cell_size = 1;
        for (int axis = 0; axis < 3; ++axis) reference.world_max[axis] = 1290 + more;
        vox_grid* grid = grid_of(&desc);
        insert_mesh(grid, &body);
        if (more)
            ck_fails(vox_grid_step(grid), VOX_ERROR_LIMIT, "1291 x 1291 x 1291 cells");
        else
            ck_fails(vox_grid_step(grid), VOX_ERROR_BUDGET, "1290 x 1290 x 1290 cells");
        ck_ok(vox_grid_set_cell_size(grid, 100));
        ck_ok(vox_grid_step(grid));
        vox_grid_destroy(grid);
    }
}
END_TEST

START_TEST(buckets_and_workers) {
    vox_grid_desc desc = vox_default_grid_desc();
    vox_reference_desc reference = vox_default_reference_desc();
    desc.reference = &reference;
    reference.hash_table_size = VOX_MAX_VERTICES;
    vox_grid* grid = grid_of(&desc);
    vox_grid_destroy(grid);
    reference.hash_table_size = VOX_MAX_VERTICES + 1ull;
    grid = NULL;
    ck_fails(vox_grid_create(&desc, &grid), VOX_ERROR_INVALID_ARGUMENT,
             "hash_table_size is 2147483648, expected at most 2147483647");
    ck_assert_ptr_null(grid);
    reference.hash_table_size = 0;
    desc.worker_count = VOX_MAX_WORKERS;
    ck_ok(vox_grid_create(&desc, &grid));
    ck_fails(vox_grid_set_worker_count(grid, VOX_MAX_WORKERS + 1), VOX_ERROR_INVALID_ARGUMENT, "257");
    vox_grid_destroy(grid);
}
END_TEST

/* What has no limit but memory: contacts, and all that follows from them, from none to a hundred thousand and
 * back. */
START_TEST(buffers_grow) {
    body large = make_box(7, 1, 0, 0, 0), same = make_box(7, 1, 0.3f, 0.3f, 0.3f);
    vox_grid_desc desc = engine_desc();
    vox_body mesh;
    desc.flags = VOX_GRID_CONSTRAINTS;
    vox_grid* grid = grid_of(&desc);
    uint64_t expected = 0;
    for (int i = 0; i < 2; ++i) {
        vox_mesh_desc body = body_desc(i ? &same : &large);
        ck_ok(vox_mesh_insert(grid, &body, &mesh));
    }
    for (int copies = 1; copies <= 16; copies *= 4) {
        vox_body more[16];
        for (int i = 0; i < copies; ++i) {
            vox_mesh_desc body = body_desc(&same);
            ck_ok(vox_mesh_insert(grid, &body, &more[i]));
        }
        ck_ok(vox_grid_step(grid));
        vox_contact_view contacts = contacts_of(grid);
        if (!expected) expected = contacts.count / 3; /* three bodies, of which two are the same */
        ck_assert_uint_gt(contacts.count, expected * (uint64_t)copies);
        ck_assert_uint_gt(constraints_of(grid).count, 0);
        ck_assert_uint_ge(contacts.count, constraints_of(grid).count);
        ck_assert_uint_eq(pairs_of(grid).count - count_pairs(grid, VOX_PAIR_ENDED),
                          (uint64_t)((copies + 2) * (copies + 1) / 2));
        for (int i = 0; i < copies; ++i) ck_ok(vox_body_remove(grid, more[i]));
    }
    vox_grid_destroy(grid);
    free_body(&large);
    free_body(&same);
}
END_TEST

/* Arrays of fixed length in structs: no model fills more than there is. */
START_TEST(capacities) {
    body box = make_box(3, 1, 0, 0, 0);
    const vox_mesh_desc mesh = body_desc(&box);
    for (int model = VOX_COST_MODEL_PAPER; model <= VOX_COST_MODEL_SURFACE; ++model) {
        vox_cell_size_desc desc = vox_default_cell_size_desc();
        vox_cell_size_result found;
        memset(&found, 0, sizeof found);
        found.struct_size = sizeof found;
        desc.model = (vox_cost_model)model;
        ck_ok(vox_suggest_cell_size(&desc, &mesh, 1, &found));
        ck_assert_uint_eq(found.curve_count, VOX_CURVE_CAPACITY);
        ck_assert_uint_gt(found.term_count, 0);
        ck_assert_uint_le(found.term_count, VOX_TERM_CAPACITY);
        ck_assert_uint_le(found.rule_count, VOX_RULE_CAPACITY);
        double sum = 0; /* so there is none that had no place */
        for (uint32_t i = 0; i < found.term_count; ++i) sum += found.terms[i].cost;
        ck_assert_double_ge(sum, found.cost * (1 - 1e-9));
        ck_assert_double_le(sum, found.cost * (1 + 1e-9));
    }
    free_body(&box);
}
END_TEST

static double one_run(double cell_size, void* user) {
    ++*(uint32_t*)user;
    return cell_size < 0.4 ? INFINITY : cell_size + 1 / cell_size + 1e-3 * (*(uint32_t*)user % 7);
}

/* The same of described grids: counts, terms, notes, runs. */
START_TEST(any_grid) {
    body box = make_box(3, 1, 0, 0, 0);
    vox_primitives stored = vox_default_primitives();
    stored.type = VOX_PRIMITIVE_TET;
    stored.positions.data = box.positions;
    stored.positions.count = box.vertex_count;
    stored.indices = box.tets;
    stored.count = box.tet_count;
    vox_foreign_grid grid = vox_default_foreign_grid();
    grid.stored = &stored;
    for (int known = VOX_KNOWN_GRID_NONE; known <= VOX_KNOWN_GRID_NUMPY; ++known) {
        vox_cell_size_result found;
        memset(&found, 0, sizeof found);
        found.struct_size = sizeof found;
        grid.known = (vox_known_grid)known;
        ck_ok(vox_foreign_grid_suggest(&grid, &found));
        ck_assert_uint_gt(found.curve_count, 1);
        ck_assert_uint_le(found.curve_count, VOX_CURVE_CAPACITY);
        ck_assert_uint_le(found.term_count, VOX_TERM_CAPACITY);
        ck_assert_uint_le(found.rule_count, VOX_RULE_CAPACITY);
        ck_assert_ptr_nonnull(memchr(found.note, 0, VOX_NOTE_CAPACITY));
        double sum = 0;
        for (uint32_t i = 0; i < found.term_count; ++i) sum += found.terms[i].cost;
        ck_assert_double_eq_tol(sum / found.cost, 1, 1e-9);
    }

    vox_tune_desc desc = vox_default_tune_desc();
    vox_cell_size_result tuning;
    uint32_t runs = 0;
    memset(&tuning, 0, sizeof tuning);
    tuning.struct_size = sizeof tuning;
    desc.max_runs = VOX_TIMING_CAPACITY + 1;
    ck_fails(vox_foreign_grid_tune(&grid, &desc, one_run, &runs, &tuning), VOX_ERROR_INVALID_ARGUMENT,
             "max_runs is 33");
    ck_assert_uint_eq(runs, 0);
    desc.max_runs = VOX_TIMING_CAPACITY;
    desc.wanted_loss = 0;
    ck_ok(vox_foreign_grid_tune(&grid, &desc, one_run, &runs, &tuning));
    ck_assert_uint_eq(tuning.timing_count, runs);
    ck_assert_uint_le(runs, VOX_TIMING_CAPACITY);
    ck_assert_ptr_nonnull(memchr(tuning.note, 0, VOX_NOTE_CAPACITY));

    vox_cell_size_result fit;
    fit.struct_size = sizeof fit;
    ck_fails(vox_foreign_grid_fit(&grid, tuning.timings, (uint64_t)1 << 32, &fit), VOX_ERROR_LIMIT,
             "4294967296");
    stored.count = (uint64_t)1 << 32;
    ck_fails(
        vox_foreign_grid_suggest(&grid, &(vox_cell_size_result){.struct_size = sizeof(vox_cell_size_result)}),
        VOX_ERROR_LIMIT, "2^32 - 1");
    free_body(&box);
}
END_TEST

static void add_tests(TCase* tests) { tcase_add_each(tests, vertices_of_a_grid, buffers_grow); }

SUITE(limits) {
    add_for_each_engine(suite, add_tests);
    TCase* once = add_case(suite, "one engine");
    tcase_add_each(once, cells_of_dense_storage, buckets_and_workers, capacities, any_grid);
    TCase* large = add_tagged_case(suite, "large", "large");
    tcase_add_test(large, meshes_of_a_grid);
}
