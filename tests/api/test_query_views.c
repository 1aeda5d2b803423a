/* Query views: their answers are those of the moment they were taken, whatever happens to the grid, on any
 * thread. */
#include <pthread.h>

#include "support/ledger.h"
#include "support/query_checks.h"

static vox_query_view* take_view(vox_grid* grid) {
    vox_query_view* view = NULL;
    ck_ok(vox_grid_take_query_view(grid, &view));
    return view;
}

/* ---- all answers as one number ---- */

static void add_bytes(uint64_t* hash, const void* bytes, size_t size) {
    for (size_t i = 0; i < size; ++i) *hash = (*hash ^ ((const uint8_t*)bytes)[i]) * 0x100000001b3u;
}

/* The answers of a view or, where that is null, of a grid. */
static uint64_t hash_of_answers(const vox_query_view* view, const vox_grid* grid) {
    enum { n = 40, room = 512 };
    static vox_point_hit points[room];
    static vox_tet_hit tets[room];
    static vox_facet_hit facets[room];
    uint64_t hash = 0xcbf29ce484222325u, random = 21, count = 0, met = 0;
    double asked[n][3];
    for (int i = 0; i < n; ++i) {
        float p[3], q[3];
        random_point(&random, i % 2, p);
        random_point(&random, i % 2, q);
        double to[3], max[3];
        for (int axis = 0; axis < 3; ++axis) {
            asked[i][axis] = (double)p[axis];
            to[axis] = (double)q[axis];
            max[axis] = asked[i][axis] + 0.5;
        }
        vox_surface_hit closest;
        vox_ray_hit ray;
        uint32_t any = 0;
#define ASK(what, ...)                                                                                       \
    ck_ok(view ? vox_query_view_##what(view, __VA_ARGS__) : vox_grid_query_##what(grid, __VA_ARGS__))
        ASK(point, asked[i], UINT64_MAX, points, room, &count);
        add_bytes(&hash, points, (count < room ? count : room) * sizeof *points);
        met += count;
        ASK(box, asked[i], max, UINT64_MAX, tets, room, &count);
        add_bytes(&hash, tets, (count < room ? count : room) * sizeof *tets);
        ASK(closest, asked[i], INFINITY, UINT64_MAX, &closest);
        add_bytes(&hash, &closest, sizeof closest);
        ASK(ray, asked[i], to, UINT64_MAX, &ray);
        add_bytes(&hash, &ray, sizeof ray);
        ASK(ray_hits, asked[i], to, UINT64_MAX, VOX_NULL_BODY, facets, room, &count);
        add_bytes(&hash, facets, (count < room ? count : room) * sizeof *facets);
        ASK(ray_any, asked[i], to, UINT64_MAX, VOX_NULL_BODY, &any);
        add_bytes(&hash, &any, sizeof any);
    }
    vox_closest_desc desc = vox_default_closest_desc();
    vox_closest_hit closest[n];
    desc.points = asked;
    desc.format = VOX_FORMAT_DOUBLE;
    desc.point_count = n;
    ASK(closest_points, &desc, closest);
    add_bytes(&hash, closest, sizeof closest);
    ASK(points, asked, VOX_FORMAT_DOUBLE, 0, n, UINT64_MAX, points, room, &count);
    add_bytes(&hash, points, (count < room ? count : room) * sizeof *points);
#undef ASK
    ck_assert_uint_eq(met, count);
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
        vox_query_view* view = take_view(w.grid);
        const uint64_t expected = hash_of_answers(NULL, w.grid);
        ck_assert_uint_eq(hash_of_answers(view, NULL), expected);

        move_all(&w, 0.375f); /* borrowed positions are overwritten */
        ck_assert_uint_eq(hash_of_answers(view, NULL), expected);
        ck_ok(vox_grid_step(w.grid));
        ck_assert_uint_eq(hash_of_answers(view, NULL), expected);
        ck_assert_uint_eq(hash_of_answers(NULL, w.grid),
                          expected); /* a view does not change what was prepared */
        ck_ok(vox_grid_prepare_queries(w.grid));
        const uint64_t moved = hash_of_answers(NULL, w.grid);
        ck_assert_uint_ne(moved, expected);
        vox_query_view* later = take_view(w.grid);
        ck_assert_uint_eq(hash_of_answers(later, NULL), moved);

        const double matrix[12] = {0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 2};
        ck_ok(vox_body_set_transform(w.grid, w.meshes[0], matrix));
        const uint32_t tets[2] = {0, 3};
        ck_ok(vox_mesh_remove_tets(w.grid, w.meshes[0], tets, 2));
        ck_ok(vox_grid_step(w.grid));
        vox_query_view* cut = take_view(w.grid);
        ck_ok(vox_grid_prepare_queries(w.grid));
        const uint64_t of_cut = hash_of_answers(NULL, w.grid);
        ck_assert_uint_ne(of_cut, moved);
        ck_assert_uint_eq(hash_of_answers(cut, NULL), of_cut);

        ck_ok(vox_body_set_enabled(w.grid, w.meshes[0], 0));
        ck_ok(vox_body_remove(w.grid, w.meshes[w.count - 1]));
        ck_ok(vox_grid_step(w.grid));
        for (int kind = 0; kind < 3; ++kind) {
            if (kind == 1) ck_ok(vox_grid_clear(w.grid));
            if (kind == 2) end_world(&w); /* the grid, and the arrays of positions */
            ck_assert_uint_eq(hash_of_answers(view, NULL), expected);
            ck_assert_uint_eq(hash_of_answers(later, NULL), moved);
            ck_assert_uint_eq(hash_of_answers(cut, NULL), of_cut);
        }
        vox_query_view_release(view);
        vox_query_view_release(cut);
        vox_query_view_release(later);
    }
}
END_TEST

/* Views in use are left alone while those that were released are used again, whatever the meshes are by then.
 */
START_TEST(views_side_by_side) {
    enum { most = 4 };
    uint64_t random = 32, expected[most] = {0};
    vox_query_view* views[most] = {NULL};
    world w = new_world(&random, 0);
    for (int round = 0; round < 60; ++round) {
        const uint32_t which = random_below(&random, most);
        vox_query_view_release(views[which]);
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
        views[which] = take_view(w.grid);
        ck_ok(vox_grid_prepare_queries(w.grid));
        expected[which] = hash_of_answers(NULL, w.grid);
        for (int i = 0; i < most; ++i)
            if (views[i]) ck_assert_uint_eq(hash_of_answers(views[i], NULL), expected[i]);
    }
    for (int i = 0; i < most; ++i) vox_query_view_release(views[i]);
    end_world(&w);
}
END_TEST

START_TEST(what_a_view_says_of_itself) {
    uint64_t epoch = 77, user_data = 77, random = 33;
    world w = new_world(&random, 0);
    vox_mesh_desc mesh = body_desc(&w.bodies[0]);
    vox_body id = VOX_NULL_BODY;
    mesh.user_data = 1234567890123u;
    ck_ok(vox_mesh_insert(w.grid, &mesh, &id));
    ck_ok(vox_grid_step(w.grid));
    ck_ok(vox_grid_step(w.grid));
    vox_query_view* view = take_view(w.grid);
    ck_ok(vox_body_remove(w.grid, id));
    ck_ok(vox_grid_step(w.grid));
    ck_ok(vox_query_view_epoch(view, &epoch));
    ck_assert_uint_eq(epoch, 2);
    ck_ok(vox_query_view_user_data(view, id, &user_data));
    ck_assert_uint_eq(user_data, 1234567890123u);
    ck_fails(vox_query_view_user_data(view, id + 1, &user_data), VOX_ERROR_INVALID_HANDLE, "is none of the");
    ck_fails(vox_query_view_user_data(view, VOX_NULL_BODY, &user_data), VOX_ERROR_INVALID_HANDLE,
             "mesh 0 is none");
    ck_assert_uint_eq(user_data, 1234567890123u);
    vox_query_view_release(view);

    /* Without meshes that have tetrahedra: a view of nothing. */
    ck_ok(vox_grid_clear(w.grid));
    view = take_view(w.grid);
    const double p[3] = {1, 1, 1};
    vox_surface_hit hit;
    uint64_t count = 77;
    ck_ok(vox_query_view_closest(view, p, INFINITY, UINT64_MAX, &hit));
    ck_assert_uint_eq(hit.mesh, VOX_NULL_BODY);
    ck_ok(vox_query_view_point(view, p, UINT64_MAX, NULL, 0, &count));
    ck_assert_uint_eq(count, 0);
    ck_fails(vox_query_view_user_data(view, id, &user_data), VOX_ERROR_INVALID_HANDLE, "the 0 meshes");
    vox_query_view_release(view);
    end_world(&w);
}
END_TEST

START_TEST(arguments) {
    uint64_t random = 34, number = 77;
    world w = new_world(&random, 0);
    vox_query_view* view = NULL;
    ck_fails(vox_grid_take_query_view(NULL, &view), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_take_query_view(w.grid, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_view is null");
    ck_fails(vox_query_view_retain(NULL), VOX_ERROR_INVALID_ARGUMENT, "view is null");
    ck_fails(vox_query_view_epoch(NULL, &number), VOX_ERROR_INVALID_ARGUMENT, "view is null");
    ck_fails(vox_query_view_user_data(NULL, w.meshes[0], &number), VOX_ERROR_INVALID_ARGUMENT,
             "view is null");
    vox_query_view_release(NULL);
    const float kept = w.bodies[0].positions[4];
    w.bodies[0].positions[4] = NAN;
    ck_fails(vox_grid_take_query_view(w.grid, &view), VOX_ERROR_NON_FINITE, "vertex 1: position (");
    ck_assert_ptr_null(view);
    w.bodies[0].positions[4] = kept;
    vox_mesh_desc bare = body_desc(&w.bodies[0]);
    vox_body mesh = VOX_NULL_BODY;
    bare.positions.data = NULL;
    ck_ok(vox_mesh_insert(w.grid, &bare, &mesh));
    ck_fails(vox_grid_take_query_view(w.grid, &view), VOX_ERROR_INVALID_STATE, "has no positions");
    ck_ok(vox_body_remove(w.grid, mesh));
    view = take_view(w.grid);
    ck_fails(vox_query_view_epoch(view, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_epoch is null");
    ck_fails(vox_query_view_user_data(view, w.meshes[0], NULL), VOX_ERROR_INVALID_ARGUMENT,
             "out_user_data is null");
    ck_ok(vox_query_view_retain(view));
    vox_query_view_release(view);
    ck_ok(vox_query_view_epoch(view, &number)); /* one owner is left */
    vox_query_view_release(view);
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
    vox_query_view* shown = NULL; /* what another thread asks */
    uint64_t calls = 0;
    for (int frame = 0; frame < 10; ++frame) {
        for (uint32_t i = 0; i < 3 * box.vertex_count; ++i) box.positions[i] += 0.01f;
        ck_ok(vox_grid_step(grid));
        vox_query_view* next = take_view(grid);
        vox_query_view_release(shown);
        shown = next;
        ck_assert_uint_eq(counters_of(grid).bytes, l.bytes); /* views are counted */
        if (frame > 3) ck_assert_uint_eq(l.calls, calls);
        calls = l.calls;
    }
    const uint64_t with_views = l.bytes;
    ck_ok(vox_grid_clear(grid)); /* gives up the view that nobody uses, and what the mesh held */
    ck_assert_uint_lt(l.bytes, with_views);
    ck_assert_uint_eq(counters_of(grid).bytes, l.bytes);
    const uint64_t cleared = l.bytes;
    vox_query_view_release(shown);
    ck_assert_uint_eq(l.bytes, cleared); /* waits for the next one */
    ck_ok(vox_grid_clear(grid));
    ck_assert_uint_lt(l.bytes, cleared);
    vox_grid_destroy(grid);
    ck_assert_uint_eq(l.bytes, 0);
    free_body(&box);
}
END_TEST

START_TEST(memory_lives_as_long_as_the_last_view) {
    ledger l = {0};
    body box = make_box(4, 0.25f, 0, 0, 0);
    vox_grid* grid = counted_world(&l, &box, 0);
    vox_query_view* views[3];
    for (int i = 0; i < 3; ++i) views[i] = take_view(grid);
    ck_ok(vox_query_view_retain(views[1]));
    vox_query_view_release(views[0]);
    vox_grid_destroy(grid);
    uint64_t before = l.bytes;
    ck_assert_uint_gt(before, 0);
    vox_query_view_release(views[1]);
    ck_assert_uint_eq(l.bytes, before); /* retained */
    const uint64_t hash = hash_of_answers(views[1], NULL);
    ck_assert_uint_eq(hash_of_answers(views[2], NULL), hash);
    vox_query_view_release(views[2]);
    ck_assert_uint_lt(l.bytes, before);
    ck_assert_uint_eq(hash_of_answers(views[1], NULL), hash);
    vox_query_view_release(views[1]);
    ck_assert_uint_eq(l.bytes, 0);
    free_body(&box);
}
END_TEST

/* Whatever call to the allocator fails, and at whatever budget: the error, and no harm. */
START_TEST(without_memory) {
    body box = make_box(3, 0.25f, 0, 0, 0);
    uint32_t failures = 0, views = 0;
    for (uint64_t fail_at = 1; views == 0; ++fail_at) {
        ledger l = {0};
        l.fail_at = fail_at;
        vox_grid* grid = counted_world(&l, &box, 0);
        if (!grid) continue;
        vox_query_view* view = NULL;
        if (vox_grid_prepare_queries(grid) != VOX_OK) ck_ok(vox_grid_prepare_queries(grid)); /* fails once */
        const uint64_t prepared = hash_of_answers(NULL, grid);
        const vox_result result = vox_grid_take_query_view(grid, &view);
        if (result != VOX_OK) {
            ck_assert_int_eq(result, VOX_ERROR_OUT_OF_MEMORY);
            ck_assert_ptr_null(view);
            ++failures;
            view = take_view(grid); /* the next call does not fail */
        } else if (l.calls < fail_at) {
            ++views;
        }
        ck_assert_uint_eq(hash_of_answers(view, NULL), prepared);
        ck_assert_uint_eq(hash_of_answers(NULL, grid), prepared);
        vox_grid_destroy(grid);
        vox_query_view_release(view);
        ck_assert_uint_eq(l.bytes, 0);
    }
    ck_assert_uint_gt(failures, 5);

    ledger l = {0};
    vox_grid* grid = counted_world(&l, &box, 0);
    vox_query_view* view = take_view(grid);
    const uint64_t enough = l.peak;
    vox_grid_destroy(grid);
    vox_query_view_release(view);
    uint32_t refused = 0;
    for (uint64_t budget = enough - enough / 32; budget <= enough; budget += enough / 2048) {
        ledger of_budget = {0};
        grid = counted_world(&of_budget, &box, budget);
        if (!grid) continue;
        view = NULL;
        const vox_result result = vox_grid_take_query_view(grid, &view);
        if (result != VOX_OK) {
            ck_assert_int_eq(result, VOX_ERROR_BUDGET);
            ck_assert_ptr_null(view);
            ++refused;
        }
        ck_assert_uint_le(of_budget.peak, budget);
        vox_query_view_release(view);
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
    vox_query_view* view = NULL;
    vox_grid* grid = engine_grid();
    uint64_t any = 0;
    insert_mesh(grid, &mesh);
    view = take_view(grid);
    const uint64_t expected = hash_of_answers(view, NULL);
    vox_query_view_release(view);
    ck_ok(vox_grid_set_worker_count(grid, VOX_ALL_CORES));
    view = take_view(grid);
    ck_assert_uint_eq(hash_of_answers(view, NULL), expected);
    vox_query_view_release(view);
    vox_grid_destroy(grid);
    for (uint32_t workers = 2; workers <= 5; ++workers) {
        scheduler s = {workers, 0, 0};
        vox_grid_desc desc = engine_desc();
        desc.worker_count = workers;
        const vox_task_system tasks = {enqueue, finish, &s};
        desc.tasks = &tasks;
        grid = grid_of(&desc);
        insert_mesh(grid, &mesh);
        view = take_view(grid);
        ck_assert_uint_ge(s.enqueued, 3);
        ck_assert_uint_le(s.enqueued, 4);
        ck_assert_uint_eq(hash_of_answers(view, NULL), expected);
        s.enqueued = 0;
        ck_ok(vox_grid_prepare_queries(grid));
        ck_assert_uint_le(s.enqueued, 4);
        ck_assert_uint_eq(hash_of_answers(NULL, grid), expected);
        /* A task system that loses work: an error, and nothing is prepared. */
        s.loses_items = 1;
        vox_query_view* none = NULL;
        ck_fails(vox_grid_take_query_view(grid, &none), VOX_ERROR_INVALID_ARGUMENT, "items");
        ck_assert_ptr_null(none);
        ck_assert_uint_eq(hash_of_answers(NULL, grid), expected);
        ck_fails(vox_grid_prepare_queries(grid), VOX_ERROR_INVALID_ARGUMENT, "items");
        const double p[3] = {1, 1, 1};
        ck_fails(vox_grid_query_point(grid, p, 1, NULL, 0, &any), VOX_ERROR_INVALID_STATE, "prepare_queries");
        s.loses_items = 0;
        ck_ok(vox_grid_prepare_queries(grid));
        ck_assert_uint_eq(hash_of_answers(NULL, grid), expected);
        ck_assert_uint_eq(hash_of_answers(view, NULL), expected);
        vox_query_view_release(view);
        vox_grid_destroy(grid);
    }
    free_body(&box);
}
END_TEST

/* ---- threads ---- */

/* A simulation shows its newest view to threads that ask all the time. In frame f the box stands at x = f. */
typedef struct stage {
    pthread_mutex_t lock;
    vox_query_view* shown; /* under the lock */
    int over;              /* under the lock */
} stage;

typedef struct reader {
    stage* of;
    uint64_t asked, wrong, last_epoch;
} reader;

static void* read_views(void* context) {
    reader* r = (reader*)context;
    for (int over = 0; !over;) {
        pthread_mutex_lock(&r->of->lock);
        vox_query_view* view = r->of->shown;
        over = r->of->over;
        if (view) r->wrong += vox_query_view_retain(view) != VOX_OK;
        pthread_mutex_unlock(&r->of->lock);
        if (!view) continue;
        uint64_t epoch = 0;
        r->wrong += vox_query_view_epoch(view, &epoch) != VOX_OK || epoch < r->last_epoch;
        r->last_epoch = epoch;
        const double x = (double)epoch, inside[3] = {x + 0.3, 0.4, 0.45}, left[3] = {x - 1, 0.5, 0.5};
        const double right[3] = {x + 3, 0.5, 0.5};
        vox_point_hit hit;
        vox_facet_hit facets[8];
        uint64_t count = 0, facet_count = 0;
        uint32_t any = 0;
        vox_closest_hit closest;
        vox_closest_desc desc = vox_default_closest_desc();
        desc.points = left;
        desc.format = VOX_FORMAT_DOUBLE;
        desc.point_count = 1;
        if (vox_query_view_point(view, inside, UINT64_MAX, &hit, 1, &count) != VOX_OK || count != 1 ||
            vox_query_view_closest_points(view, &desc, &closest) != VOX_OK || closest.distance != 1 ||
            closest.normal[0] != -1 ||
            vox_query_view_ray_hits(view, left, right, UINT64_MAX, VOX_NULL_BODY, facets, 8, &facet_count) !=
                VOX_OK ||
            facet_count < 2 ||
            vox_query_view_ray_any(view, left, right, UINT64_MAX, closest.mesh, &any) != VOX_OK || any)
            ++r->wrong;
        vox_query_view_release(view);
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
    pthread_mutex_init(&s.lock, NULL);
    for (int i = 0; i < readers; ++i) {
        all[i] = (reader){.of = &s};
        ck_assert_int_eq(pthread_create(&threads[i], NULL, read_views, &all[i]), 0);
    }
    for (int frame = 1; frame <= frames; ++frame) {
        for (uint32_t i = 0; i < 3 * box.vertex_count; ++i)
            box.positions[i] = at_zero.positions[i] + (i % 3 == 0 ? (float)frame : 0);
        if (frame % 16 == 0) { /* the same box as another mesh */
            ck_ok(vox_body_remove(grid, id));
            id = insert_mesh(grid, &mesh);
        }
        ck_ok(vox_grid_step(grid));
        vox_query_view* view = take_view(grid);
        pthread_mutex_lock(&s.lock);
        vox_query_view* old = s.shown;
        s.shown = view;
        pthread_mutex_unlock(&s.lock);
        vox_query_view_release(old);
    }
    vox_grid_destroy(grid); /* while they go on asking */
    free_body(&box);
    pthread_mutex_lock(&s.lock);
    s.over = 1;
    pthread_mutex_unlock(&s.lock);
    for (int i = 0; i < readers; ++i) {
        pthread_join(threads[i], NULL);
        ck_assert_uint_gt(all[i].asked, 0);
        ck_assert_uint_eq(all[i].wrong, 0);
        ck_assert_uint_eq(all[i].last_epoch, frames); /* as the last view stays shown */
    }
    vox_query_view_release(s.shown);
    ck_assert_uint_eq(l.bytes, 0);
    pthread_mutex_destroy(&s.lock);
    body copy = at_zero;
    free_body(&copy);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, answers_stay, views_side_by_side, what_a_view_says_of_itself, arguments,
                   steady_state_allocates_nothing, memory_lives_as_long_as_the_last_view, without_memory,
                   same_for_any_workers, threads_ask_while_the_grid_steps);
}

SUITE(query_views) { add_for_each_engine(suite, add_tests); }
