/* Task systems of the caller and worker counts: the same contacts, and the promises of vox_task_system. */
#include <pthread.h>
#include <string.h>

#include "scenes/bodies.h"
#include "support/constraint_checks.h"
#include "support/ledger.h"
#include "support/locators.h"

/* ---- schedulers ---- */

enum { max_ranges = 64 };

typedef struct queued {
    vox_task* task;
    void* context;
    uint64_t begin[max_ranges], end[max_ranges];
    uint32_t count;
} queued;

typedef struct scheduler {
    uint32_t worker_count;
    uint32_t enqueued; /* since it was last set to 0 */
    uint64_t items;
    uint32_t first_worker; /* runs the first range inline */
    uint32_t defect;       /* what it does wrong on purpose ... */
    uint32_t defect_at;    /* ... in this of its tasks only, from 1 on; 0: in all */
    queued waiting;
    vox_task_system tasks;
} scheduler;

enum { loses_items = 1, wrong_worker = 2, wrong_range = 3, runs_twice = 4 };

static void split(scheduler* s, vox_task* task, uint64_t items, uint64_t min_range, void* context) {
    queued* q = &s->waiting;
    uint64_t size = (items + max_ranges - 1) / max_ranges;
    if (size < min_range) size = min_range;
    if (size == 0) size = 1;
    q->task = task;
    q->context = context;
    q->count = 0;
    s->enqueued += 1;
    s->items += items;
    for (uint64_t begin = 0; begin < items; begin += size, ++q->count) {
        q->begin[q->count] = begin;
        q->end[q->count] = begin + size < items ? begin + size : items;
    }
}

/* Runs everything before enqueue returns. */
static void* inline_enqueue(vox_task* task, uint64_t items, uint64_t min_range, void* context, void* user) {
    scheduler* s = (scheduler*)user;
    split(s, task, items, min_range, context);
    const uint32_t defect = s->defect_at == 0 || s->enqueued == s->defect_at ? s->defect : 0;
    if (defect == runs_twice) { /* as many items as there are, but not each once */
        for (uint32_t i = 0; i < 2; ++i) task(0, items / 2, i, context);
        task(items - items % 2, items, 0, context);
        return NULL;
    }
    for (uint32_t i = defect == loses_items; i < s->waiting.count; ++i) {
        const uint32_t worker =
            defect == wrong_worker ? s->worker_count : (s->first_worker + i) % s->worker_count;
        task(s->waiting.begin[i], s->waiting.end[i] + (defect == wrong_range), worker, context);
    }
    return NULL;
}
static void inline_finish(void* handle, void* user) {
    (void)handle, (void)user;
    ck_abort_msg("finish without a handle");
}

/* Runs everything when it is asked to finish, last range first. */
static void* late_enqueue(vox_task* task, uint64_t items, uint64_t min_range, void* context, void* user) {
    scheduler* s = (scheduler*)user;
    split(s, task, items, min_range, context);
    return &s->waiting;
}
static void late_finish(void* handle, void* user) {
    const queued* q = (const queued*)handle;
    const scheduler* s = (const scheduler*)user;
    ck_assert_ptr_eq(handle, &s->waiting);
    for (uint32_t i = q->count; i-- > 0;) q->task(q->begin[i], q->end[i], i % s->worker_count, q->context);
}

/* A thread a worker. */
typedef struct worker {
    const queued* q;
    uint32_t index, step;
} worker;
static void* work(void* argument) {
    const worker* w = (const worker*)argument;
    for (uint32_t i = w->index; i < w->q->count; i += w->step)
        w->q->task(w->q->begin[i], w->q->end[i], w->index, w->q->context);
    return NULL;
}
static void threaded_finish(void* handle, void* user) {
    const scheduler* s = (const scheduler*)user;
    pthread_t threads[8];
    worker workers[8];
    ck_assert_uint_le(s->worker_count, 8);
    for (uint32_t i = 0; i < s->worker_count; ++i) {
        workers[i].q = (const queued*)handle;
        workers[i].index = i;
        workers[i].step = s->worker_count;
        ck_assert_int_eq(pthread_create(&threads[i], NULL, work, &workers[i]), 0);
    }
    for (uint32_t i = 0; i < s->worker_count; ++i) pthread_join(threads[i], NULL);
}

/* ---- a scene with large and small bodies, self-collision and strided positions ---- */

enum { small_bodies = 40 };
static body large[2], small[small_bodies];
static vox_body meshes[2 + small_bodies]; /* of the last scene */

static void make_bodies(void) {
    large[0] = make_box(12, 0.17f, 0, 0, 0);
    large[1] = make_box(12, 0.15f, 0.9f, 0.8f, 0.7f);
    for (uint32_t v = 0; v < large[0].vertex_count; ++v) /* fold one half of a box into the other */
        if (large[0].positions[3 * v] > 1.5f) large[0].positions[3 * v] = 2.6f - large[0].positions[3 * v];
    for (uint32_t i = 0; i < small_bodies; ++i)
        small[i] = make_box(3, 0.1f, 0.05f * (float)i, 0.03f * (float)(i % 7), 0.2f * (float)(i % 5));
}

static void free_bodies(void) {
    for (int i = 0; i < 2; ++i) free_body(&large[i]);
    for (int i = 0; i < small_bodies; ++i) free_body(&small[i]);
}

static vox_grid* new_scene(const vox_grid_desc* desc) {
    vox_grid* grid = grid_of(desc);
    for (int i = 0; i < 2 + small_bodies; ++i) {
        vox_mesh_desc mesh_desc = body_desc(i < 2 ? &large[i] : &small[i - 2]);
        mesh_desc.filter.flags = i % 3 == 0 ? VOX_FILTER_SELF_COLLISION : 0;
        ck_ok(vox_mesh_insert(grid, &mesh_desc, &meshes[i]));
    }
    return grid;
}

static uint64_t stepped_hash(vox_grid* grid, grid_counts* counters) {
    const uint64_t hash = hash_of_step(grid);
    *counters = counters_of(grid);
    return hash;
}

/* What was done is the same; only how much memory it took may depend on the workers. */
static void check_same_counters(const grid_counts* a, const grid_counts* b) {
    grid_counts x = *a, y = *b;
    x.bytes = y.bytes = x.peak_bytes = y.peak_bytes = 0;
    ck_assert_mem_eq(&x, &y, sizeof x);
}

/* As if all meshes had moved, to where they are. */
static void mark_all(vox_grid* grid) {
    for (int i = 0; i < 2 + small_bodies; ++i) ck_ok(vox_body_mark_moved(grid, meshes[i]));
}

/* ---- tests ---- */

static const struct {
    void* (*enqueue)(vox_task*, uint64_t, uint64_t, void*, void*);
    void (*finish)(void*, void*);
} systems[] = {{inline_enqueue, inline_finish}, {late_enqueue, late_finish}, {late_enqueue, threaded_finish}};
enum { runs_inline = 0, runs_late = 1, runs_threads = 2 };

/* A grid of this engine whose tasks a scheduler of that kind runs. */
static vox_grid_desc scheduled(engine_kind engine, scheduler* s, int kind, uint32_t workers) {
    vox_grid_desc desc = vox_default_grid_desc();
    memset(s, 0, sizeof *s);
    s->worker_count = workers;
    use_engine(&desc, engine);
    desc.flags = VOX_GRID_CONSTRAINTS;
    desc.worker_count = workers;
    const vox_task_system tasks = {systems[kind].enqueue, systems[kind].finish, s};
    s->tasks = tasks;
    desc.tasks = &s->tasks;
    return desc;
}

START_TEST(same_for_any_task_system) {
    scheduler s;
    grid_counts serial, counters;
    vox_grid_desc desc = engine_desc();
    desc.flags = VOX_GRID_CONSTRAINTS;
    make_bodies();
    vox_grid* grid = new_scene(&desc);
    const uint64_t expected = stepped_hash(grid, &serial);
    ck_assert_uint_gt(serial.contacts, 1000);
    const kept_constraints constraints = keep_constraints(grid);
    ck_assert_uint_gt(constraints.count, 1000);
    vox_grid_destroy(grid);

    for (int kind = runs_inline; kind <= runs_threads; ++kind)
        for (uint32_t workers = 1; workers <= 8; workers += workers < 3 ? 1 : 5) {
            desc = scheduled(suite_engine, &s, kind, workers);
            grid = new_scene(&desc);
            for (int step = 0; step < 2; ++step) {
                s.enqueued = 0;
                mark_all(grid);
                ck_assert_uint_eq(stepped_hash(grid, &counters), expected);
                ck_assert_uint_le(s.enqueued, VOX_MAX_TASKS);
                if (workers > 1 && suite_engine == ENGINE_FAST) ck_assert_uint_gt(s.enqueued, 0);
                check_same_counters(&counters, &serial);
                same_constraints(grid, &constraints);
            }
            vox_grid_destroy(grid);
        }
    free(constraints.data);
    free_bodies();
}
END_TEST

START_TEST(same_for_any_worker_count) {
    grid_counts serial, counters;
    vox_grid_desc desc = engine_desc();
    desc.flags = VOX_GRID_CONSTRAINTS;
    make_bodies();
    vox_grid* grid = new_scene(&desc);
    const uint64_t expected = stepped_hash(grid, &serial);
    for (uint32_t workers = 0; workers <= 4; ++workers) {
        ck_ok(vox_grid_set_worker_count(grid, workers));
        for (int step = 0; step < 2; ++step) {
            mark_all(grid);
            ck_assert_uint_eq(stepped_hash(grid, &counters), expected);
            check_same_counters(&counters, &serial);
        }
    }
    ck_ok(vox_grid_set_worker_count(grid, VOX_MAX_WORKERS));
    ck_assert_uint_eq(stepped_hash(grid, &counters), expected);
    vox_grid_destroy(grid);
    free_bodies();
}
END_TEST

START_TEST(non_finite_is_the_same_vertex) {
    scheduler s;
    const vox_grid_desc desc = scheduled(suite_engine, &s, runs_threads, 4);
    make_bodies();
    vox_grid* grid = new_scene(&desc);
    const float zero = 0;
    large[1].positions[3 * 2000] = 1 / zero;
    large[1].positions[3 * 1234 + 2] = 1 / zero;
    small[3].positions[0] = 1 / zero;
    ck_fails(vox_grid_step(grid), VOX_ERROR_NON_FINITE, "body 4097 (slot 1, user data 0), vertex 1234");
    vox_grid_destroy(grid);
    free_bodies();
}
END_TEST

/* A step that finds a bad mesh begins again without it: what it enqueued until then counts, too. */
START_TEST(a_bad_mesh_costs_few_tasks) {
    scheduler s;
    grid_counts counters;
    vox_grid_desc desc = scheduled(suite_engine, &s, runs_threads, 4);
    desc.flags |= VOX_GRID_SKIP_BAD_BODIES;
    make_bodies();
    vox_grid* grid = new_scene(&desc);
    body far = make_box(28, 1, 100, 0, 0); /* positions enough for the workers to share */
    const vox_mesh_desc far_desc = body_desc(&far);
    (void)insert_mesh(grid, &far_desc);
    const float zero = 0;
    (void)stepped_hash(grid, &counters);
    for (int bad = 0; bad < small_bodies; bad += 7) {
        float* x = bad == 0 ? &large[1].positions[3 * 2000] : &small[bad].positions[4];
        const vox_body mesh = meshes[bad == 0 ? 1 : 2 + bad];
        const float good = *x;
        ck_ok(vox_body_set_enabled(grid, mesh, 0));
        mark_all(grid);
        s.enqueued = 0;
        const uint64_t expected = stepped_hash(grid, &counters);
        const uint32_t without = s.enqueued;
        ck_assert_uint_gt(counters.contacts, 1000);
        ck_ok(vox_body_set_enabled(grid, mesh, 1));
        *x = 1 / zero;
        for (int step = 0; step < 2; ++step) { /* the second one knows of the bad mesh before */
            mark_all(grid);
            s.enqueued = 0;
            ck_assert_uint_eq(stepped_hash(grid, &counters), expected);
            ck_assert_uint_eq(counters.skipped_bodies, 1);
            ck_assert_uint_le(s.enqueued, VOX_MAX_TASKS);
            if (suite_engine == ENGINE_FAST) {
                ck_assert_uint_ge(without, 5);
                ck_assert_uint_eq(s.enqueued, without + (step == 0)); /* the stream, a second time */
            }
        }
        *x = good;
        ck_ok(vox_grid_step(grid));
    }
    vox_grid_destroy(grid);
    free_body(&far);
    free_bodies();
}
END_TEST

START_TEST(large_bodies_are_shared) {
    /* One body large enough that the workers share the making of its window, and one that is not. */
    scheduler s;
    grid_counts serial, counters;
    vox_grid* grid = NULL;
    vox_body mesh = 0;
    uint64_t expected = 0;
    body bodies[2] = {make_box(30, 0.0625f, 0, 0, 0), make_box(8, 0.0625f, 1.75f, 1.75f, 1.75f)};
    for (uint32_t workers = 1; workers <= 4; workers += 3) {
        const vox_grid_desc desc = scheduled(ENGINE_FAST, &s, runs_threads, workers);
        ck_ok(vox_grid_create(&desc, &grid));
        for (int i = 0; i < 2; ++i) {
            vox_mesh_desc mesh_desc = body_desc(&bodies[i]);
            mesh_desc.filter.flags = VOX_FILTER_SELF_COLLISION;
            ck_ok(vox_mesh_insert(grid, &mesh_desc, &mesh));
        }
        const uint64_t hash = stepped_hash(grid, workers == 1 ? &serial : &counters);
        if (workers == 1) expected = hash;
        ck_assert_uint_eq(hash, expected);
        vox_grid_destroy(grid);
    }
    ck_assert_uint_le(s.enqueued, VOX_MAX_TASKS);
    ck_assert_uint_gt(serial.contacts, 0);
    check_same_counters(&counters, &serial);
    for (int i = 0; i < 2; ++i) free_body(&bodies[i]);
}
END_TEST

START_TEST(trees_of_many_bodies_are_few_tasks) {
    /* More bodies with a large surface than a step may have tasks; a point in each needs a search of it. */
    enum { plates = 70 };
    scheduler s;
    body plate = make_block(&five_cut, 46, 46, 1);
    float points[3 * plates];
    vox_body mesh = 0;
    const vox_grid_desc desc = scheduled(suite_engine, &s, runs_threads, 4);
    vox_grid* grid = grid_of(&desc);
    for (uint32_t i = 0; i < plates; ++i) {
        const vox_mesh_desc mesh_desc = body_desc(&plate);
        const double above[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 2.0 * i};
        ck_ok(vox_mesh_insert(grid, &mesh_desc, &mesh));
        ck_ok(vox_body_set_transform(grid, mesh, above));
        points[3 * i] = 20.3f;
        points[3 * i + 1] = 20.4f;
        points[3 * i + 2] = 2.0f * (float)i + 0.25f;
    }
    const vox_mesh_desc point_desc = vox_mesh_desc_floats(points, plates, NULL, 0);
    ck_ok(vox_mesh_insert(grid, &point_desc, &mesh));
    s.enqueued = 0;
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_le(s.enqueued, VOX_MAX_TASKS);
    const vox_constraint_view found = constraints_of(grid);
    ck_assert_uint_eq(found.count, plates);
    for (uint32_t i = 0; i < plates; ++i) {
        ck_assert_int_eq(found.data[i].state, VOX_DEPTH_CLOSEST);
        ck_assert_double_eq(found.data[i].gap, -0.25);
    }
    vox_grid_destroy(grid);
    free_body(&plate);
}
END_TEST

/* ---- memory ---- */

START_TEST(steady_state_allocates_nothing) {
    /* Whichever worker meets whichever body. */
    scheduler s;
    for (uint32_t workers = 1; workers <= 7; workers += 3) {
        ledger l = {0};
        uint64_t before = 0;
        grid_counts counters;
        vox_grid_desc desc = scheduled(suite_engine, &s, runs_inline, workers);
        desc.allocator = ledger_allocator(&l);
        make_bodies();
        vox_grid* grid = new_scene(&desc);
        for (int step = 0; step < 12; ++step) {
            mark_all(grid);
            (void)stepped_hash(grid, &counters);
            if (step > 1) ck_assert_msg(l.calls == before, "step %d of %u workers", step, workers);
            before = l.calls;
            s.first_worker += 1 + (uint32_t)step / 4;
        }
        ck_assert_uint_gt(l.calls, 0);
        vox_grid_destroy(grid);
        free_bodies();
    }
}
END_TEST

START_TEST(budget_that_ends_in_a_task) {
    scheduler s;
    grid_counts full;
    uint32_t failures = 0;
    vox_grid_desc desc = scheduled(suite_engine, &s, runs_threads, 4);
    make_bodies();
    vox_grid* grid = new_scene(&desc);
    const uint64_t least = counters_of(grid).peak_bytes;
    const uint64_t expected = stepped_hash(grid, &full);
    vox_grid_destroy(grid);
    const uint64_t step_bytes = full.peak_bytes - least;
    ck_assert_uint_gt(step_bytes, 100000);

    for (uint64_t part = 0; part <= 20; part += 2) {
        uint64_t hash = 0;
        desc.byte_budget = least + step_bytes * part / 16;
        grid = new_scene(&desc);
        for (int step = 0; step < 2; ++step) {
            const vox_result result = vox_grid_step(grid);
            if (result == VOX_OK) {
                ck_ok(vox_grid_get_hash(grid, &hash));
                ck_assert_uint_eq(hash, expected);
                continue;
            }
            ++failures;
            ck_assert_int_eq(result, VOX_ERROR_BUDGET);
            ck_assert_uint_eq(contacts_of(grid).count, 0);
        }
        ck_ok(vox_grid_clear(grid)); /* gives up the meshes; now there is room for a small one */
        const vox_mesh_desc mesh_desc = body_desc(&small[0]);
        insert_mesh(grid, &mesh_desc);
        ck_ok(vox_grid_step(grid));
        vox_grid_destroy(grid);
    }
    ck_assert_uint_ge(failures, 6);
    free_bodies();
}
END_TEST

START_TEST(defective_task_systems) {
    /* A scheduler that loses work or reports wrong ranges gets an error; nothing is silently missing. */
    static const char* const words[] = {"items", "worker 4 of 4", "items", "twice and others not at all"};
    scheduler s;
    make_bodies();
    for (uint32_t defect = loses_items; defect <= runs_twice; ++defect) {
        const vox_grid_desc desc = scheduled(ENGINE_FAST, &s, runs_inline, 4);
        vox_grid* grid = new_scene(&desc);
        grid_counts counters;
        s.defect = defect;
        ck_fails(vox_grid_step(grid), VOX_ERROR_INVALID_ARGUMENT, words[defect - 1]);
        s.defect = 0;
        (void)stepped_hash(grid, &counters);
        ck_assert_uint_gt(counters.contacts, 1000);
        vox_grid_destroy(grid);
    }
    free_bodies();
}
END_TEST

/* The functions that enqueue tasks. */
static vox_result call_step(vox_grid* grid) { return vox_grid_step(grid); }
static vox_result call_constraints(vox_grid* grid) {
    vox_constraint_desc desc = vox_default_constraint_desc();
    desc.method = VOX_DEPTH_METHOD_CLOSEST; /* not what the step has found */
    return vox_grid_find_constraints(grid, &desc);
}
static vox_result call_locator(vox_grid* grid) {
    vox_locator* locator = NULL;
    const vox_result result = vox_grid_update_locator(grid, &locator);
    ck_assert((result == VOX_OK) == (locator != NULL));
    vox_locator_release(locator);
    return result;
}

START_TEST(a_defect_in_any_one_task) {
    /* The scene is large enough that every stage is shared: each defect in each task of each function is
     * found, and the next call with a sound scheduler gives what it should. */
    vox_result (*const calls[])(vox_grid*) = {call_step, call_constraints, call_locator};
    const uint32_t least[] = {suite_engine == ENGINE_FAST ? 8 : 1, 1, 1}; /* tasks there have to be */
    scheduler s;
    grid_counts counters;
    make_bodies();
    const vox_grid_desc desc = scheduled(suite_engine, &s, runs_inline, 4);
    vox_grid* grid = new_scene(&desc);
    const uint64_t expected = stepped_hash(grid, &counters);
    for (uint32_t call = 0; call < 3; ++call)
        for (uint32_t defect = loses_items; defect <= runs_twice; ++defect) {
            uint32_t at = 0;
            for (;;) {
                s.defect = 0;
                mark_all(grid);
                ck_assert_uint_eq(stepped_hash(grid, &counters), expected);
                mark_all(grid);
                s.defect = defect;
                s.defect_at = ++at;
                s.enqueued = 0;
                const vox_result result = calls[call](grid);
                if (s.enqueued < at) { /* no such task */
                    ck_assert_int_eq(result, VOX_OK);
                    break;
                }
                ck_assert_msg(result == VOX_ERROR_INVALID_ARGUMENT, "call %u, defect %u in task %u: %d", call,
                              defect, at, (int)result);
                if (call == 0) ck_assert_uint_eq(contacts_of(grid).count, 0);
            }
            ck_assert_msg(at > least[call], "call %u has %u tasks", call, at - 1);
        }
    vox_grid_destroy(grid);
    free_bodies();
}
END_TEST

START_TEST(bad_arguments) {
    vox_grid* grid = NULL;
    vox_grid_desc desc = vox_default_grid_desc();
    desc.worker_count = VOX_MAX_WORKERS + 1;
    ck_fails(vox_grid_create(&desc, &grid), VOX_ERROR_INVALID_ARGUMENT, "worker_count is 257");
    desc.worker_count = 2;
    vox_task_system tasks = {inline_enqueue, NULL, NULL};
    desc.tasks = &tasks;
    ck_fails(vox_grid_create(&desc, &grid), VOX_ERROR_INVALID_ARGUMENT, "enqueue and finish");
    tasks.finish = inline_finish;
    desc.worker_count = VOX_ALL_CORES;
    ck_fails(vox_grid_create(&desc, &grid), VOX_ERROR_INVALID_ARGUMENT, "worker_count is VOX_ALL_CORES");
    ck_assert_ptr_null(grid);
    desc.worker_count = 1;
    ck_ok(vox_grid_create(&desc, &grid));
    ck_fails(vox_grid_set_worker_count(grid, VOX_ALL_CORES), VOX_ERROR_INVALID_ARGUMENT,
             "worker_count is VOX_ALL_CORES");
    ck_fails(vox_grid_set_worker_count(grid, 1000), VOX_ERROR_INVALID_ARGUMENT, "worker_count is 1000");
    ck_fails(vox_grid_set_worker_count(NULL, 1), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    vox_grid_destroy(grid);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, same_for_any_task_system, same_for_any_worker_count, non_finite_is_the_same_vertex,
                   steady_state_allocates_nothing, budget_that_ends_in_a_task, a_bad_mesh_costs_few_tasks,
                   large_bodies_are_shared, trees_of_many_bodies_are_few_tasks, defective_task_systems,
                   a_defect_in_any_one_task, bad_arguments);
}

SUITE(threads) { add_for_each_engine(suite, add_tests); }
