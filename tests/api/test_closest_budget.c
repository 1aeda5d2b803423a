/* closest_budget: which vertices get a closest point, and what becomes of the others. */
#include <stdio.h>

#include "scenes/random.h"
#include "support/depth_checks.h"
#include "support/ledger.h"

/* A ball inside a box, and a body tangled with itself. */
typedef struct scene {
    body outer, inner, tangled;
} scene;

static scene make_scene(void) {
    scene s = {make_box(5, 0.25f, 0, 0, 0), make_lattice_ball(&five_cut_exchanged, 4, 3.3),
               make_box(5, 0.25f, 3, 0, 0)};
    for (uint32_t i = 0; i < 3 * s.inner.vertex_count; ++i)
        s.inner.positions[i] = 0.12f * s.inner.positions[i] + 0.61f;
    uint64_t random = 3;
    for (uint32_t i = 0; i < 3 * s.tangled.vertex_count; ++i)
        s.tangled.positions[i] += random_float(&random, -0.2f, 0.2f);
    return s;
}

static void free_scene(scene* s) {
    free_body(&s->outer);
    free_body(&s->inner);
    free_body(&s->tangled);
}

static void insert_scene(vox_grid* grid, const scene* s) {
    vox_mesh_desc tangled = body_desc(&s->tangled), inner = body_desc(&s->inner),
                  outer = body_desc(&s->outer);
    tangled.filter.flags = VOX_FILTER_SELF_COLLISION;
    insert_mesh(grid, &inner);
    insert_mesh(grid, &tangled);
    insert_mesh(grid, &outer);
}

typedef struct messages {
    int count;
    char last[256];
} messages;

static void write_message(vox_log_level level, const char* text, void* user) {
    messages* to = (messages*)user;
    if (level != VOX_LOG_WARNING) return;
    ++to->count;
    snprintf(to->last, sizeof to->last, "%s", text);
}

static void find(vox_grid* grid, vox_depth_method method, uint64_t budget) {
    vox_constraint_desc desc = vox_default_constraint_desc();
    ck_assert_uint_eq(desc.closest_budget, 0);
    desc.method = method;
    desc.closest_budget = budget;
    ck_ok(vox_grid_find_constraints(grid, &desc));
}

/* In the order in which they get searches: that of the contacts. */
static int is_before(const vox_constraint* x, const vox_constraint* y) {
    if (x->body_a != y->body_a) return x->body_a < y->body_a;
    return x->vertices[0] != y->vertices[0] ? x->vertices[0] < y->vertices[0] : x->body_b < y->body_b;
}

/* Which constraints take a search. With consistent depth these are the first one, and all that are UNKNOWN
 * with a budget of 1. */
static uint8_t* searched_ones(vox_grid* grid, vox_depth_method method) {
    find(grid, method, 1);
    const vox_constraint_view view = constraints_of(grid);
    uint8_t* searched = (uint8_t*)calloc(view.count, 1);
    ck_assert_int_eq(view.data[0].state, VOX_DEPTH_CLOSEST); /* of the ball in the box */
    for (uint64_t i = 0; i < view.count; ++i)
        searched[i] = method == VOX_DEPTH_METHOD_CLOSEST || i == 0 || view.data[i].state == VOX_DEPTH_UNKNOWN;
    return searched;
}

static void check_budgets(const scene* s, vox_depth_method method, uint32_t workers) {
    messages log = {0, ""};
    const vox_log log_lines = {write_message, &log};
    vox_grid_desc desc = engine_desc();
    desc.log = &log_lines;
    desc.worker_count = workers;
    vox_grid* grid = grid_of(&desc);
    insert_scene(grid, s);
    const uint64_t hash = hash_of_step(grid);
    find(grid, method, 0);
    check_depths(grid);
    kept_constraints all = keep_constraints(grid);
    const uint64_t searches = counters_of(grid).closest_searches;
    ck_assert_uint_gt(searches, 100);
    ck_assert_uint_eq(counters_of(grid).unknown_penetrations, 0);
    ck_assert_int_eq(log.count, 0);
    uint8_t* is_searched = searched_ones(grid, method);
    uint64_t sum = 0;
    for (uint64_t i = 0; i < all.count; ++i) sum += is_searched[i];
    ck_assert_uint_eq(sum, searches);

    const uint64_t budgets[] = {1, 2, searches / 2, searches - 1, searches, searches + 1, UINT64_MAX};
    for (int k = 0; k < 7; ++k) {
        log.count = 0;
        find(grid, method, budgets[k]);
        const vox_constraint_view view = check_depths(grid);
        ck_assert_uint_eq(view.count, all.count);
        uint64_t unknown = 0;
        const vox_constraint *last_known = NULL, *first_unknown = NULL;
        for (uint64_t i = 0; i < all.count; ++i) {
            const vox_constraint *expected = &all.data[i], *found = &view.data[i];
            if (found->state != VOX_DEPTH_UNKNOWN) {
                ck_assert_mem_eq(found, expected, sizeof *found);
                if (is_searched[i] && (!last_known || is_before(last_known, found))) last_known = found;
                continue;
            }
            ck_assert(is_searched[i]);
            ++unknown;
            if (!first_unknown || is_before(found, first_unknown)) first_unknown = found;
            ck_assert(found->gap == 0);
            ck_assert_double_eq_tol(norm(normal_of(found)), 1, 1e-14);
            ck_assert_uint_eq(found->count, 5);
            ck_assert_uint_eq(found->element_b, expected->element_b);
        }
        ck_assert_uint_eq(unknown, budgets[k] < searches ? searches - budgets[k] : 0);
        if (unknown > 0) ck_assert(is_before(last_known, first_unknown));
        const grid_counts counters = counters_of(grid);
        ck_assert_uint_eq(counters.unknown_penetrations, unknown);
        ck_assert_uint_eq(counters.closest_searches, searches - unknown);
        ck_assert_int_eq(log.count, unknown > 0);
        if (unknown > 0) ck_assert_ptr_nonnull(strstr(log.last, "closest_budget"));
        uint64_t other = 0;
        ck_ok(vox_grid_get_hash(grid, &other));
        ck_assert_uint_eq(other, hash);
    }
    vox_grid_destroy(grid);
    free(all.data);
    free(is_searched);
}

START_TEST(the_first_ones_in_order) {
    scene s = make_scene();
    for (uint32_t workers = 1; workers <= 4; workers += 3) {
        check_budgets(&s, VOX_DEPTH_METHOD_CONSISTENT, workers);
        check_budgets(&s, VOX_DEPTH_METHOD_CLOSEST, workers);
    }
    free_scene(&s);
}
END_TEST

/* The normal of an unknown one is that of a facet of its tetrahedron, outwards. */
START_TEST(normals_of_facets) {
    scene s = make_scene();
    vox_grid* grid = engine_grid();
    const vox_mesh_desc first = body_desc(&s.inner), second = body_desc(&s.outer);
    insert_mesh(grid, &first);
    insert_mesh(grid, &second);
    ck_ok(vox_grid_step(grid));
    find(grid, VOX_DEPTH_METHOD_CONSISTENT, 1);
    const vox_constraint_view view = constraints_of(grid);
    uint64_t unknown = 0;
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_constraint* c = &view.data[i];
        if (c->state != VOX_DEPTH_UNKNOWN) continue;
        ++unknown;
        int is_normal = 0;
        for (int apex = 0; apex < 4; ++apex) {
            vector x[4];
            for (int k = 0; k < 4; ++k) x[k] = place(s.outer.positions, c->vertices[1 + (apex + k) % 4]);
            vector n = outer(minus(x[2], x[1]), minus(x[3], x[1]));
            if (inner(n, minus(x[0], x[1])) > 0) n = minus((vector){0, 0, 0}, n);
            is_normal |= degrees_between(n, normal_of(c)) < 0.01;
        }
        ck_assert(is_normal);
    }
    ck_assert_uint_gt(unknown, 50);
    vox_grid_destroy(grid);
    free_scene(&s);
}
END_TEST

/* Trees are kept, counted, and take nothing more while bodies move; removing a mesh gives its tree back. */
START_TEST(memory_is_steady) {
    scene s = make_scene();
    for (uint32_t workers = 1; workers <= 4; workers += 3) {
        ledger l = {0};
        vox_grid_desc desc = depth_desc();
        desc.allocator = ledger_allocator(&l);
        desc.worker_count = workers;
        vox_grid* grid = grid_of(&desc);
        insert_scene(grid, &s);
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_gt(counters_of(grid).closest_searches, 100);
        for (int step = 0; step < 2; ++step) {
            for (uint32_t i = 0; i < 3 * s.inner.vertex_count; ++i)
                s.inner.positions[i] += step % 2 ? -0.001f : 0.001f;
            ck_ok(vox_grid_step(grid));
        }
        const uint64_t calls = l.calls;
        for (int step = 0; step < 6; ++step) {
            for (uint32_t i = 0; i < 3 * s.inner.vertex_count; ++i)
                s.inner.positions[i] += step % 2 ? -0.001f : 0.001f;
            ck_ok(vox_grid_step(grid));
            ck_assert_uint_eq(counters_of(grid).bytes, l.bytes);
        }
        ck_assert_uint_eq(l.calls, calls);
        uint64_t rest = 0;
        for (int round = 0; round < 3; ++round) { /* the second step has pairs that ended besides its own */
            ck_ok(vox_grid_clear(grid));
            if (round == 2) ck_assert_uint_eq(l.bytes, rest);
            rest = l.bytes;
            insert_scene(grid, &s);
            ck_ok(vox_grid_step(grid));
        }
        vox_grid_destroy(grid);
        ck_assert_uint_eq(l.bytes, 0);
    }
    free_scene(&s);
}
END_TEST

/* What a step finds does not depend on the steps before, nor on meshes that came and went. */
START_TEST(steps_before_do_not_matter) {
    scene s = make_scene();
    vox_grid *fresh = depth_grid(), *old = depth_grid();
    insert_scene(fresh, &s);
    insert_scene(old, &s);
    uint64_t random = 5;
    float* rest = (float*)malloc(3 * sizeof(float) * s.tangled.vertex_count);
    memcpy(rest, s.tangled.positions, 3 * sizeof(float) * s.tangled.vertex_count);
    for (int step = 0; step < 4; ++step) {
        for (uint32_t i = 0; i < 3 * s.tangled.vertex_count; ++i)
            s.tangled.positions[i] = rest[i] * (step == 2 ? 50 : 1) + random_float(&random, -0.3f, 0.3f);
        ck_ok(vox_grid_step(old));
    }
    memcpy(s.tangled.positions, rest, 3 * sizeof(float) * s.tangled.vertex_count);
    ck_ok(vox_grid_step(old));
    ck_ok(vox_grid_step(fresh));
    kept_constraints expected = keep_constraints(fresh);
    same_constraints(old, &expected);
    free(expected.data);
    vox_grid_destroy(fresh);
    vox_grid_destroy(old);
    free(rest);
    free_scene(&s);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, the_first_ones_in_order, normals_of_facets, memory_is_steady,
                   steps_before_do_not_matter);
}

SUITE(closest_budget) { add_for_each_engine(suite, add_tests); }
