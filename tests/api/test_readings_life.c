/* The life of readings: what is gone by the time they are asked for, copies of a part of them, errors,
 * memory. */
#include "support/ledger.h"
#include "support/reading_checks.h"

/* ---- what is gone, and what there never was ---- */

/* The four faces of a simplex in four dimensions: each facet belongs to two tetrahedra. */
static const float closed_positions[15] = {0, 0, 0, 4, 0, 0, 0, 4, 0, 0, 0, 4, 1, 1, 0.5f};
static const uint32_t closed_tets[20] = {0, 1, 2, 3, 0, 1, 2, 4, 0, 1, 3, 4, 0, 2, 3, 4, 1, 2, 3, 4};
static const float one_point[3] = {0.5f, 0.75f, 0.5f};

START_TEST(no_surface) {
    vox_grid* grid = new_grid(suite_engine, VOX_GRID_PENETRATIONS, 1);
    vox_mesh_desc desc = vox_mesh_desc_floats(closed_positions, 5, closed_tets, 5);
    insert_mesh(grid, &desc);
    desc = vox_mesh_desc_floats(one_point, 1, NULL, 0);
    desc.user_data = 7;
    insert_mesh(grid, &desc);
    ck_ok(vox_grid_step(grid));
    ck_ok(vox_grid_prepare_readings(grid));
    vox_reading_view view;
    ck_ok(vox_grid_readings(grid, &view));
    ck_assert_uint_ge(view.count, 1);
    for (uint64_t i = 0; i < view.count; ++i) {
        ck_assert_uint_eq(view.data[i].known, VOX_READING_POSITION | VOX_READING_DEPTH);
        ck_assert_uint_eq(view.data[i].user_data_a, 7);
        ck_assert_uint_eq(view.data[i].user_data_b, 0);
        ck_assert_double_eq(view.data[i].distance, 0);
        for (int axis = 0; axis < 3; ++axis) {
            ck_assert_double_eq(view.data[i].position[axis], (double)one_point[axis]);
            ck_assert_double_eq(view.data[i].normal[axis], 0);
        }
    }
    vox_grid_destroy(grid);
}
END_TEST

START_TEST(after_removal) {
    for (int gone = 0; gone < 2; ++gone)
        for (int prepared = 0; prepared < 2; ++prepared) {
            world w;
            two_in_each_other(&w, 2, VOX_GRID_PENETRATIONS);
            ck_ok(vox_grid_step(w.grid));
            if (prepared) ck_ok(vox_grid_prepare_readings(w.grid));
            ck_ok(vox_body_remove(w.grid, w.models[gone].mesh));
            if (!prepared) ck_ok(vox_grid_prepare_readings(w.grid));
            vox_reading_view readings;
            ck_ok(vox_grid_readings(w.grid, &readings));
            vox_contact_view contacts = contacts_of(w.grid);
            ck_assert_uint_ge(readings.count, 4);
            uint64_t of_gone = 0, of_other = 0;
            for (uint64_t i = 0; i < readings.count; ++i) {
                const vox_reading* r = &readings.data[i];
                const int a = contacts.data[i].body_a == w.models[0].mesh ? 0 : 1;
                a == gone ? ++of_gone : ++of_other;
                ck_assert_uint_eq(r->user_data_a, 1000 + (uint64_t)a);
                ck_assert_uint_eq(r->user_data_b, 1001 - (uint64_t)a);
                if (prepared) {
                    check_reading(&w, &contacts.data[i], r, 0);
                    continue;
                }
                ck_assert_uint_eq(r->known,
                                  a == gone ? VOX_READING_DEPTH : VOX_READING_DEPTH | VOX_READING_POSITION);
                ck_assert_float_ge(r->depth, 0);
                ck_assert_double_eq(r->distance, 0);
            }
            ck_assert_uint_gt(of_gone, 0);
            ck_assert_uint_gt(of_other, 0);
            ck_fails(vox_mesh_copy_readings(w.grid, w.models[gone].mesh, NULL, 0, &of_gone),
                     VOX_ERROR_INVALID_HANDLE, "stale");
            ck_fails(vox_pair_copy_readings(w.grid, w.models[0].mesh, w.models[1].mesh, NULL, 0, &of_gone),
                     VOX_ERROR_INVALID_HANDLE, "stale");
            /* The next step forgets them. */
            ck_ok(vox_grid_step(w.grid));
            ck_fails(vox_grid_readings(w.grid, &readings), VOX_ERROR_INVALID_STATE,
                     "vox_grid_prepare_readings");
            end_world(&w);
        }
}
END_TEST

/* A vertex in two tetrahedra that overlap, the larger one first or last: it is read as long as one of them is
 * on, of the surface that is left. `self`: they and the tetrahedron of the vertex are one mesh. */
START_TEST(after_cuts_of_some) {
    static const uint32_t probe[4] = {8, 9, 10, 11};
    const int self = _i % 2, larger = _i / 2;
    float positions[36];
    uint32_t tets[12];
    for (uint32_t i = 0; i < 12; ++i) {
        positions[i] = unit_tet_positions[i] * (larger == 0 ? 2 : 1);
        positions[12 + i] = unit_tet_positions[i] * (larger == 1 ? 2 : 1);
        positions[24 + i] = i < 3 ? 0.125f : 0.125f - 4 * unit_tet_positions[i];
    }
    for (uint32_t i = 0; i < 8; ++i) tets[i] = i;
    memcpy(tets + 8, probe, sizeof probe);
    vox_grid* grid = new_grid(suite_engine, VOX_GRID_PENETRATIONS, 1);
    vox_mesh_desc desc = vox_mesh_desc_floats(positions, self ? 12 : 8, tets, self ? 3 : 2);
    vox_body second = 0;
    if (self) desc.filter.flags = VOX_FILTER_SELF_COLLISION;
    vox_body mesh = insert_mesh(grid, &desc);
    desc = vox_mesh_desc_floats(positions + 24, 1, NULL, 0);
    if (!self) ck_ok(vox_mesh_insert(grid, &desc, &second));
    ck_ok(vox_grid_step(grid));
    vox_reading_view readings;
    vox_contact_view contacts = contacts_of(grid);
    uint64_t at = 0; /* the contacts of the probe */
    while (at < contacts.count && contacts.data[at].vertex != (self ? 8u : 0u)) ++at;
    if (!self)
        while (contacts.data[at].body_a != second) ++at;
    ck_assert(contacts.data[at].tet == 0 && contacts.data[at + 1].tet == 1);
    for (uint32_t off = 0; off < 4; ++off) { /* a bit for each of the two */
        for (uint32_t t = 0; t < 2; ++t) ck_ok(vox_mesh_set_tets_enabled(grid, mesh, &t, 1, !(off >> t & 1)));
        ck_ok(vox_grid_prepare_readings(grid));
        ck_ok(vox_grid_readings(grid, &readings));
        const vox_reading *r = &readings.data[at], *s = r + 1;
        ck_assert(r->contact == at && s->contact == at + 1);
        ck_assert_mem_eq((const char*)r + sizeof r->contact, (const char*)s + sizeof s->contact,
                         sizeof *r - sizeof r->contact);
        ck_assert_uint_eq(r->known,
                          VOX_READING_POSITION | VOX_READING_DEPTH | (off < 3 ? VOX_READING_SURFACE : 0));
        if (off == 0 || off == 3) continue;
        const uint32_t left = off == 1 ? 1 : 0; /* all of its facets but the slanted one are as far */
        ck_assert_double_eq(r->distance, 0.125);
        for (int i = 0; i < 3; ++i) ck_assert_uint_eq(r->triangle[i] / 4, left);
    }
    vox_grid_destroy(grid);
}
END_TEST

START_TEST(without_penetrations) {
    world w;
    two_in_each_other(&w, 2, 0);
    ck_ok(vox_grid_step(w.grid));
    ck_assert_uint_ge(check_readings(&w, 0), 4);
    vox_reading_view view;
    ck_ok(vox_grid_readings(w.grid, &view));
    for (uint64_t i = 0; i < view.count; ++i)
        ck_assert_uint_eq(view.data[i].known, VOX_READING_POSITION | VOX_READING_SURFACE);
    end_world(&w);
}
END_TEST

/* ---- copies ---- */

START_TEST(copies) {
    uint64_t random = 41, pairs_seen = 0;
    for (int scene = 0; scene < 20; ++scene) {
        world w = random_world(&random, 0);
        ck_ok(vox_grid_step(w.grid));
        ck_ok(vox_grid_prepare_readings(w.grid));
        vox_reading_view readings;
        vox_pair_view pairs;
        vox_contact_view contacts = contacts_of(w.grid);
        ck_ok(vox_grid_readings(w.grid, &readings));
        ck_ok(vox_grid_get_pairs(w.grid, &pairs));
        const size_t room = (size_t)contacts.count + 1;
        vox_contact* some = (vox_contact*)calloc(room, sizeof *some);
        vox_reading* read = (vox_reading*)calloc(room, sizeof *read);
        uint64_t count, of_pairs = 0;
        for (int a = 0; a < w.count; ++a) {
            uint64_t wanted = 0;
            for (uint64_t i = 0; i < contacts.count; ++i)
                wanted += contacts.data[i].body_a == w.models[a].mesh ||
                          contacts.data[i].body_b == w.models[a].mesh;
            ck_ok(vox_mesh_copy_contacts(w.grid, w.models[a].mesh, some, room, &count));
            ck_assert_uint_eq(count, wanted);
            ck_ok(vox_mesh_copy_readings(w.grid, w.models[a].mesh, read, UINT64_MAX, &count));
            ck_assert_uint_eq(count, wanted);
            for (uint64_t i = 0; i < count; ++i) {
                ck_assert_mem_eq(&some[i], &contacts.data[read[i].contact], sizeof *some);
                ck_assert_mem_eq(&read[i], &readings.data[read[i].contact], sizeof *read);
            }
            for (int b = 0; b < w.count; ++b) {
                const vox_pair* pair = NULL;
                const vox_body ma = w.models[a].mesh, mb = w.models[b].mesh;
                for (uint64_t i = 0; i < pairs.count; ++i)
                    if ((pairs.data[i].body_a == ma && pairs.data[i].body_b == mb) ||
                        (pairs.data[i].body_a == mb && pairs.data[i].body_b == ma))
                        pair = &pairs.data[i];
                const uint64_t expected = pair ? pair->a_in_b + pair->b_in_a : 0;
                ck_ok(vox_pair_copy_contacts(w.grid, ma, mb, some, room, &count));
                ck_assert_uint_eq(count, expected);
                ck_ok(vox_pair_copy_readings(w.grid, ma, mb, read, room, &count));
                ck_assert_uint_eq(count, expected);
                for (uint64_t i = 0; i < count; ++i) {
                    const uint32_t index = pairs.contacts[pair->first + i];
                    ck_assert_mem_eq(&some[i], &contacts.data[index], sizeof *some);
                    ck_assert_mem_eq(&read[i], &readings.data[index], sizeof *read);
                }
                if (a <= b) of_pairs += count;
                pairs_seen += pair != NULL;
                /* With room for some. */
                memset(some, 0x5a, room * sizeof *some);
                memset(read, 0x5a, room * sizeof *read);
                ck_ok(vox_pair_copy_contacts(w.grid, ma, mb, some, expected / 2, &count));
                ck_assert_uint_eq(count, expected);
                ck_ok(vox_pair_copy_readings(w.grid, ma, mb, read, expected / 2, &count));
                ck_assert_uint_eq(count, expected);
                ck_assert_uint_eq(some[expected / 2].body_a, 0x5a5a5a5au);
                ck_assert_uint_eq(read[expected / 2].reserved, 0x5a5a5a5au);
            }
        }
        ck_assert_uint_eq(of_pairs, contacts.count);
        free(some);
        free(read);
        end_world(&w);
    }
    ck_assert_uint_gt(pairs_seen, 30);
}
END_TEST

/* ---- errors, life, memory ---- */

START_TEST(bad_arguments) {
    world w;
    two_in_each_other(&w, 2, 0);
    const vox_body a = w.models[0].mesh, b = w.models[1].mesh;
    vox_reading_view view = {NULL, 1, 2, 3};
    vox_reading reading;
    vox_contact contact;
    uint64_t count = 77;
    ck_fails(vox_grid_readings(w.grid, &view), VOX_ERROR_INVALID_STATE, "vox_grid_prepare_readings");
    ck_ok(vox_grid_prepare_readings(w.grid)); /* before the first step there are none */
    ck_ok(vox_grid_readings(w.grid, &view));
    ck_assert_uint_eq(view.count, 0);
    ck_ok(vox_grid_step(w.grid));
    view.count = 5;
    ck_fails(vox_grid_readings(w.grid, &view), VOX_ERROR_INVALID_STATE, "vox_grid_prepare_readings");
    ck_assert_uint_eq(view.count, 5);
    ck_fails(vox_mesh_copy_readings(w.grid, a, &reading, 1, &count), VOX_ERROR_INVALID_STATE,
             "vox_grid_prepare_readings");
    ck_fails(vox_pair_copy_readings(w.grid, a, b, &reading, 1, &count), VOX_ERROR_INVALID_STATE,
             "vox_grid_prepare_readings");
    ck_ok(vox_grid_prepare_readings(w.grid));
    ck_fails(vox_grid_prepare_readings(NULL), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_readings(NULL, &view), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_readings(w.grid, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_view is null");
    ck_fails(vox_mesh_copy_readings(NULL, a, &reading, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "grid is null");
    ck_fails(vox_mesh_copy_readings(w.grid, a, NULL, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "readings is null");
    ck_fails(vox_mesh_copy_readings(w.grid, a, &reading, 1, NULL), VOX_ERROR_INVALID_ARGUMENT,
             "out_count is null");
    ck_fails(vox_mesh_copy_readings(w.grid, 0, &reading, 1, &count), VOX_ERROR_INVALID_HANDLE, "0");
    ck_fails(vox_pair_copy_readings(NULL, a, b, &reading, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "grid is null");
    ck_fails(vox_pair_copy_readings(w.grid, a, b, NULL, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "readings is null");
    ck_fails(vox_pair_copy_readings(w.grid, a, b, &reading, 1, NULL), VOX_ERROR_INVALID_ARGUMENT,
             "out_count is null");
    ck_fails(vox_pair_copy_readings(w.grid, a, 3, &reading, 1, &count), VOX_ERROR_INVALID_HANDLE, "3");
    ck_fails(vox_pair_copy_contacts(NULL, a, b, &contact, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "grid is null");
    ck_fails(vox_pair_copy_contacts(w.grid, a, b, NULL, 1, &count), VOX_ERROR_INVALID_ARGUMENT,
             "contacts is null");
    ck_fails(vox_pair_copy_contacts(w.grid, a, b, &contact, 1, NULL), VOX_ERROR_INVALID_ARGUMENT,
             "out_count is null");
    ck_fails(vox_pair_copy_contacts(w.grid, 0, b, &contact, 1, &count), VOX_ERROR_INVALID_HANDLE, "0");
    ck_fails(vox_pair_copy_contacts(w.grid, a, 0, &contact, 1, &count), VOX_ERROR_INVALID_HANDLE, "0");
    ck_assert_uint_eq(count, 77);
    ck_ok(vox_pair_copy_contacts(w.grid, a, b, NULL, 0, &count));
    ck_assert_uint_gt(count, 0);
    /* Reserving leaves them, clearing ends them. */
    ck_ok(vox_grid_reserve(w.grid, 100, 1000));
    ck_ok(vox_grid_readings(w.grid, &view));
    ck_assert_uint_eq(view.count, count);
    ck_ok(vox_grid_clear(w.grid));
    ck_fails(vox_grid_readings(w.grid, &view), VOX_ERROR_INVALID_STATE, "vox_grid_prepare_readings");
    ck_ok(vox_grid_prepare_readings(w.grid));
    ck_ok(vox_grid_readings(w.grid, &view));
    ck_assert_uint_eq(view.count, 0);
    end_world(&w);
}
END_TEST

/* Positions that are none any more: those read before stay. */
START_TEST(changed_positions) {
    world w;
    two_in_each_other(&w, 2, 0);
    ck_ok(vox_grid_step(w.grid));
    ck_ok(vox_grid_prepare_readings(w.grid));
    vox_reading_view view;
    ck_ok(vox_grid_readings(w.grid, &view));
    vox_reading* before = (vox_reading*)malloc(view.count * sizeof *before);
    memcpy(before, view.data, view.count * sizeof *before);
    float* x = &w.models[1].shape.positions[7];
    const float was = *x;
    *x = NAN;
    ck_fails(vox_grid_prepare_readings(w.grid), VOX_ERROR_NON_FINITE, "vertex 2");
    *x = was;
    vox_reading_view after;
    ck_ok(vox_grid_readings(w.grid, &after));
    ck_assert_ptr_eq(after.data, view.data);
    ck_assert_mem_eq(after.data, before, view.count * sizeof *before);
    /* A failed step leaves none. */
    *x = INFINITY;
    ck_fails(vox_grid_step(w.grid), VOX_ERROR_NON_FINITE, "vertex 2");
    ck_fails(vox_grid_readings(w.grid, &after), VOX_ERROR_INVALID_STATE, "vox_grid_prepare_readings");
    ck_ok(vox_grid_prepare_readings(w.grid));
    ck_ok(vox_grid_readings(w.grid, &after));
    ck_assert_uint_eq(after.count, 0);
    free(before);
    end_world(&w);
}
END_TEST

START_TEST(memory) {
    world w;
    ledger l = {0};
    memset(&w, 0, sizeof w);
    two_in_each_other(&w, 2, 0);
    vox_grid_destroy(w.grid);
    uint64_t failures = 0;
    for (int done = 0; !done;) {
        vox_grid_desc desc = engine_desc();
        desc.flags = 0; /* so that the surfaces are made here, too */
        desc.worker_count = 3;
        desc.allocator = ledger_allocator(&l);
        l.fail_at = 0;
        ck_ok(vox_grid_create(&desc, &w.grid));
        insert(&w, w.grid);
        ck_ok(vox_grid_step(w.grid));
        l.calls = 0;
        l.fail_at = failures + 1;
        const vox_result result = vox_grid_prepare_readings(w.grid);
        done = result == VOX_OK;
        if (!done) {
            ++failures;
            vox_reading_view view;
            ck_assert_int_eq(result, VOX_ERROR_OUT_OF_MEMORY);
            ck_fails(vox_grid_readings(w.grid, &view), VOX_ERROR_INVALID_STATE, "vox_grid_prepare_readings");
        }
        l.fail_at = 0;
        ck_assert_uint_ge(check_readings(&w, 0), 4);
        /* Again, and after another step: no memory any more. */
        ck_ok(vox_grid_step(w.grid));
        l.calls = 0;
        ck_ok(vox_grid_prepare_readings(w.grid));
        ck_ok(vox_grid_prepare_readings(w.grid));
        ck_assert_uint_eq(l.calls, 0);
        vox_grid_destroy(w.grid);
        ck_assert_uint_eq(l.bytes, 0);
    }
    ck_assert_uint_gt(failures, 5);
    w.grid = NULL;
    end_world(&w);
}
END_TEST

/* Exactly as many bytes as were ever held are enough; one less is an error. */
START_TEST(budget) {
    world w;
    two_in_each_other(&w, 8, 0);
    ck_ok(vox_grid_step(w.grid));
    grid_counts counters;
    counters = counters_of(w.grid);
    const uint64_t without = counters.peak_bytes;
    ck_ok(vox_grid_prepare_readings(w.grid));
    counters = counters_of(w.grid);
    ck_assert_uint_gt(counters.peak_bytes, without);
    vox_grid_destroy(w.grid);
    vox_grid_desc desc = engine_desc();
    desc.flags = 0;
    desc.byte_budget = counters.peak_bytes;
    ck_ok(vox_grid_create(&desc, &w.grid));
    insert(&w, w.grid);
    ck_ok(vox_grid_step(w.grid));
    ck_ok(vox_grid_prepare_readings(w.grid));
    vox_grid_destroy(w.grid);
    desc.byte_budget = counters.peak_bytes - 1;
    ck_ok(vox_grid_create(&desc, &w.grid));
    insert(&w, w.grid);
    ck_ok(vox_grid_step(w.grid));
    ck_fails(vox_grid_prepare_readings(w.grid), VOX_ERROR_BUDGET, "byte");
    vox_contact_view view = contacts_of(w.grid);
    ck_assert_uint_gt(view.count, 0);
    end_world(&w);
}
END_TEST

/* A task system that runs what it is given at once, in two parts, or loses the second. */
static int loses_items;
static uint64_t enqueued;

static void* run_in_two(vox_task* task, uint64_t item_count, uint64_t min_range, void* context, void* user) {
    (void)min_range;
    (void)user;
    ++enqueued;
    task(0, item_count / 2, 0, context);
    if (!loses_items) task(item_count / 2, item_count, 1, context);
    return NULL;
}

static void finish_nothing(void* handle, void* user) {
    (void)handle;
    (void)user;
}

START_TEST(task_systems) {
    enum { n = 8 };
    body bodies[n];
    vox_grid_desc desc = engine_desc();
    desc.flags = 0;
    desc.worker_count = 2;
    const vox_task_system tasks = {run_in_two, finish_nothing, NULL};
    desc.tasks = &tasks;
    vox_grid* grid = grid_of(&desc);
    for (int b = 0; b < n; ++b) {
        bodies[b] = make_box(4, 1, 3.2f * (float)(b % 2), 3.3f * (float)(b / 2 % 2), 3.4f * (float)(b / 4));
        const vox_mesh_desc body = body_desc(&bodies[b]);
        insert_mesh(grid, &body);
    }
    vox_reading_view view;
    loses_items = 0;
    ck_ok(vox_grid_step(grid));
    enqueued = 0;
    ck_ok(vox_grid_prepare_readings(grid));
    ck_assert_uint_eq(enqueued, 1);
    ck_ok(vox_grid_readings(grid, &view));
    ck_assert_uint_gt(view.count, 512);
    for (uint64_t i = 0; i < view.count; ++i)
        ck_assert_uint_eq(view.data[i].known, VOX_READING_POSITION | VOX_READING_SURFACE);
    loses_items = 1;
    ck_fails(vox_grid_prepare_readings(grid), VOX_ERROR_INVALID_ARGUMENT, "items");
    ck_fails(vox_grid_readings(grid, &view), VOX_ERROR_INVALID_STATE, "vox_grid_prepare_readings");
    loses_items = 0;
    ck_ok(vox_grid_prepare_readings(grid));
    ck_ok(vox_grid_readings(grid, &view));
    vox_grid_destroy(grid);
    for (int b = 0; b < n; ++b) free_body(&bodies[b]);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, no_surface, after_removal);
    tcase_add_loop_test(tests, after_cuts_of_some, 0, 4);
    tcase_add_each(tests, without_penetrations, copies, bad_arguments, changed_positions, memory, budget,
                   task_systems);
}

SUITE(readings_life) { add_for_each_engine(suite, add_tests); }
