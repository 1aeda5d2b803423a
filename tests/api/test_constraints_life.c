/* The life of constraints: arguments, when there are none, what errors leave, memory. */
#include <stddef.h>

#include "support/constraint_scenes.h"
#include "support/ledger.h"

/* Three boxes in each other in a row: the first and the last do not touch. A fourth one is alone. */
typedef struct row {
    body bodies[4];
    vox_body ids[4];
    vox_grid* grid;
} row;

static row make_row(const vox_grid_desc* desc) {
    row r;
    r.grid = grid_of(desc);
    for (int b = 0; b < 4; ++b) {
        r.bodies[b] = make_box(3, 0.5f, (float)b * (b < 3 ? 1.1f : 3), 0.13f * (float)b, 0.17f * (float)b);
        const vox_mesh_desc mesh = body_desc(&r.bodies[b]);
        r.ids[b] = insert_mesh(r.grid, &mesh);
    }
    return r;
}

static row plain_row(void) {
    const vox_grid_desc desc = engine_desc();
    return make_row(&desc);
}

static void free_row(row* r) {
    vox_grid_destroy(r->grid);
    for (int b = 0; b < 4; ++b) free_body(&r->bodies[b]);
}

static vox_constraint_desc of_pair(vox_body a, vox_body b) {
    vox_constraint_desc desc = vox_default_constraint_desc();
    desc.body_a = a;
    desc.body_b = b;
    return desc;
}

/* The same arrays with the same contents. */
static void check_kept(const vox_grid* grid, vox_constraint_view view, kept_constraints kept) {
    const vox_constraint_view now = constraints_of(grid);
    ck_assert_ptr_eq(now.data, view.data);
    ck_assert_ptr_eq(now.pair_offsets, view.pair_offsets);
    ck_assert_uint_eq(now.pair_count, view.pair_count);
    ck_assert_uint_eq(now.count, kept.count);
    ck_assert_mem_eq(now.data, kept.data, kept.count * sizeof *kept.data);
}

static void check_none(const vox_grid* grid) {
    vox_constraint_view view = {NULL, 7, NULL, 7};
    ck_fails(vox_grid_get_constraints(grid, &view), VOX_ERROR_INVALID_STATE, "vox_grid_find_constraints");
    ck_assert(view.count == 7 && view.pair_count == 7);
}

/* ---- arguments ---------------------------------------------------------------------------------- */

START_TEST(arguments) {
    row r = plain_row();
    vox_constraint_view view;
    ck_ok(vox_grid_step(r.grid));
    vox_constraint_desc desc = vox_default_constraint_desc();
    ck_assert_uint_eq(desc.struct_size, sizeof desc);
    ck_assert_uint_eq(desc.body_a + desc.body_b + desc.mask + desc.closest_budget, 0);
    ck_assert_int_eq(desc.method, VOX_DEPTH_METHOD_CONSISTENT);
    desc = of_pair(r.ids[2], VOX_NULL_BODY);
    ck_ok(vox_grid_find_constraints(r.grid, &desc));
    kept_constraints kept = keep_constraints(r.grid);
    ck_assert_uint_gt(kept.count, 5);
    view = constraints_of(r.grid);

    ck_fails(vox_grid_get_constraints(NULL, &view), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_get_constraints(r.grid, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_view is null");
    ck_fails(vox_grid_find_constraints(NULL, &desc), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    const int bad[] = {-1, 3, 1 << 30};
    for (int i = 0; i < 3; ++i) {
        desc = vox_default_constraint_desc();
        memcpy(&desc.method, &bad[i], sizeof bad[i]);
        ck_fails(vox_grid_find_constraints(r.grid, &desc), VOX_ERROR_INVALID_ARGUMENT, "desc.method is");
    }
    desc = of_pair(VOX_NULL_BODY, r.ids[1]);
    ck_fails(vox_grid_find_constraints(r.grid, &desc), VOX_ERROR_INVALID_ARGUMENT, "there is no body_a");
    desc = of_pair(0x5001, VOX_NULL_BODY);
    ck_fails(vox_grid_find_constraints(r.grid, &desc), VOX_ERROR_INVALID_HANDLE, "20481");
    desc = of_pair(r.ids[0], 0x5001);
    ck_fails(vox_grid_find_constraints(r.grid, &desc), VOX_ERROR_INVALID_HANDLE, "20481");
    desc.struct_size = 2;
    ck_fails(vox_grid_find_constraints(r.grid, &desc), VOX_ERROR_INVALID_ARGUMENT, "struct_size is 2");
    check_kept(r.grid, view, kept);
    free(kept.data);

    /* A program that knows the first two fields. */
    desc.struct_size = (uint32_t)offsetof(vox_constraint_desc, body_a);
    desc.method = VOX_DEPTH_METHOD_CLOSEST;
    ck_ok(vox_grid_find_constraints(r.grid, &desc));
    check_depths(r.grid);
    ck_assert_uint_eq(constraints_of(r.grid).data[0].count, 4);
    /* A pair that does not touch has none. */
    desc = of_pair(r.ids[0], r.ids[2]);
    ck_ok(vox_grid_find_constraints(r.grid, &desc));
    ck_assert_uint_eq(constraints_of(r.grid).count, 0);
    ck_assert_uint_eq(constraints_of(r.grid).pair_count, pairs_of(r.grid).count);
    free_row(&r);
}
END_TEST

/* ---- when there are some ------------------------------------------------------------------------ */

START_TEST(when_there_are_some) {
    for (uint32_t flags = 0; flags < 2; ++flags) {
        vox_grid_desc settings = engine_desc();
        settings.flags = flags;
        row r = make_row(&settings);
        check_none(r.grid);
        ck_fails(vox_grid_find_constraints(r.grid, NULL), VOX_ERROR_INVALID_STATE, "vox_grid_step first");
        ck_ok(vox_grid_step(r.grid));
        if (!flags) check_none(r.grid);
        if (!flags) ck_ok(vox_grid_find_constraints(r.grid, NULL));
        check_depths(r.grid);
        kept_constraints kept = keep_constraints(r.grid);
        ck_assert_uint_gt(kept.count, 20);

        ck_ok(vox_grid_reserve(r.grid, 50, 100000)); /* the same, elsewhere perhaps */
        same_constraints(r.grid, &kept);
        const vox_constraint_view view = constraints_of(r.grid);
        ck_ok(vox_body_remove(r.grid, r.ids[3])); /* which has no pair */
        check_kept(r.grid, view, kept);
        ck_ok(vox_grid_find_constraints(r.grid, NULL));
        same_constraints(r.grid, &kept);

        ck_ok(vox_grid_step(r.grid)); /* ends them */
        if (!flags) check_none(r.grid);
        if (!flags) ck_ok(vox_grid_find_constraints(r.grid, NULL));
        same_constraints(r.grid, &kept);
        free(kept.data);

        /* A failed step leaves none, nor does clearing. */
        const float x = r.bodies[1].positions[30];
        r.bodies[1].positions[30] = NAN;
        ck_fails(vox_grid_step(r.grid), VOX_ERROR_NON_FINITE, "not finite");
        check_none(r.grid);
        ck_fails(vox_grid_find_constraints(r.grid, NULL), VOX_ERROR_INVALID_STATE, "vox_grid_step first");
        r.bodies[1].positions[30] = x;
        ck_ok(vox_grid_step(r.grid));
        ck_ok(vox_grid_find_constraints(r.grid, NULL));
        check_depths(r.grid);
        ck_ok(vox_grid_clear(r.grid));
        check_none(r.grid);
        ck_fails(vox_grid_find_constraints(r.grid, NULL), VOX_ERROR_INVALID_STATE, "vox_grid_step first");
        ck_ok(vox_grid_step(r.grid));
        ck_ok(vox_grid_find_constraints(r.grid, NULL));
        ck_assert_uint_eq(constraints_of(r.grid).count, 0);
        ck_assert_uint_eq(constraints_of(r.grid).pair_offsets[constraints_of(r.grid).pair_count], 0);
        free_row(&r);
    }
}
END_TEST

/* ---- bodies that are not as they were ----------------------------------------------------------- */

enum { edit_count = 8 };

static void edit(vox_grid* grid, vox_body id, const body* b, int how) {
    const uint32_t tets[2] = {3, 4}, corners[8] = {0, 1, 4, 17, 2, 3, 18, 19};
    const vox_mesh_desc desc = body_desc(b);
    vox_vertices_desc vertices = vox_default_vertices_desc();
    uint32_t first = 0, unused = 0;
    switch (how) {
    case 0:
        ck_ok(vox_body_remove(grid, id));
        break;
    case 1:
        ck_ok(vox_mesh_set_tets_enabled(grid, id, tets, 2, 0));
        break;
    case 2:
        ck_ok(vox_mesh_replace_tets(grid, id, tets, 2, corners));
        break;
    case 3:
        ck_ok(vox_mesh_append_tets(grid, id, corners, 2, &first));
        break;
    case 4:
        ck_ok(vox_mesh_remove_tets(grid, id, tets, 2));
        break;
    case 5:
        ck_ok(vox_mesh_set_topology(grid, id, &desc));
        break;
    case 6:
        vertices.count = 1;
        vertices.positions = vox_float_positions(b->positions, b->vertex_count + 1);
        ck_ok(vox_mesh_append_vertices(grid, id, &vertices, &first));
        break;
    default:
        unused = b->vertex_count;
        ck_ok(vox_mesh_remove_vertices(grid, id, &unused, 1));
    }
}

/* An error for all pairs of the body; other pairs, and the constraints of before, are there. */
START_TEST(removed_and_edited) {
    for (int how = 0; how < 2 * edit_count; ++how) {
        vox_grid_desc settings = engine_desc();
        settings.flags = how % 2;
        row r = make_row(&settings);
        /* Room for a vertex that is appended, and one in no tetrahedron that is removed. */
        body* last = &r.bodies[2];
        last->positions = (float*)realloc(last->positions, 3 * sizeof(float) * (last->vertex_count + 2));
        for (uint32_t i = 0; i < 6; ++i) last->positions[3 * last->vertex_count + i] = 30;
        const vox_positions with_more = vox_float_positions(last->positions, last->vertex_count + 1);
        vox_mesh_desc desc = body_desc(last);
        if (how / 2 == edit_count - 1) desc.positions = with_more;
        ck_ok(vox_mesh_set_topology(r.grid, r.ids[2], &desc));
        ck_ok(vox_grid_step(r.grid));
        ck_ok(vox_grid_find_constraints(r.grid, NULL));
        kept_constraints kept = keep_constraints(r.grid);
        const vox_constraint_view view = constraints_of(r.grid);
        char words[64];
        snprintf(words, sizeof words, "body %u was %s since the step", r.ids[2],
                 how / 2 ? "edited" : "removed");
        edit(r.grid, r.ids[2], last, how / 2);
        ck_fails(vox_grid_find_constraints(r.grid, NULL), VOX_ERROR_INVALID_STATE, words);
        vox_constraint_desc wanted = of_pair(r.ids[1], VOX_NULL_BODY);
        ck_fails(vox_grid_find_constraints(r.grid, &wanted), VOX_ERROR_INVALID_STATE, words);
        wanted = of_pair(r.ids[1], r.ids[2]);
        wanted.method = VOX_DEPTH_METHOD_NONE;
        ck_fails(vox_grid_find_constraints(r.grid, &wanted),
                 how / 2 ? VOX_ERROR_INVALID_STATE : VOX_ERROR_INVALID_HANDLE, how / 2 ? words : "stale");
        check_kept(r.grid, view, kept);
        wanted = of_pair(r.ids[1], r.ids[0]);
        ck_ok(vox_grid_find_constraints(r.grid, &wanted));
        uint64_t n = 0;
        for (uint64_t i = 0; i < kept.count; ++i) {
            if (kept.data[i].body_a == r.ids[2] || kept.data[i].body_b == r.ids[2]) continue;
            ck_assert_mem_eq(&constraints_of(r.grid).data[n++], &kept.data[i], sizeof *kept.data);
        }
        ck_assert_uint_gt(n, 0);
        ck_assert_uint_eq(n, constraints_of(r.grid).count);
        free(kept.data);
        /* The next step knows it as it is. */
        ck_ok(vox_grid_step(r.grid));
        ck_ok(vox_grid_find_constraints(r.grid, NULL));
        check_depths(r.grid);
        ck_ok(vox_grid_find_constraints(r.grid, NULL));
        free_row(&r);
    }
}
END_TEST

/* A body that was removed before the step is no error: its pairs ended. */
START_TEST(pairs_that_ended) {
    row r = plain_row();
    ck_ok(vox_grid_step(r.grid));
    ck_ok(vox_body_remove(r.grid, r.ids[0]));
    ck_ok(vox_grid_step(r.grid));
    ck_assert_uint_eq(count_pairs(r.grid, VOX_PAIR_ENDED), 1);
    ck_ok(vox_grid_find_constraints(r.grid, NULL));
    const vox_constraint_view view = check_depths(r.grid);
    ck_assert_uint_gt(view.count, 5);
    ck_assert_uint_eq(view.pair_offsets[1], 0);
    free_row(&r);
}
END_TEST

/* The same positions in other memory. */
START_TEST(bound_elsewhere) {
    row r = plain_row();
    ck_ok(vox_grid_step(r.grid));
    ck_ok(vox_grid_find_constraints(r.grid, NULL));
    kept_constraints kept = keep_constraints(r.grid);
    for (int b = 0; b < 3; ++b) {
        const size_t bytes = 3 * sizeof(float) * r.bodies[b].vertex_count;
        float* copy = (float*)malloc(bytes);
        memcpy(copy, r.bodies[b].positions, bytes);
        ck_ok(vox_mesh_bind_floats(r.grid, r.ids[b], copy, r.bodies[b].vertex_count));
        memset(r.bodies[b].positions, 0, bytes);
        free(r.bodies[b].positions);
        r.bodies[b].positions = copy;
    }
    vox_constraint_desc desc = vox_default_constraint_desc();
    desc.closest_budget = 1000000; /* found anew */
    ck_ok(vox_grid_find_constraints(r.grid, &desc));
    same_constraints(r.grid, &kept);
    free(kept.data);
    free_row(&r);
}
END_TEST

/* What a filter says counts from the next step on. */
START_TEST(filters_that_change) {
    row r = plain_row();
    vox_filter filter = plain_filter();
    uint64_t counts[2];
    for (int sensor = 0; sensor < 2; ++sensor) {
        filter.flags = sensor ? VOX_FILTER_SENSOR : 0;
        ck_ok(vox_body_set_filter(r.grid, r.ids[2], &filter));
        for (int step = 0; step < 3; ++step) { /* at rest, too, and where only others are */
            if (step == 2) move_body(&r.bodies[0], 0.03125, 0, 0);
            ck_ok(vox_grid_step(r.grid));
            if (step == 1) ck_ok(vox_grid_find_constraints(r.grid, NULL));
        }
        filter.flags = VOX_FILTER_SENSOR - filter.flags;
        filter.category = 4;
        ck_ok(vox_body_set_filter(r.grid, r.ids[2], &filter));
        ck_ok(vox_grid_find_constraints(r.grid, NULL));
        counts[sensor] = constraints_of(r.grid).count;
        vox_constraint_desc desc = vox_default_constraint_desc();
        desc.closest_budget = 1000000;
        ck_ok(vox_grid_find_constraints(r.grid, &desc));
        ck_assert_uint_eq(constraints_of(r.grid).count, counts[sensor]);
        filter.category = 0;
        desc.mask = 4;
        ck_ok(vox_grid_find_constraints(r.grid, &desc));
        ck_assert_uint_eq(constraints_of(r.grid).count, 0);
    }
    ck_assert_uint_gt(counts[0], counts[1]);
    ck_assert_uint_gt(counts[1], 5);
    free_row(&r);
}
END_TEST

START_TEST(positions_that_are_none_any_more) {
    row r = plain_row();
    ck_ok(vox_grid_step(r.grid));
    ck_ok(vox_grid_find_constraints(r.grid, NULL));
    kept_constraints kept = keep_constraints(r.grid);
    const vox_constraint_view view = constraints_of(r.grid);
    float* x = &r.bodies[2].positions[7];
    const float was = *x;
    const float bad[] = {NAN, INFINITY};
    for (int i = 0; i < 2; ++i) {
        *x = bad[i];
        ck_fails(vox_grid_find_constraints(r.grid, NULL), VOX_ERROR_NON_FINITE, "vertex 2");
        check_kept(r.grid, view, kept);
    }
    const vox_constraint_desc others = of_pair(r.ids[0], VOX_NULL_BODY);
    ck_ok(vox_grid_find_constraints(r.grid, &others)); /* its positions are not read */
    *x = was;
    ck_ok(vox_grid_find_constraints(r.grid, NULL));
    same_constraints(r.grid, &kept);
    free(kept.data);

    /* Nor are those of a body that the step left out. */
    ck_ok(vox_grid_set_flags(r.grid, VOX_GRID_SKIP_BAD_BODIES));
    *x = NAN;
    ck_ok(vox_grid_step(r.grid));
    ck_assert_uint_eq(count_pairs(r.grid, VOX_PAIR_ENDED), 1);
    ck_ok(vox_grid_find_constraints(r.grid, NULL));
    ck_assert_uint_gt(constraints_of(r.grid).count, 5);
    *x = was;
    free_row(&r);
}
END_TEST

/* ---- memory ------------------------------------------------------------------------------------- */

/* Bodies that have constraints of all kinds, and move to and fro. */
static world swinging_world(void) {
    world w;
    memset(&w, 0, sizeof w);
    w.count = 4;
    for (int b = 0; b < 4; ++b) {
        model* m = &w.models[b];
        m->shape =
            make_box(b == 2 ? 1 : 3, b == 2 ? 0.2f : 0.5f, 1.1f * (float)b, 0.1f * (float)b, 0.2f * (float)b);
        m->before = (float*)calloc(3 * m->shape.vertex_count, sizeof(float));
    }
    move_body(&w.models[2].shape, 0, 0, 2);
    move_body(&w.models[3].shape, -0.61, 0, 0);
    return w;
}

static void swing(world* w, int step) {
    for (int b = 0; b < w->count; ++b) {
        body* s = &w->models[b].shape;
        memcpy(w->models[b].before, s->positions, 3 * sizeof(float) * s->vertex_count);
        const double by = step % 2 ? -1 : 1;
        move_body(s, 0, 0.125 * by * (b % 2), b == 2 ? -4 * by : 0); /* that one goes through the others */
    }
}

static vox_grid_desc memory_desc(ledger* l, uint32_t flags, uint32_t workers) {
    vox_grid_desc desc = engine_desc();
    desc.allocator = ledger_allocator(l);
    desc.flags = flags;
    desc.worker_count = workers;
    desc.margin = 0.25;
    return desc;
}

START_TEST(steady_state) {
    for (uint32_t variant = 0; variant < 8; ++variant) {
        const uint32_t flag = variant % 2, workers = 1 + variant / 2 % 2 * 3;
        ledger l = {0};
        const vox_grid_desc desc = memory_desc(&l, VOX_GRID_EDGES | flag, workers);
        vox_constraint_desc wanted = vox_default_constraint_desc();
        wanted.method = variant < 4 ? VOX_DEPTH_METHOD_CONSISTENT : VOX_DEPTH_METHOD_CLOSEST;
        world w = swinging_world();
        w.grid = grid_of(&desc);
        insert_models(w.grid, &w);
        uint64_t calls = 0, by_kind[4] = {0};
        for (int step = 0; step < 16; ++step) {
            swing(&w, step);
            ck_ok(vox_grid_step(w.grid));
            wanted.body_a = VOX_NULL_BODY;
            if (variant > 1) ck_ok(vox_grid_find_constraints(w.grid, &wanted)); /* with the flag besides */
            if (!flag) ck_ok(vox_grid_find_constraints(w.grid, NULL));
            wanted.body_a = w.models[1].id;
            if (variant > 5) ck_ok(vox_grid_find_constraints(w.grid, &wanted));
            for (int kind = 0; kind < 4; ++kind)
                by_kind[kind] += count_constraints(w.grid, (vox_constraint_kind)kind);
            if (step == 6) calls = l.calls;
            if (step > 6) ck_assert_uint_eq(l.calls, calls);
            ck_assert_uint_eq(grid_info(w.grid).bytes, l.bytes);
        }
        for (int kind = 0; kind < 4; ++kind) ck_assert_uint_gt(by_kind[kind], 10);
        end_world(&w);
        ck_assert_uint_eq(l.bytes, 0);
    }
}
END_TEST

/* Without memory for all of it, the constraints of before stay. */
START_TEST(all_or_nothing) {
    uint64_t failures = 0;
    for (int done = 0; !done;) {
        ledger l = {0};
        const vox_grid_desc desc = memory_desc(&l, VOX_GRID_EDGES, 3);
        world w = swinging_world();
        w.grid = grid_of(&desc);
        insert_models(w.grid, &w);
        swing(&w, 0);
        ck_ok(vox_grid_step(w.grid));
        vox_constraint_desc first = of_pair(w.models[0].id, w.models[1].id);
        first.method = VOX_DEPTH_METHOD_NONE;
        ck_ok(vox_grid_find_constraints(w.grid, &first));
        kept_constraints kept = keep_constraints(w.grid);
        ck_assert_uint_gt(kept.count, 5);
        l.calls = 0;
        l.fail_at = failures + 1;
        vox_constraint_desc all = vox_default_constraint_desc();
        all.method = VOX_DEPTH_METHOD_CLOSEST;
        const vox_result result = vox_grid_find_constraints(w.grid, &all);
        done = result == VOX_OK;
        l.fail_at = 0;
        if (!done) {
            ++failures;
            ck_assert_int_eq(result, VOX_ERROR_OUT_OF_MEMORY);
            same_constraints(w.grid, &kept);
        }
        ck_ok(vox_grid_find_constraints(w.grid, NULL));
        check_depths(w.grid);
        free(kept.data);
        end_world(&w);
        ck_assert_uint_eq(l.bytes, 0);
    }
    ck_assert_uint_gt(failures, 10);
}
END_TEST

/* Exactly as many bytes as were ever held are enough; one less is an error. */
START_TEST(byte_budget) {
    vox_grid_desc desc = engine_desc();
    uint64_t peak = 0;
    for (int less = -1; less < 2; ++less) {
        if (less >= 0) desc.byte_budget = peak - (uint64_t)less;
        world w = two_in_each_other(8, &desc);
        ck_ok(vox_grid_step(w.grid));
        const uint64_t without = grid_info(w.grid).peak_bytes;
        if (less == 1)
            ck_fails(vox_grid_find_constraints(w.grid, NULL), VOX_ERROR_BUDGET, "byte");
        else
            ck_ok(vox_grid_find_constraints(w.grid, NULL));
        peak = less < 0 ? grid_info(w.grid).peak_bytes : peak;
        ck_assert_uint_gt(peak, without);
        ck_assert_uint_gt(contacts_of(w.grid).count, 0);
        end_world(&w);
    }
}
END_TEST

/* ---- tasks -------------------------------------------------------------------------------------- */

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
    vox_grid_desc desc = engine_desc();
    desc.worker_count = 2;
    const vox_task_system tasks = {run_in_two, finish_nothing, NULL};
    desc.tasks = &tasks;
    world w = two_in_each_other(12, &desc);
    loses_items = 0;
    ck_ok(vox_grid_step(w.grid));
    enqueued = 0;
    ck_ok(vox_grid_find_constraints(w.grid, NULL));
    ck_assert_uint_ge(enqueued, 1);
    ck_assert_uint_lt(enqueued, VOX_MAX_TASKS);
    kept_constraints kept = keep_constraints(w.grid);
    ck_assert_uint_gt(kept.count, 1024);
    loses_items = 1;
    const vox_constraint_desc closest = {sizeof closest, VOX_DEPTH_METHOD_CLOSEST, 0, 0, 0, 0};
    ck_fails(vox_grid_find_constraints(w.grid, &closest), VOX_ERROR_INVALID_ARGUMENT, "items");
    loses_items = 0;
    ck_ok(vox_grid_find_constraints(w.grid, NULL));
    same_constraints(w.grid, &kept);
    free(kept.data);
    end_world(&w);
}
END_TEST

/* ---- prepared in advance ------------------------------------------------------------------------ */

/* Two boxes that stand apart, then meet at a corner. */
typedef struct corner_scene {
    ledger memory;
    body bodies[2];
    vox_body ids[2];
    vox_grid* grid;
} corner_scene;

static void begin_corner(corner_scene* s, uint32_t workers) {
    const ledger none = {0};
    s->memory = none;
    vox_grid_desc desc = depth_desc();
    desc.flags |= VOX_GRID_EDGES;
    desc.margin = 0.05;
    desc.worker_count = workers;
    desc.allocator = ledger_allocator(&s->memory);
    s->grid = grid_of(&desc);
    for (int b = 0; b < 2; ++b) {
        s->bodies[b] = make_box(16, 1, 30.0f * (float)b, 0, 0);
        const vox_mesh_desc mesh = body_desc(&s->bodies[b]);
        s->ids[b] = insert_mesh(s->grid, &mesh);
    }
    ck_ok(vox_grid_step(s->grid));
}

static void find_closest(const corner_scene* s) {
    vox_constraint_desc desc = vox_default_constraint_desc();
    desc.method = VOX_DEPTH_METHOD_CLOSEST;
    ck_ok(vox_grid_step(s->grid));
    ck_ok(vox_grid_find_constraints(s->grid, &desc));
}

static void end_corner(corner_scene* s) {
    vox_grid_destroy(s->grid);
    ck_assert_uint_eq(s->memory.bytes, 0);
    for (int b = 0; b < 2; ++b) free_body(&s->bodies[b]);
}

START_TEST(prepared) {
    ck_fails(vox_grid_prepare(NULL), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    for (uint32_t workers = 1; workers <= 3; workers += 2) {
        corner_scene lazy, made;
        uint64_t first[2], calls;
        begin_corner(&lazy, workers);
        begin_corner(&made, workers);
        const uint64_t before = made.memory.bytes;
        const vox_contact_view results = contacts_of(made.grid);
        ck_ok(vox_grid_prepare(made.grid));
        ck_assert_ptr_eq(contacts_of(made.grid).data, results.data);
        const uint64_t of_surfaces = made.memory.bytes - before;
        ck_assert_uint_gt(of_surfaces, 2 * 6 * 2 * 16 * 16 * 30); /* 30 bytes and more a triangle */
        calls = made.memory.calls;
        ck_ok(vox_grid_prepare(made.grid)); /* what is there is not made again */
        ck_assert_uint_eq(made.memory.calls, calls);
        corner_scene* const both[2] = {&lazy, &made};
        for (int i = 0; i < 2; ++i) {
            const uint64_t taken = both[i]->memory.taken;
            move_body(&both[i]->bodies[1], 30 - 14.7, 15.3, 15.2);
            move_body(&both[i]->bodies[1], -2 * (30 - 14.7), 0, 0);
            find_closest(both[i]);
            first[i] = both[i]->memory.taken - taken;
        }
        kept_constraints expected = keep_constraints(lazy.grid);
        ck_assert_uint_gt(expected.count, 10);
        same_constraints(made.grid, &expected);
        /* The first contact takes what its lists take, and nothing for surfaces. */
        ck_assert_uint_le(first[1] + of_surfaces, first[0]);
        for (int again = 0; again < 2; ++again) { /* both lists of constraints */
            ck_ok(vox_body_mark_moved(made.grid, made.ids[1]));
            calls = made.memory.calls;
            find_closest(&made);
        }
        ck_assert_uint_eq(made.memory.calls, calls);
        same_constraints(made.grid, &expected);

        const float was = made.bodies[0].positions[0];
        made.bodies[0].positions[0] = NAN;
        ck_fails(vox_grid_prepare(made.grid), VOX_ERROR_NON_FINITE, "not finite");
        made.bodies[0].positions[0] = was;
        vox_mesh_desc unbound = body_desc(&made.bodies[0]);
        unbound.positions.data = NULL;
        (void)insert_mesh(made.grid, &unbound);
        ck_ok(vox_grid_prepare(made.grid));
        free(expected.data);
        end_corner(&lazy);
        end_corner(&made);
    }
}
END_TEST

/* Each allocation of it fails: what it made stays, and it may be called again. */
START_TEST(preparing_fails) {
    for (uint64_t n = 1;; ++n) {
        corner_scene s;
        begin_corner(&s, 1);
        const uint64_t calls = s.memory.calls;
        s.memory.fail_at = calls + n;
        const vox_result result = vox_grid_prepare(s.grid);
        if (result != VOX_OK) ck_assert_int_eq(result, VOX_ERROR_OUT_OF_MEMORY);
        s.memory.fail_at = 0;
        ck_ok(vox_grid_prepare(s.grid));
        ck_ok(vox_grid_step(s.grid));
        end_corner(&s);
        if (result == VOX_OK) break;
    }
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, prepared, preparing_fails, arguments, when_there_are_some, removed_and_edited,
                   pairs_that_ended, bound_elsewhere, filters_that_change, positions_that_are_none_any_more,
                   steady_state, all_or_nothing, byte_budget, task_systems);
}

SUITE(constraints_life) { add_for_each_engine(suite, add_tests); }
