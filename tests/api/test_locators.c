/* Locators: their answers are those of the moment they were taken, whatever happens to the grid, on any
 * thread. */
#include <pthread.h>

#include "support/ledger.h"
#include "support/query_checks.h"

/* ---- all answers as one number ---- */

static void add_bytes(uint64_t* hash, const void* bytes, size_t size) {
    for (size_t i = 0; i < size; ++i) *hash = (*hash ^ ((const uint8_t*)bytes)[i]) * 0x100000001b3u;
}

static uint64_t hash_of_answers(const vox_locator* locator) {
    enum { n = 80, few = 40, room = 16384 }; /* many points and few are searched in different ways */
    static vox_point_hit points[room];
    static vox_box_hit boxes[room];
    static vox_ray_hit rays[room];
    vox_closest_hit closest[n];
    uint8_t blocked[n];
    float from[n][3], to[n][3], max[n][3];
    uint64_t hash = 0xcbf29ce484222325u, random = 21, count = 0;
    for (int i = 0; i < n; ++i) {
        random_point(&random, i % 2, from[i]);
        random_point(&random, i % 2, to[i]);
        for (int axis = 0; axis < 3; ++axis) max[i][axis] = from[i][axis] + 0.5f;
    }
    const vox_positions begins = vox_float_positions(from[0], n), ends = vox_float_positions(to[0], n);
    const vox_positions highs = vox_float_positions(max[0], n), some = vox_float_positions(from[0], few);
#define ADD_LIST(name, hits, ...)                                                                            \
    do {                                                                                                     \
        ck_ok(vox_locator_##name(locator, __VA_ARGS__, NULL, hits, room, &count));                           \
        ck_assert_uint_le(count, room);                                                                      \
        add_bytes(&hash, hits, count * sizeof *hits);                                                        \
    } while (0)
    ADD_LIST(find_point_hits, points, &begins);
    ADD_LIST(find_point_hits, points, &some);
    ADD_LIST(find_box_hits, boxes, &begins, &highs);
    ADD_LIST(find_ray_hits, rays, &begins, &ends);
#undef ADD_LIST
    ck_ok(vox_locator_find_closest(locator, &begins, NULL, closest));
    add_bytes(&hash, closest, sizeof closest);
    ck_ok(vox_locator_test_rays(locator, &begins, &ends, NULL, blocked));
    add_bytes(&hash, blocked, sizeof blocked);
    return hash;
}

/* What a locator of the grid should answer: that of a copy of the grid that had none before. */
static uint64_t hash_by_copy(const vox_grid* grid) {
    uint64_t size = 0;
    vox_grid* copy = NULL;
    ck_ok(vox_grid_save(grid, NULL, 0, &size));
    void* bytes = malloc((size_t)size);
    ck_ok(vox_grid_save(grid, bytes, size, &size));
    ck_ok(vox_grid_load(bytes, size, NULL, &copy));
    free(bytes);
    vox_locator* locator = take_locator(copy);
    const uint64_t hash = hash_of_answers(locator);
    vox_locator_release(locator);
    vox_grid_destroy(copy);
    return hash;
}

static void move_all(world* w, float by) {
    for (int b = 0; b < w->count; ++b)
        for (uint32_t i = 0; i < 3 * w->bodies[b].vertex_count; ++i) w->bodies[b].positions[i] += by;
}

/* ---- one moment ---- */

START_TEST(answers_stay) {
    uint64_t random = 31;
    for (int scene = 0; scene < 8; ++scene) {
        world w = new_world(&random, scene % 2);
        vox_locator* first = w.locator;
        const uint64_t expected = hash_of_answers(first);
        ck_assert_uint_eq(expected, hash_by_copy(w.grid));

        move_all(&w, 0.375f); /* borrowed positions are overwritten */
        ck_assert_uint_eq(hash_of_answers(first), expected);
        ck_ok(vox_grid_step(w.grid));
        ck_assert_uint_eq(hash_of_answers(first), expected);
        vox_locator* later = take_locator(w.grid);
        const uint64_t moved = hash_of_answers(later);
        ck_assert_uint_ne(moved, expected);
        ck_assert_uint_eq(moved, hash_by_copy(w.grid));

        const double matrix[12] = {0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 2};
        ck_ok(vox_body_set_transform(w.grid, w.meshes[0], matrix));
        const uint32_t tets[2] = {0, 3};
        ck_ok(vox_mesh_remove_tets(w.grid, w.meshes[0], tets, 2));
        vox_locator* cut = take_locator(w.grid);
        const uint64_t of_cut = hash_of_answers(cut);
        ck_assert_uint_ne(of_cut, moved);
        ck_assert_uint_eq(of_cut, hash_by_copy(w.grid));

        ck_ok(vox_body_set_enabled(w.grid, w.meshes[0], 0));
        ck_ok(vox_body_remove(w.grid, w.meshes[w.count - 1]));
        ck_ok(vox_grid_step(w.grid));
        ck_ok(vox_locator_retain(first)); /* of which the end of the world is another owner */
        for (int kind = 0; kind < 3; ++kind) {
            if (kind == 1) ck_ok(vox_grid_clear(w.grid));
            if (kind == 2) end_world(&w); /* the grid, and the arrays of positions */
            ck_assert_uint_eq(hash_of_answers(first), expected);
            ck_assert_uint_eq(hash_of_answers(later), moved);
            ck_assert_uint_eq(hash_of_answers(cut), of_cut);
        }
        vox_locator_release(first);
        vox_locator_release(cut);
        vox_locator_release(later);
    }
}
END_TEST

/* Locators in use are left alone while those that were released are used again, whatever the meshes are by
 * then. */
START_TEST(locators_side_by_side) {
    enum { most = 4 };
    uint64_t random = 32, expected[most] = {0};
    vox_locator* locators[most] = {NULL};
    world w = new_world(&random, 0);
    for (int round = 0; round < 60; ++round) {
        const uint32_t which = random_below(&random, most);
        move_all(&w, random_float(&random, -0.05f, 0.05f));
        if (round % 5 == 0) { /* edits in between */
            const uint32_t tet = random_below(&random, w.bodies[0].tet_count);
            ck_ok(vox_mesh_set_tets_enabled(w.grid, w.meshes[0], &tet, 1, (uint32_t)round / 5 % 2));
        }
        if (round % 7 == 0) {
            const vox_mesh_desc mesh = body_desc(&w.bodies[w.count - 1]);
            ck_ok(vox_body_remove(w.grid, w.meshes[w.count - 1]));
            ck_ok(vox_mesh_insert(w.grid, &mesh, &w.meshes[w.count - 1]));
        }
        if (round % 2) vox_locator_release(locators[which]), locators[which] = NULL;
        ck_ok(vox_grid_update_locator(w.grid, &locators[which]));
        expected[which] = hash_by_copy(w.grid);
        for (int i = 0; i < most; ++i)
            if (locators[i]) ck_assert_uint_eq(hash_of_answers(locators[i]), expected[i]);
    }
    for (int i = 0; i < most; ++i) vox_locator_release(locators[i]);
    end_world(&w);
}
END_TEST

START_TEST(as_it_was_when_taken) {
    const double inside[3] = {0.3, 0.4, 0.6}, far_away[3] = {10.3, 0.4, 0.6};
    body box = make_box(2, 1, 0, 0, 0);
    vox_grid* grid = engine_grid();
    vox_locator* locator = take_locator(grid); /* of nothing */
    ck_assert_uint_eq(closest_to(locator, inside, NULL).body, VOX_NULL_BODY);
    const vox_mesh_desc desc = body_desc(&box);
    const vox_body mesh = insert_mesh(grid, &desc);
    ck_assert_uint_eq(count_at(locator, inside), 0);
    ck_ok(vox_grid_update_locator(grid, &locator)); /* before the first step */
    ck_assert_uint_eq(count_at(locator, inside), 1);
    for (uint32_t v = 0; v < box.vertex_count; ++v) box.positions[3 * v] += 10;
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(count_at(locator, inside), 1);
    ck_assert_uint_eq(count_at(locator, far_away), 0);
    ck_ok(vox_grid_update_locator(grid, &locator));
    ck_assert_uint_eq(count_at(locator, inside), 0);
    ck_assert_uint_eq(count_at(locator, far_away), 1);
    vox_locator* const kept = locator; /* what fails leaves what was there */
    box.positions[4] = NAN;
    ck_fails(vox_grid_update_locator(grid, &locator), VOX_ERROR_NON_FINITE, "vertex 1: position (");
    ck_assert_ptr_eq(locator, kept);
    ck_assert_uint_eq(count_at(locator, far_away), 1);
    vox_mesh_desc bare = desc;
    bare.positions.data = NULL;
    ck_ok(vox_body_remove(grid, mesh));
    const vox_body without = insert_mesh(grid, &bare);
    ck_fails(vox_grid_update_locator(grid, &locator), VOX_ERROR_INVALID_STATE, "has no positions");
    ck_assert_ptr_eq(locator, kept);
    ck_assert_uint_eq(count_at(locator, far_away), 1);
    ck_ok(vox_body_remove(grid, without));
    box.positions[4] = 0;
    const vox_body other = insert_mesh(grid, &desc);
    ck_ok(vox_body_set_enabled(grid, other, 0));
    ck_ok(vox_grid_update_locator(grid, &locator));
    ck_assert_uint_eq(count_at(locator, far_away), 0);
    ck_ok(vox_body_set_enabled(grid, other, 1));
    ck_ok(vox_grid_update_locator(grid, &locator));
    ck_ok(vox_grid_clear(grid));
    ck_assert_uint_eq(count_at(locator, far_away), 1);
    vox_locator_release(locator);
    vox_grid_destroy(grid);
    free_body(&box);
}
END_TEST

START_TEST(what_a_locator_says_of_itself) {
    uint64_t epoch = 77, user_data = 77, random = 33;
    world w = new_world(&random, 0);
    vox_mesh_desc mesh = body_desc(&w.bodies[0]);
    mesh.user_data = 1234567890123u;
    const vox_body id = insert_mesh(w.grid, &mesh);
    ck_ok(vox_grid_step(w.grid));
    ck_ok(vox_grid_step(w.grid));
    ck_ok(vox_grid_update_locator(w.grid, &w.locator));
    ck_ok(vox_body_remove(w.grid, id));
    ck_ok(vox_grid_step(w.grid));
    ck_ok(vox_locator_get_epoch(w.locator, &epoch));
    ck_assert_uint_eq(epoch, 2);
    ck_ok(vox_locator_get_user_data(w.locator, id, &user_data));
    ck_assert_uint_eq(user_data, 1234567890123u);
    ck_fails(vox_locator_get_user_data(w.locator, id + 1, &user_data), VOX_ERROR_INVALID_HANDLE,
             "is none of the");
    ck_fails(vox_locator_get_user_data(w.locator, VOX_NULL_BODY, &user_data), VOX_ERROR_INVALID_HANDLE,
             "0 is none");
    ck_ok(vox_grid_clear(w.grid));
    ck_ok(vox_grid_update_locator(w.grid, &w.locator)); /* of nothing */
    ck_fails(vox_locator_get_user_data(w.locator, id, &user_data), VOX_ERROR_INVALID_HANDLE, "the 0 ");
    ck_assert_uint_eq(user_data, 1234567890123u);
    ck_assert_uint_eq(hash_of_answers(w.locator), hash_by_copy(w.grid));
    end_world(&w);
}
END_TEST

START_TEST(arguments) {
    uint64_t random = 34, number = 77;
    world w = new_world(&random, 0);
    vox_locator* locator = NULL;
    ck_fails(vox_grid_update_locator(NULL, &locator), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_update_locator(w.grid, NULL), VOX_ERROR_INVALID_ARGUMENT, "locator is null");
    ck_fails(vox_locator_retain(NULL), VOX_ERROR_INVALID_ARGUMENT, "locator is null");
    ck_fails(vox_locator_get_epoch(NULL, &number), VOX_ERROR_INVALID_ARGUMENT, "locator is null");
    ck_fails(vox_locator_get_user_data(NULL, w.meshes[0], &number), VOX_ERROR_INVALID_ARGUMENT,
             "locator is null");
    ck_fails(vox_locator_get_epoch(w.locator, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_epoch is null");
    ck_fails(vox_locator_get_user_data(w.locator, w.meshes[0], NULL), VOX_ERROR_INVALID_ARGUMENT,
             "out_user_data is null");
    ck_assert_ptr_null(locator);
    ck_assert_uint_eq(number, 77);
    vox_locator_release(NULL);
    ck_ok(vox_locator_retain(w.locator));
    vox_locator_release(w.locator);
    ck_ok(vox_locator_get_epoch(w.locator, &number)); /* one owner is left */
    end_world(&w);
}
END_TEST

/* ---- memory ---- */

static vox_grid* counted_world(ledger* l, body* b, uint64_t budget) {
    vox_grid_desc desc = engine_desc();
    desc.allocator = ledger_allocator(l);
    desc.byte_budget = budget;
    vox_grid* grid = NULL;
    if (vox_grid_create(&desc, &grid) != VOX_OK) return NULL;
    const vox_mesh_desc mesh = body_desc(b);
    vox_body id = VOX_NULL_BODY;
    if (vox_mesh_insert(grid, &mesh, &id) == VOX_OK) return grid;
    vox_grid_destroy(grid);
    return NULL;
}

START_TEST(steady_state_allocates_nothing) {
    ledger l = {0};
    body box = make_box(6, 0.25f, 0, 0, 0);
    vox_grid* grid = counted_world(&l, &box, 0);
    vox_locator *mine = NULL, *shown = NULL; /* what another thread asks */
    uint64_t calls = 0;
    for (int frame = 0; frame < 10; ++frame) {
        for (uint32_t i = 0; i < 3 * box.vertex_count; ++i) box.positions[i] += 0.01f;
        ck_ok(vox_grid_step(grid));
        ck_ok(vox_grid_update_locator(grid, &mine));
        vox_locator_release(shown);
        shown = mine;
        ck_ok(vox_locator_retain(shown));
        ck_assert_uint_eq(counters_of(grid).bytes, l.bytes); /* locators are counted */
        if (frame > 3) ck_assert_uint_eq(l.calls, calls);
        calls = l.calls;
    }
    vox_locator_release(mine);
    const uint64_t with_locators = l.bytes;
    ck_ok(vox_grid_clear(grid)); /* gives up the locator that nobody uses, and what the mesh held */
    ck_assert_uint_lt(l.bytes, with_locators);
    ck_assert_uint_eq(counters_of(grid).bytes, l.bytes);
    const uint64_t cleared = l.bytes;
    vox_locator_release(shown);
    ck_assert_uint_eq(l.bytes, cleared); /* waits for the next one */
    ck_ok(vox_grid_clear(grid));
    ck_assert_uint_lt(l.bytes, cleared);
    vox_grid_destroy(grid);
    ck_assert_uint_eq(l.bytes, 0);
    free_body(&box);
}
END_TEST

/* The one before is released: of the same grid, of another one, and of one that was destroyed. */
START_TEST(updates_release) {
    ledger l = {0}, of_other = {0};
    body box = make_box(4, 0.25f, 0, 0, 0), other_box = make_box(4, 0.25f, 5, 0, 0);
    vox_grid* grid = counted_world(&l, &box, 0);
    vox_grid* other = counted_world(&of_other, &other_box, 0);
    vox_locator* locator = take_locator(grid);
    const uint64_t of_one = l.bytes, expected = hash_of_answers(locator);
    vox_locator* before = locator;
    ck_ok(vox_locator_retain(before));
    ck_ok(vox_grid_update_locator(grid, &locator));
    ck_assert_ptr_ne(locator, before);
    const uint64_t of_two = l.bytes;
    ck_assert_uint_gt(of_two, of_one);
    vox_locator_release(before); /* by its last owner */
    for (int i = 0; i < 5; ++i) {
        ck_ok(vox_grid_update_locator(grid, &locator));
        ck_assert_uint_eq(l.bytes, of_two);
    }
    ck_ok(vox_grid_update_locator(other, &locator));
    ck_assert_uint_ne(hash_of_answers(locator), expected);
    const uint64_t of_others = of_other.bytes;
    ck_ok(vox_grid_clear(grid)); /* no locator of this grid is in use */
    ck_assert_uint_lt(l.bytes, of_one);
    const vox_mesh_desc mesh = body_desc(&box);
    insert_mesh(grid, &mesh);
    vox_grid_destroy(other);
    ck_assert_uint_gt(of_other.bytes, 0);
    ck_assert_uint_lt(of_other.bytes, of_others);
    ck_ok(vox_grid_update_locator(grid, &locator));
    ck_assert_uint_eq(of_other.bytes, 0);
    vox_grid_destroy(grid);
    vox_locator_release(locator);
    ck_assert_uint_eq(l.bytes, 0);
    free_body(&box);
    free_body(&other_box);
}
END_TEST

START_TEST(memory_lives_as_long_as_the_last_locator) {
    ledger l = {0};
    body box = make_box(4, 0.25f, 0, 0, 0);
    vox_grid* grid = counted_world(&l, &box, 0);
    vox_locator* locators[3];
    for (int i = 0; i < 3; ++i) locators[i] = take_locator(grid);
    ck_ok(vox_locator_retain(locators[1]));
    vox_locator_release(locators[0]);
    vox_grid_destroy(grid);
    uint64_t before = l.bytes;
    ck_assert_uint_gt(before, 0);
    vox_locator_release(locators[1]);
    ck_assert_uint_eq(l.bytes, before); /* retained */
    const uint64_t hash = hash_of_answers(locators[1]);
    ck_assert_uint_eq(hash_of_answers(locators[2]), hash);
    vox_locator_release(locators[2]);
    ck_assert_uint_lt(l.bytes, before);
    ck_assert_uint_eq(hash_of_answers(locators[1]), hash);
    vox_locator_release(locators[1]);
    ck_assert_uint_eq(l.bytes, 0);
    free_body(&box);
}
END_TEST

/* Whatever call to the allocator fails, and at whatever budget: the error, and no harm. */
START_TEST(without_memory) {
    body box = make_box(3, 0.25f, 0, 0, 0);
    uint32_t failures = 0, updates = 0;
    for (uint64_t fail_at = 1; updates == 0; ++fail_at) {
        ledger l = {0};
        l.fail_at = fail_at;
        vox_grid* grid = counted_world(&l, &box, 0);
        if (!grid) continue;
        vox_locator* first = NULL;
        if (vox_grid_update_locator(grid, &first) != VOX_OK) {
            ck_assert_ptr_null(first);
            first = take_locator(grid); /* the next call does not fail */
        }
        vox_locator* locator = first;
        ck_ok(vox_locator_retain(first));
        const uint64_t expected = hash_of_answers(first);
        const vox_result result = vox_grid_update_locator(grid, &locator);
        if (result != VOX_OK) {
            ck_assert_int_eq(result, VOX_ERROR_OUT_OF_MEMORY);
            ck_assert_ptr_eq(locator, first);
            ++failures;
            ck_ok(vox_grid_update_locator(grid, &locator));
        } else if (l.calls < fail_at) {
            ++updates;
        }
        ck_assert_ptr_ne(locator, first);
        ck_assert_uint_eq(hash_of_answers(locator), expected);
        ck_assert_uint_eq(hash_of_answers(first), expected);
        vox_grid_destroy(grid);
        vox_locator_release(first);
        vox_locator_release(locator);
        ck_assert_uint_eq(l.bytes, 0);
    }
    ck_assert_uint_gt(failures, 5);

    ledger l = {0};
    vox_grid* grid = counted_world(&l, &box, 0);
    vox_locator* locator = take_locator(grid);
    const uint64_t enough = l.peak;
    vox_grid_destroy(grid);
    vox_locator_release(locator);
    uint32_t refused = 0;
    for (uint64_t budget = enough - enough / 32; budget <= enough; budget += enough / 2048) {
        ledger of_budget = {0};
        grid = counted_world(&of_budget, &box, budget);
        if (!grid) continue;
        locator = NULL;
        const vox_result result = vox_grid_update_locator(grid, &locator);
        if (result != VOX_OK) {
            ck_assert_int_eq(result, VOX_ERROR_BUDGET);
            ck_assert_ptr_null(locator);
            ++refused;
        }
        ck_assert_uint_le(of_budget.peak, budget);
        vox_locator_release(locator);
        vox_grid_destroy(grid);
        ck_assert_uint_eq(of_budget.bytes, 0);
    }
    ck_assert_uint_gt(refused, 3);
    free_body(&box);
}
END_TEST

/* ---- workers ---- */

typedef struct scheduler {
    uint32_t workers, enqueued;
    int loses_items;
} scheduler;

static void* enqueue(vox_task* task, uint64_t items, uint64_t min_range, void* context, void* user) {
    scheduler* s = (scheduler*)user;
    ++s->enqueued;
    const uint64_t size = min_range > 0 ? min_range : 1;
    for (uint64_t begin = s->loses_items ? size : 0; begin < items; begin += size)
        task(begin, begin + size < items ? begin + size : items, (uint32_t)(begin / size % s->workers),
             context);
    return NULL;
}
static void finish(void* handle, void* user) { (void)handle, (void)user; }

START_TEST(same_for_any_workers) {
    body box = make_box(30, 0.2f, 0, 0, 0);
    const vox_mesh_desc mesh = body_desc(&box);
    vox_grid* grid = engine_grid();
    insert_mesh(grid, &mesh);
    vox_locator* locator = take_locator(grid);
    const uint64_t expected = hash_of_answers(locator);
    ck_ok(vox_grid_set_worker_count(grid, VOX_ALL_CORES));
    ck_ok(vox_grid_update_locator(grid, &locator));
    ck_assert_uint_eq(hash_of_answers(locator), expected);
    vox_grid_destroy(grid);
    for (uint32_t workers = 2; workers <= 5; ++workers) {
        scheduler s = {workers, 0, 0};
        vox_grid_desc desc = engine_desc();
        desc.worker_count = workers;
        const vox_task_system tasks = {enqueue, finish, &s};
        desc.tasks = &tasks;
        grid = grid_of(&desc);
        insert_mesh(grid, &mesh);
        ck_ok(vox_grid_update_locator(grid, &locator));
        ck_assert_uint_ge(s.enqueued, 3);
        ck_assert_uint_le(s.enqueued, 4);
        ck_assert_uint_eq(hash_of_answers(locator), expected);
        s.loses_items = 1; /* an error, and all is as it was */
        vox_locator* const before = locator;
        ck_fails(vox_grid_update_locator(grid, &locator), VOX_ERROR_INVALID_ARGUMENT, "items");
        ck_assert_ptr_eq(locator, before);
        ck_assert_uint_eq(hash_of_answers(locator), expected);
        s.loses_items = 0;
        s.enqueued = 0;
        ck_ok(vox_grid_update_locator(grid, &locator));
        ck_assert_ptr_ne(locator, before);
        ck_assert_uint_le(s.enqueued, 4);
        ck_assert_uint_eq(hash_of_answers(locator), expected);
        vox_grid_destroy(grid);
    }
    vox_locator_release(locator);
    free_body(&box);
}
END_TEST

/* ---- threads ---- */

/* A simulation shows its newest locator to threads that ask all the time. In frame f the box stands at x = f.
 */
typedef struct stage {
    pthread_mutex_t lock;
    vox_locator* shown; /* under the lock */
    int over;           /* under the lock */
} stage;

typedef struct reader {
    stage* of;
    uint64_t asked, wrong, last_epoch;
} reader;

static void* read_shown(void* context) {
    reader* r = (reader*)context;
    for (int over = 0; !over;) {
        pthread_mutex_lock(&r->of->lock);
        vox_locator* locator = r->of->shown;
        over = r->of->over;
        if (locator) r->wrong += vox_locator_retain(locator) != VOX_OK;
        pthread_mutex_unlock(&r->of->lock);
        if (!locator) continue;
        uint64_t epoch = 0;
        r->wrong += vox_locator_get_epoch(locator, &epoch) != VOX_OK || epoch < r->last_epoch;
        r->last_epoch = epoch;
        const double x = (double)epoch, inside[3] = {x + 0.3, 0.4, 0.45}, left[3] = {x - 1, 0.5, 0.5};
        const double right[3] = {x + 3, 0.5, 0.5};
        const vox_positions within = vox_double_positions(inside, 1), from = vox_double_positions(left, 1);
        const vox_positions to = vox_double_positions(right, 1);
        vox_point_hit hit;
        vox_ray_hit rays[8];
        uint64_t count = 0, ray_count = 0;
        uint8_t blocked = 7;
        vox_closest_hit closest;
        vox_query_desc others = vox_default_query_desc();
        if (vox_locator_find_point_hits(locator, &within, NULL, &hit, 1, &count) != VOX_OK || count != 1 ||
            vox_locator_find_closest(locator, &from, NULL, &closest) != VOX_OK || closest.distance != 1 ||
            closest.normal[0] != -1 ||
            vox_locator_find_ray_hits(locator, &from, &to, NULL, rays, 8, &ray_count) != VOX_OK ||
            ray_count < 2)
            ++r->wrong;
        others.excluded = closest.body;
        r->wrong += vox_locator_test_rays(locator, &from, &to, &others, &blocked) != VOX_OK || blocked;
        vox_locator_release(locator);
        ++r->asked;
    }
    return NULL;
}

START_TEST(threads_ask_while_the_grid_steps) {
    enum { readers = 3, frames = 200 };
    ledger l = {0};
    stage s = {.shown = NULL};
    reader all[readers];
    pthread_t threads[readers];
    body box = make_box(4, 0.25f, 0, 0, 0);
    const body at_zero = make_box(4, 0.25f, 0, 0, 0);
    vox_grid_desc desc = engine_desc();
    desc.allocator =
        ledger_allocator(&l); /* which is called by one thread at a time, or the sanitizer complains */
    vox_grid* grid = grid_of(&desc);
    const vox_mesh_desc mesh = body_desc(&box);
    vox_body id = insert_mesh(grid, &mesh);
    vox_locator* mine = NULL;
    pthread_mutex_init(&s.lock, NULL);
    for (int i = 0; i < readers; ++i) {
        all[i] = (reader){.of = &s};
        ck_assert_int_eq(pthread_create(&threads[i], NULL, read_shown, &all[i]), 0);
    }
    for (int frame = 1; frame <= frames; ++frame) {
        for (uint32_t i = 0; i < 3 * box.vertex_count; ++i)
            box.positions[i] = at_zero.positions[i] + (i % 3 == 0 ? (float)frame : 0);
        if (frame % 16 == 0) { /* the same box as another mesh */
            ck_ok(vox_body_remove(grid, id));
            id = insert_mesh(grid, &mesh);
        }
        ck_ok(vox_grid_step(grid));
        ck_ok(vox_grid_update_locator(grid, &mine));
        ck_ok(vox_locator_retain(mine));
        pthread_mutex_lock(&s.lock);
        vox_locator* old = s.shown;
        s.shown = mine;
        pthread_mutex_unlock(&s.lock);
        vox_locator_release(old);
    }
    vox_locator_release(mine);
    vox_grid_destroy(grid); /* while they go on asking */
    free_body(&box);
    pthread_mutex_lock(&s.lock);
    s.over = 1;
    pthread_mutex_unlock(&s.lock);
    for (int i = 0; i < readers; ++i) {
        pthread_join(threads[i], NULL);
        ck_assert_uint_gt(all[i].asked, 0);
        ck_assert_uint_eq(all[i].wrong, 0);
        ck_assert_uint_eq(all[i].last_epoch, frames); /* as the last locator stays shown */
    }
    vox_locator_release(s.shown);
    ck_assert_uint_eq(l.bytes, 0);
    pthread_mutex_destroy(&s.lock);
    body copy = at_zero;
    free_body(&copy);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, answers_stay, locators_side_by_side, as_it_was_when_taken,
                   what_a_locator_says_of_itself, arguments, steady_state_allocates_nothing, updates_release,
                   memory_lives_as_long_as_the_last_locator, without_memory, same_for_any_workers,
                   threads_ask_while_the_grid_steps);
}

SUITE(locators) { add_for_each_engine(suite, add_tests); }
