/* Vertices within the margin: each against vox_locator_find_closest, vertex by vertex and mesh by mesh, which
 * tests/api/test_queries_of_surfaces.c compares with all facets; their life, memory and errors. */
#include <math.h>
#include <string.h>

#include "scenes/bodies.h"
#include "support/constraint_checks.h"
#include "support/ledger.h"
#include "support/locators.h"
#include "support/turns.h"

enum { most_meshes = 8 };

/* Meshes with a category each, by which queries tell them apart. */
typedef struct margin_scene {
    body bodies[most_meshes];
    vox_body ids[most_meshes];
    vox_filter filters[most_meshes];
    uint32_t count;
} margin_scene;

static uint64_t count_near(const vox_grid* grid) { return count_constraints(grid, VOX_CONSTRAINT_PROXIMITY); }

static vox_grid_desc margin_desc(double margin) {
    vox_grid_desc desc = engine_desc();
    desc.flags = VOX_GRID_CONSTRAINTS;
    desc.margin = margin;
    return desc;
}

static vox_grid* margin_grid(double margin) {
    const vox_grid_desc desc = margin_desc(margin);
    return grid_of(&desc);
}

static void insert_body(margin_scene* s, vox_grid* grid, body b) {
    const uint32_t i = s->count++;
    vox_mesh_desc desc;
    s->bodies[i] = b;
    desc = body_desc(&b);
    s->filters[i] = plain_filter();
    s->filters[i].category = (uint64_t)1 << i;
    s->filters[i].mask = UINT64_MAX;
    desc.filter = s->filters[i];
    s->ids[i] = insert_mesh(grid, &desc);
}

static void free_margin_scene(margin_scene* s) {
    for (uint32_t i = 0; i < s->count; ++i) free_body(&s->bodies[i]);
}

/* Boxes of several sizes at random places, some of which meet. */
static void make_random_scene(margin_scene* s, vox_grid* grid, uint64_t seed) {
    uint64_t state = seed;
    memset(s, 0, sizeof *s);
    for (uint32_t i = 0; i < 6; ++i) {
        const double x = random_unit(&state), y = random_unit(&state), z = random_unit(&state);
        const uint32_t n = 1 + i % 4;
        body b = make_box(n, 0.5f + 0.25f * (float)(i % 3), 4 * (float)x, 4 * (float)y, 4 * (float)z);
        jitter_body(&b, 0.1, seed + i);
        insert_body(s, grid, b);
    }
}

static int collide_in(const margin_scene* s, uint32_t a, uint32_t b) {
    const vox_filter *x = &s->filters[a], *y = &s->filters[b];
    if (x->group != 0 && x->group == y->group) return x->group > 0;
    return (x->category & y->mask) != 0 && (y->category & x->mask) != 0;
}

static int has_contact(const vox_grid* grid, vox_body a, uint32_t vertex, vox_body b) {
    const vox_contact_view contacts = contacts_of(grid);
    for (uint64_t i = 0; i < contacts.count; ++i)
        if (contacts.data[i].body_a == a && contacts.data[i].vertex == vertex && contacts.data[i].body_b == b)
            return 1;
    return 0;
}

/* The constraint after *next of a vertex near a mesh, as a query finds it; none where it has a contact or is
 * too far. */
static void check_vertex(const margin_scene* s, const vox_grid* grid, const vox_locator* locator,
                         double margin, const uint32_t of[2], uint32_t vertex, uint64_t* next) {
    const vox_constraint_view view = constraints_of(grid);
    const float* p = s->bodies[of[0]].positions + 3 * (size_t)vertex;
    const vox_positions at = vox_float_positions(p, 1);
    vox_query_desc desc = query_of((uint64_t)1 << of[1], VOX_NULL_BODY);
    vox_closest_hit hit;
    desc.max_distance = margin;
    ck_ok(vox_locator_find_closest(locator, &at, &desc, &hit));
    if (hit.body == VOX_NULL_BODY || has_contact(grid, s->ids[of[0]], vertex, s->ids[of[1]])) return;
    while (*next < view.count && view.data[*next].kind != VOX_CONSTRAINT_PROXIMITY) ++*next;
    ck_assert_uint_lt(*next, view.count);
    const vox_constraint* found = &view.data[(*next)++];
    ck_assert_uint_eq(found->body_a, s->ids[of[0]]);
    ck_assert_uint_eq(found->vertices[0], vertex);
    ck_assert_uint_eq(found->body_b, s->ids[of[1]]);
    ck_assert_uint_eq(found->element_b, hit.tet);
    ck_assert_double_eq(found->gap, hit.distance);
    ck_assert_int_eq(found->state, hit.distance > 0 ? VOX_DEPTH_CLOSEST : VOX_DEPTH_TOUCHING);
    for (int c = 0; c < 3; ++c) {
        ck_assert_uint_eq(found->vertices[1 + c], hit.face[c]);
        ck_assert_double_eq(found->weights[1 + c], -hit.weights[c]);
        ck_assert_double_eq(found->position[c], (double)p[c]);
        ck_assert(fabs(hit.position[c] + found->gap * found->normal[c] - p[c]) < 1e-6);
    }
}

/* Compares all of the last step with queries; returns how many there are. */
static uint64_t check_margin(const margin_scene* s, vox_grid* grid, double margin) {
    uint64_t next = 0;
    const vox_constraint_view view = checked_constraints(grid);
    const vox_pair_view pairs = pairs_of(grid);
    vox_locator* locator = take_locator(grid);
    for (uint32_t a = 0; a < s->count; ++a) /* pair by pair */
        for (uint32_t b = a + 1; b < s->count; ++b)
            for (int swapped = 0; swapped < 2 && collide_in(s, a, b); ++swapped) {
                const uint32_t of[2] = {swapped ? b : a, swapped ? a : b};
                for (uint32_t v = 0; v < s->bodies[of[0]].vertex_count; ++v)
                    check_vertex(s, grid, locator, margin, of, v, &next);
            }
    vox_locator_release(locator);
    for (; next < view.count; ++next) ck_assert_int_eq(view.data[next].kind, VOX_CONSTRAINT_INSIDE);
    ck_assert_uint_eq(counters_of(grid).proximities, count_near(grid));
    for (uint64_t p = 0; p < pairs.count; ++p) { /* those without contacts are near */
        const int is_near =
            pairs.data[p].contact_count == 0 && view.pair_offsets[p] < view.pair_offsets[p + 1];
        ck_assert(pairs.data[p].state == VOX_PAIR_ENDED || (pairs.data[p].state == VOX_PAIR_NEAR) == is_near);
    }
    return count_near(grid);
}

START_TEST(as_queries_find_them) {
    uint64_t found = 0;
    for (uint64_t seed = 1; seed <= 12; ++seed) {
        static const double margins[] = {0.05, 0.3, 2};
        for (int m = 0; m < 3; ++m) {
            margin_scene s;
            vox_grid* grid = margin_grid(margins[m]);
            make_random_scene(&s, grid, seed);
            for (uint32_t i = 0; i < s.count && m == 1; ++i) /* far from zero, too */
                move_body(&s.bodies[i], 1000, -2000, 3000);
            ck_ok(vox_grid_step(grid));
            found += check_margin(&s, grid, margins[m]);
            vox_grid_destroy(grid);
            free_margin_scene(&s);
        }
    }
    ck_assert_uint_gt(found, 1000);
}
END_TEST

/* Two boxes face to face: which vertices, how far, and which way. */
START_TEST(boxes_face_to_face) {
    margin_scene s = {0};
    vox_grid* grid = margin_grid(0.25);
    insert_body(&s, grid, make_box(2, 1, 0, 0, 0));
    insert_body(&s, grid, make_box(2, 1, 0.5f, 0.5f, 2.25f));
    ck_ok(vox_grid_step(grid));
    const vox_constraint_view view = checked_constraints(grid);
    ck_assert_uint_eq(view.count, 8); /* four of each, at most as far as the margin */
    for (uint64_t i = 0; i < view.count; ++i) {
        ck_assert_int_eq(view.data[i].kind, VOX_CONSTRAINT_PROXIMITY);
        ck_assert_double_eq(view.data[i].gap, 0.25);
        ck_assert_double_eq(view.data[i].normal[2], view.data[i].body_a == s.ids[1] ? 1 : -1);
    }
    ck_assert_uint_eq(contacts_of(grid).count, 0);
    ck_assert_uint_eq(pairs_of(grid).count, 1);
    ck_assert_int_eq(pairs_of(grid).data[0].state, VOX_PAIR_NEAR);
    ck_ok(vox_grid_set_margin(grid, nextafter(0.25, 0)));
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(constraints_of(grid).count, 0);
    ck_assert_uint_eq(pairs_of(grid).count, 0); /* it did not touch, so it does not end */
    vox_grid_destroy(grid);
    free_margin_scene(&s);
}
END_TEST

/* Small bodies that are near each other and do not touch. */
START_TEST(many_small_bodies) {
    enum { small = 200 };
    static const uint32_t tet[4] = {0, 1, 2, 3};
    static float positions[small][12];
    vox_grid* grid = margin_grid(0.25);
    for (int i = 0; i < small; ++i) {
        static const float corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
        vox_mesh_desc desc = vox_default_mesh_desc();
        memcpy(positions[i], corners, sizeof corners);
        for (int v = 0; v < 4; ++v) positions[i][3 * v] += 1.125f * (float)i;
        desc.positions.data = positions[i];
        desc.positions.count = 4;
        desc.tets = tet;
        desc.tet_count = 1;
        insert_mesh(grid, &desc);
    }
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(contacts_of(grid).count, 0);
    /* The tip of each is 0.125 from a corner of the next one, and no other two vertices are as close. */
    ck_assert_uint_eq(checked_constraints(grid).count, 2 * (small - 1));
    ck_assert_uint_eq(count_pairs(grid, VOX_PAIR_NEAR), small - 1);
    vox_grid_destroy(grid);
}
END_TEST

START_TEST(filters_and_pairs) {
    for (uint64_t seed = 20; seed < 24; ++seed) {
        margin_scene s;
        vox_grid* grid = margin_grid(0.5);
        make_random_scene(&s, grid, seed);
        ck_ok(vox_grid_step(grid));
        const uint64_t all = check_margin(&s, grid, 0.5);
        s.filters[1].mask = 0x2a;
        s.filters[2].group = s.filters[3].group = -1;
        for (uint32_t i = 1; i < 4; ++i) ck_ok(vox_body_set_filter(grid, s.ids[i], &s.filters[i]));
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_le(check_margin(&s, grid, 0.5), all);
        for (uint32_t i = 0; i < s.count; ++i)
            for (uint32_t j = i + 1; j < s.count; ++j)
                ck_ok(vox_grid_set_pair_enabled(grid, s.ids[i], s.ids[j], 0));
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_eq(constraints_of(grid).count, 0);
        vox_grid_destroy(grid);
        free_margin_scene(&s);
    }
}
END_TEST

/* Bodies at rest keep theirs; those that move, are edited, disabled or removed do not. */
START_TEST(at_rest_and_edited) {
    margin_scene s;
    vox_grid* grid = margin_grid(0.5);
    make_random_scene(&s, grid, 31);
    ck_ok(vox_grid_step(grid));
    const uint64_t all = check_margin(&s, grid, 0.5);
    ck_assert_uint_gt(all, 0);
    for (int step = 0; step < 3; ++step) {
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_eq(check_margin(&s, grid, 0.5), all);
    }
    if (suite_engine == ENGINE_FAST) ck_assert_uint_eq(counters_of(grid).carried_proximities, all);
    for (uint32_t i = 0; i < s.count; ++i) {
        move_body(&s.bodies[i], 0.1, 0.05, -0.1);
        ck_ok(vox_grid_step(grid));
        (void)check_margin(&s, grid, 0.5);
    }
    /* The surface has a hole where a tetrahedron is off. */
    for (uint32_t i = 0; i < s.count; ++i) {
        const uint32_t tet = s.bodies[i].tet_count / 2;
        ck_ok(vox_mesh_set_tets_enabled(grid, s.ids[i], &tet, 1, 0));
        ck_ok(vox_grid_step(grid));
        (void)check_margin(&s, grid, 0.5);
    }
    const uint64_t before = count_near(grid);
    ck_ok(vox_body_set_enabled(grid, s.ids[0], 0));
    ck_ok(vox_grid_step(grid));
    (void)checked_constraints(grid);
    ck_assert_uint_lt(count_near(grid), before);
    for (uint64_t i = 0; i < constraints_of(grid).count; ++i) {
        ck_assert_uint_ne(constraints_of(grid).data[i].body_a, s.ids[0]);
        ck_assert_uint_ne(constraints_of(grid).data[i].body_b, s.ids[0]);
    }
    ck_ok(vox_body_set_enabled(grid, s.ids[0], 1));
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(check_margin(&s, grid, 0.5), before);
    /* Another margin, over bodies at rest. */
    ck_ok(vox_grid_set_margin(grid, 1));
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_ge(check_margin(&s, grid, 1), before);
    ck_ok(vox_body_remove(grid, s.ids[0]));
    ck_ok(vox_grid_step(grid));
    for (uint64_t i = 0; i < constraints_of(grid).count; ++i)
        ck_assert_uint_ne(constraints_of(grid).data[i].body_b, s.ids[0]);
    ck_ok(vox_grid_clear(grid));
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(constraints_of(grid).count, 0);
    vox_grid_destroy(grid);
    free_margin_scene(&s);
}
END_TEST

/* The same bytes for any number of workers. */
START_TEST(workers) {
    kept_constraints first = {NULL, 0};
    for (uint32_t workers = 1; workers <= 4; ++workers) {
        margin_scene s = {0};
        vox_grid_desc desc = margin_desc(0.7);
        desc.worker_count = workers;
        vox_grid* grid = grid_of(&desc);
        for (int i = 0; i < 2; ++i) {
            body ball = make_lattice_ball(&five_cut, 12, 12);
            jitter_body(&ball, 0.1, (uint64_t)i + 1);
            move_body(&ball, 23.5 * i, 0.3 * i, 0.2 * i);
            insert_body(&s, grid, ball);
        }
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_gt(count_near(grid), 20);
        if (workers == 1) first = keep_constraints(grid);
        same_constraints(grid, &first);
        vox_grid_destroy(grid);
        free_margin_scene(&s);
    }
    free(first.data);
}
END_TEST

START_TEST(arguments) {
    vox_grid* grid = engine_grid();
    ck_assert_double_eq(grid_info(grid).margin, 0);
    ck_fails(vox_grid_set_margin(NULL, 1), VOX_ERROR_INVALID_ARGUMENT, "grid");
    ck_ok(vox_grid_set_margin(grid, 0.5));
    const double bad[] = {-0.5, INFINITY, NAN, 5e37};
    for (int i = 0; i < 4; ++i) {
        ck_fails(vox_grid_set_margin(grid, bad[i]), VOX_ERROR_INVALID_ARGUMENT, "margin is");
        ck_assert_double_eq(grid_info(grid).margin, 0.5);
        const vox_grid_desc desc = margin_desc(bad[i]);
        vox_grid* other = NULL;
        ck_fails(vox_grid_create(&desc, &other), VOX_ERROR_INVALID_ARGUMENT, "margin is");
    }
    const uint64_t before = grid_info(grid).epoch;
    ck_ok(vox_grid_set_margin(grid, 0.25));
    ck_assert_uint_eq(grid_info(grid).epoch, before + 1);
    vox_grid_destroy(grid);
}
END_TEST

/* A step that fails leaves none. */
START_TEST(after_a_failure) {
    margin_scene s;
    vox_grid* grid = margin_grid(0.5);
    make_random_scene(&s, grid, 41);
    ck_ok(vox_grid_step(grid));
    const uint64_t all = check_margin(&s, grid, 0.5);
    const float x = s.bodies[2].positions[0];
    s.bodies[2].positions[0] = NAN;
    vox_constraint_view none;
    ck_assert_int_eq(vox_grid_step(grid), VOX_ERROR_NON_FINITE);
    ck_fails(vox_grid_get_constraints(grid, &none), VOX_ERROR_INVALID_STATE,
             "no constraints were looked for");
    ck_assert_uint_eq(pairs_of(grid).count, 0);
    s.bodies[2].positions[0] = x;
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(check_margin(&s, grid, 0.5), all);
    vox_grid_destroy(grid);
    free_margin_scene(&s);
}
END_TEST

START_TEST(off_releases_its_memory) {
    margin_scene s;
    vox_grid* grid = engine_grid();
    make_random_scene(&s, grid, 51);
    ck_ok(vox_grid_step(grid));
    uint64_t bytes = 0;
    for (int round = 0; round < 3; ++round) {
        ck_ok(vox_grid_set_margin(grid, 0.5));
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_gt(count_pairs(grid, VOX_PAIR_NEAR), 0);
        ck_assert_uint_gt(counters_of(grid).proximities, 0);
        ck_ok(vox_grid_set_margin(grid, 0));
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_eq(count_pairs(grid, VOX_PAIR_NEAR), 0);
        if (round == 1) bytes = counters_of(grid).bytes;
        if (round == 2) ck_assert_uint_eq(counters_of(grid).bytes, bytes);
    }
    vox_grid_destroy(grid);
    free_margin_scene(&s);
}
END_TEST

/* Two balls that pass each other, then the same way again: the second time takes no memory, also where the
 * work is shared in another way. */
START_TEST(steady_state_allocates_nothing) {
    for (uint32_t workers = 1; workers <= 3; workers += 2) {
        turns t = {workers, 0};
        margin_scene s = {0};
        ledger l = {0};
        vox_grid_desc desc = margin_desc(0.5);
        desc.allocator = ledger_allocator(&l);
        desc.worker_count = workers;
        const vox_task_system tasks = {take_turns, taken, &t};
        desc.tasks = &tasks;
        vox_grid* grid = grid_of(&desc);
        for (uint64_t i = 0; i < 2; ++i) {
            body ball = make_lattice_ball(&five_cut, 8, 8);
            jitter_body(&ball, 0.1, i + 1);
            insert_body(&s, grid, ball);
        }
        float* positions = s.bodies[1].positions;
        const size_t size = 3 * sizeof(float) * s.bodies[1].vertex_count;
        move_body(&s.bodies[1], 17, 0.3, 0.4);
        float* start = malloc(size);
        memcpy(start, positions, size);
        uint64_t calls = 0;
        for (int round = 0; round < 4; ++round) {
            if (round == 3) calls = l.calls;
            t.in_turn = round == 3;
            memcpy(positions, start, size);
            for (int step = 0; step < 16; ++step) {
                move_body(&s.bodies[1], -0.3, 0, 0);
                ck_ok(vox_grid_step(grid));
            }
        }
        ck_assert_uint_eq(l.calls, calls);
        vox_grid_destroy(grid);
        ck_assert_uint_eq(l.bytes, 0);
        free(start);
        free_margin_scene(&s);
    }
}
END_TEST

/* Every allocation of a step fails once; the grid stays usable. */
START_TEST(without_memory) {
    ledger l = {0};
    vox_grid_desc desc = margin_desc(0.5);
    int failures = 0;
    desc.allocator = ledger_allocator(&l);
    for (uint64_t n = 1;; ++n) {
        margin_scene s;
        vox_grid* grid = grid_of(&desc);
        make_random_scene(&s, grid, 61);
        l.calls = 0;
        l.fail_at = n;
        const vox_result result = vox_grid_step(grid);
        l.fail_at = 0;
        const int is_last = l.calls < n;
        if (result != VOX_OK) {
            ck_assert_int_eq(result, VOX_ERROR_OUT_OF_MEMORY);
            ck_assert_uint_eq(pairs_of(grid).count, 0);
            ++failures;
        }
        ck_ok(vox_grid_step(grid));
        (void)check_margin(&s, grid, 0.5);
        vox_grid_destroy(grid);
        ck_assert_uint_eq(l.bytes, 0);
        free_margin_scene(&s);
        if (is_last) break;
    }
    ck_assert_int_gt(failures, 20);
}
END_TEST

/* The reference engine takes less for its cells where less is left, so the budget shrinks until a step fails.
 */
START_TEST(budget) {
    double share = 1;
    uint64_t peak = 0;
    vox_result result = VOX_OK;
    while (result == VOX_OK) {
        margin_scene s;
        vox_grid_desc desc = margin_desc(0.5);
        desc.byte_budget = (uint64_t)(share * (double)peak);
        vox_grid* grid = grid_of(&desc);
        make_random_scene(&s, grid, 71);
        result = vox_grid_step(grid);
        if (result == VOX_OK) {
            peak = peak ? peak : counters_of(grid).peak_bytes;
            share -= 0.01;
        } else {
            ck_assert_int_eq(result, VOX_ERROR_BUDGET);
            ck_assert_uint_eq(pairs_of(grid).count, 0);
        }
        vox_grid_destroy(grid);
        free_margin_scene(&s);
    }
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, as_queries_find_them, boxes_face_to_face, many_small_bodies, filters_and_pairs,
                   at_rest_and_edited, workers, arguments, after_a_failure, off_releases_its_memory,
                   steady_state_allocates_nothing, without_memory, budget);
}

SUITE(margin) { add_for_each_engine(suite, add_tests); }
