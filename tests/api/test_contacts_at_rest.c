/* Meshes at rest: what is taken over from the last step is what a fresh grid finds. */
#include <math.h>
#include <string.h>

#include "scenes/bodies.h"
#include "support/suite.h"

static uint64_t random_state;
static uint32_t below(uint32_t count) { return random_below(&random_state, count); }

enum { most_bodies = 12 };

/* Some bodies and the grid they are stepped in. */
typedef struct scene {
    body bodies[most_bodies];
    float* strided[most_bodies]; /* four floats a vertex, where the grid reads that; else null */
    vox_body ids[most_bodies];   /* 0: not in the grid */
    uint32_t self[most_bodies];
    vox_grid* grid;
} scene;

/* Multiples of 1/16: vertices on facets, edges and corners are common. */
static float somewhere(void) { return (float)below(48) * 0.0625f; }

static void insert(scene* s, int i) {
    vox_mesh_desc desc = body_desc(&s->bodies[i]);
    if (s->strided[i]) {
        desc.positions.data = s->strided[i];
        desc.positions.byte_stride = 4 * sizeof(float);
    }
    if (s->self[i]) desc.filter.flags = VOX_FILTER_SELF_COLLISION;
    ck_ok(vox_mesh_insert(s->grid, &desc, &s->ids[i]));
}

/* The strided copy follows. */
static void moved(scene* s, int i) {
    if (!s->strided[i]) return;
    for (uint32_t v = 0; v < s->bodies[i].vertex_count; ++v)
        memcpy(s->strided[i] + 4 * v, s->bodies[i].positions + 3 * v, 3 * sizeof(float));
}

static vox_grid_desc default_desc(void) {
    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags = VOX_GRID_CONSTRAINTS;
    return desc;
}

static void make_scene_of(scene* s, uint32_t count, const vox_grid_desc* desc) {
    memset(s, 0, sizeof *s);
    s->grid = grid_of(desc);
    for (uint32_t i = 0; i < count; ++i) {
        const float x = somewhere(), y = somewhere(), z = somewhere();
        s->bodies[i] = make_box(2 + below(4), 0.25f, x, y, z);
        s->self[i] = below(2);
        if (below(3) == 0) {
            s->strided[i] = (float*)malloc(4 * sizeof(float) * s->bodies[i].vertex_count);
            moved(s, (int)i);
        }
        insert(s, (int)i);
    }
}

static void make_scene(scene* s, uint32_t count) {
    const vox_grid_desc desc = default_desc();
    make_scene_of(s, count, &desc);
}

static void free_scene(scene* s) {
    vox_grid_destroy(s->grid);
    for (int i = 0; i < most_bodies; ++i) {
        free_body(&s->bodies[i]);
        free(s->strided[i]);
    }
}

/* Moves a whole body, one vertex of it, or folds some of it. */
static void move_one(scene* s, int i) {
    float* p = s->bodies[i].positions;
    const uint32_t vertices = s->bodies[i].vertex_count, how = below(3);
    const float by = 0.0625f * ((float)below(8) - 3.5f);
    if (how == 0)
        for (uint32_t v = 0; v < vertices; ++v) p[3 * v + 1] += by;
    if (how == 1) {
        const uint32_t v = below(vertices), axis = below(3);
        p[3 * v + axis] += by;
    }
    if (how == 2)
        for (uint32_t v = 0; v < vertices; v += 3) p[3 * v] = p[3 * (vertices - 1 - v)];
    moved(s, i);
}

/* Steps, and compares contacts and constraints with those of a new grid over the same meshes in the same
 * order. */
static grid_counts check_step(scene* s) {
    vox_body id_of[most_bodies] = {0};
    const vox_grid_desc plain = default_desc();
    vox_grid* grid = grid_of(&plain);
    ck_ok(vox_grid_step(s->grid));
    const vox_contact_view mine = contacts_of(s->grid);
    uint32_t count = 0;
    for (uint32_t k = 0; k < most_bodies; ++k) { /* in the order of their ids */
        int next = -1;
        for (int i = 0; i < most_bodies; ++i)
            if (s->ids[i] && (count == 0 || s->ids[i] > id_of[count - 1]) &&
                (next < 0 || s->ids[i] < s->ids[next]))
                next = i;
        if (next < 0) break;
        vox_mesh_desc desc = body_desc(&s->bodies[next]);
        if (s->self[next]) desc.filter.flags = VOX_FILTER_SELF_COLLISION;
        insert_mesh(grid, &desc);
        id_of[count++] = s->ids[next];
    }
    ck_ok(vox_grid_step(grid));
    const vox_contact_view fresh = contacts_of(grid);
    ck_assert_uint_eq(mine.count, fresh.count);
    for (uint64_t c = 0; c < mine.count; ++c) {
        vox_contact expected = fresh.data[c]; /* slots of the new grid are 0, 1, ... */
        expected.body_a = id_of[vox_body_slot(expected.body_a)];
        expected.body_b = id_of[vox_body_slot(expected.body_b)];
        ck_assert_mem_eq(&mine.data[c], &expected, sizeof expected);
    }
    const vox_constraint_view p = constraints_of(s->grid), q = constraints_of(grid);
    ck_assert_uint_eq(p.count, q.count);
    for (uint64_t i = 0; i < q.count; ++i) {
        vox_constraint expected = q.data[i];
        expected.body_a = id_of[vox_body_slot(expected.body_a)];
        expected.body_b = id_of[vox_body_slot(expected.body_b)];
        expected.pair = p.data[i].pair; /* after other pairs that ended */
        expected.previous = p.data[i].previous;
        ck_assert_mem_eq(&p.data[i], &expected, sizeof expected);
    }
    vox_grid_destroy(grid);
    const grid_counts counters = counters_of(s->grid);
    ck_assert_uint_eq(counters.contacts, mine.count);
    ck_assert_uint_le(counters.carried_contacts, mine.count);
    ck_assert_uint_le(counters.carried_penetrations, counters.carried_contacts);
    ck_assert_uint_eq(counters.carried_penetrations > 0, counters.carried_contacts > 0);
    return counters;
}

/* Two steps to see that a body stays where it is, and one that knows. */
static void come_to_rest(scene* s) {
    for (int step = 0; step < 2; ++step) (void)check_step(s);
    ck_assert_uint_eq(check_step(s).moved_bodies, 0);
}

START_TEST(some_move) {
    uint64_t carried = 0, found = 0, depths_carried = 0, depths_found = 0;
    random_state = 1;
    for (int round = 0; round < 12; ++round) {
        scene s;
        make_scene(&s, 2 + below(most_bodies - 1));
        for (int step = 0; step < 12; ++step) {
            uint32_t moving = 0, present = 0;
            for (int i = 0; i < most_bodies; ++i) {
                if (!s.ids[i]) continue;
                ++present;
                if (below(4) != 0) continue;
                move_one(&s, i);
                ++moving;
            }
            const grid_counts counters = check_step(&s);
            ck_assert_uint_eq(counters.bodies, present);
            if (step == 0) ck_assert_uint_eq(counters.moved_bodies, present);
            carried += counters.carried_contacts;
            found += counters.contacts - counters.carried_contacts;
            depths_carried += counters.carried_penetrations;
            depths_found += counters.penetrations - counters.carried_penetrations;
        }
        free_scene(&s);
    }
    ck_assert_uint_gt(depths_carried, 1000);
    ck_assert_uint_gt(depths_found, 1000);
    ck_assert_uint_gt(carried, 10000);
    ck_assert_uint_gt(found, 10000);
}
END_TEST

START_TEST(nothing_moves) {
    scene s;
    random_state = 2;
    make_scene(&s, 8);
    grid_counts counters = check_step(&s);
    const uint64_t contacts = counters.contacts;
    ck_assert_uint_gt(contacts, 20);
    ck_assert_uint_eq(counters.moved_bodies, 8);
    ck_assert_uint_eq(counters.carried_contacts, 0);
    for (int step = 0; step < 3; ++step) {
        counters = check_step(&s);
        ck_assert_uint_eq(counters.moved_bodies, 0);
        ck_assert_uint_eq(counters.carried_contacts, contacts);
        ck_assert_uint_eq(counters.carried_penetrations, counters.penetrations);
        ck_assert_uint_eq(counters.leaving_edges + counters.closest_searches, 0);
        ck_assert_uint_eq(counters.candidates, 0);
        ck_assert_uint_eq(counters.visited_cells, 0);
    }
    /* Bodies that moved all together come to rest: one step more to know it. */
    for (int step = 0; step < 3; ++step) {
        for (int i = 0; i < 8; ++i) {
            for (uint32_t v = 0; v < s.bodies[i].vertex_count; ++v) s.bodies[i].positions[3 * v] += 0.25f;
            moved(&s, i);
        }
        counters = check_step(&s);
        ck_assert_uint_eq(counters.moved_bodies, 8);
    }
    come_to_rest(&s);
    free_scene(&s);
}
END_TEST

/* Positions are compared as bits: what is equal as a number, or by a box, is not the same. */
START_TEST(small_and_hidden_moves) {
    scene s;
    random_state = 3;
    make_scene(&s, 2);
    (void)check_step(&s);
    for (int i = 0; i < 2; ++i) {
        float* const p = s.bodies[i].positions;
        const uint32_t inner = s.bodies[i].vertex_count / 2; /* no corner of the box */
        p[3 * inner] = 0;
        moved(&s, i);
        come_to_rest(&s);
        p[3 * inner] = -0.0f;
        moved(&s, i);
        ck_assert_uint_eq(check_step(&s).moved_bodies, 1);
        come_to_rest(&s);
        p[3 * inner] = nextafterf(p[3 * inner + 1], 9); /* inside the box */
        moved(&s, i);
        ck_assert_uint_eq(check_step(&s).moved_bodies, 1);
        /* There and back again: at rest, but not since the last step. */
        const float was = p[3 * inner + 1];
        p[3 * inner + 1] = somewhere();
        moved(&s, i);
        (void)check_step(&s);
        p[3 * inner + 1] = was;
        moved(&s, i);
        ck_assert_uint_eq(check_step(&s).moved_bodies, 1);
    }
    free_scene(&s);
}
END_TEST

START_TEST(failed_steps) {
    scene s;
    vox_contact_view view;
    random_state = 4;
    make_scene(&s, 6);
    for (int i = 0; i < 6; ++i) {
        (void)check_step(&s);
        ck_assert_uint_eq(check_step(&s).moved_bodies, 0);
        float* const p = &s.bodies[i].positions[3 * below(s.bodies[i].vertex_count)];
        const float was = *p;
        *p = i % 2 ? NAN : INFINITY;
        moved(&s, i);
        move_one(&s, (i + 1) % 6); /* and this one moves in the failing step only */
        for (int again = 0; again < 2; ++again) {
            ck_fails(vox_grid_step(s.grid), VOX_ERROR_NON_FINITE, "vertex");
            ck_ok(vox_grid_get_contacts(s.grid, &view));
            ck_assert_uint_eq(view.count, 0);
        }
        *p = was;
        moved(&s, i);
        const grid_counts counters = check_step(&s);
        ck_assert_uint_eq(counters.moved_bodies, 6);
        ck_assert_uint_eq(counters.carried_contacts, 0);
    }
    free_scene(&s);
}
END_TEST

START_TEST(budget_ends_a_step) {
    /* Contacts become many from step to step, until there is no room for them: anywhere in a step. Then they
     * become fewer again. */
    scene s;
    uint32_t failures = 0, successes = 0;
    for (uint64_t part = 0; part < 16; ++part) {
        vox_grid_desc desc = default_desc();
        random_state = 5;
        make_scene_of(&s, 6, &desc);
        const uint64_t inserted = counters_of(s.grid).peak_bytes;
        (void)check_step(&s);
        const uint64_t stepped = counters_of(s.grid).peak_bytes;
        free_scene(&s);
        desc.byte_budget = inserted + (stepped - inserted) * (part + 4) / 16;
        random_state = 5;
        make_scene_of(&s, 6, &desc);
        for (int step = 0; step < 12; ++step) {
            /* All but one in the same place or all where they were, one after the other. */
            float* const p = s.bodies[step % 6].positions;
            const float by = step < 6 ? p[0] - s.bodies[(step + 1) % 6].positions[0] : 2;
            for (uint32_t v = 0; v < s.bodies[step % 6].vertex_count; ++v) p[3 * v] -= by;
            moved(&s, step % 6);
            if (vox_grid_step(s.grid) != VOX_OK) {
                ++failures;
                continue;
            }
            ++successes;
            (void)check_step(&s);
        }
        free_scene(&s);
    }
    ck_assert_uint_gt(failures, 10);
    ck_assert_uint_gt(successes, 10);
}
END_TEST

START_TEST(meshes_come_and_go) {
    scene s;
    random_state = 6;
    make_scene(&s, 8);
    uint64_t carried = 0;
    for (int step = 0; step < 60; ++step) {
        const int i = (int)below(8);
        if (below(3) == 0) move_one(&s, (int)below(8));
        if (s.ids[i]) {
            ck_ok(vox_body_remove(s.grid, s.ids[i]));
            s.ids[i] = 0;
        } else {
            insert(&s, i); /* in the slot of another, perhaps, and with the positions it had */
        }
        carried += check_step(&s).carried_contacts;
    }
    ck_assert_uint_gt(carried, 1000);
    /* The same mesh out and in again is a new one. */
    vox_body old = 0;
    for (int i = 0; i < 8; ++i)
        if (s.ids[i]) old = s.ids[i];
    (void)check_step(&s);
    for (int i = 0; i < 8; ++i)
        if (s.ids[i] == old) {
            ck_ok(vox_body_remove(s.grid, old));
            insert(&s, i);
        }
    ck_assert_uint_eq(check_step(&s).moved_bodies, 1);
    ck_ok(vox_grid_clear(s.grid));
    memset(s.ids, 0, sizeof s.ids);
    ck_assert_uint_eq(check_step(&s).contacts, 0);
    free_scene(&s);
}
END_TEST

START_TEST(bound_elsewhere) {
    scene s;
    random_state = 7;
    make_scene(&s, 3);
    (void)check_step(&s);
    /* Other memory, same values: at rest. Other values: moved. */
    const size_t bytes = 3 * sizeof(float) * s.bodies[0].vertex_count;
    float* const copy = (float*)malloc(bytes);
    memcpy(copy, s.bodies[0].positions, bytes);
    ck_ok(bind_array(s.grid, s.ids[0], copy, VOX_FORMAT_FLOAT, 0, 0));
    ck_assert_uint_eq(check_step(&s).moved_bodies, 0);
    s.bodies[0].positions[0] += 0.5f;
    memcpy(copy, s.bodies[0].positions, bytes);
    ck_assert_uint_eq(check_step(&s).moved_bodies, 1);
    s.bodies[0].positions[0] += 0.5f;
    s.bodies[0].positions[7] += 0.5f;
    ck_ok(bind_array(s.grid, s.ids[0], s.bodies[0].positions, VOX_FORMAT_FLOAT, 0, 0));
    ck_assert_uint_eq(check_step(&s).moved_bodies, 1);
    free(copy);
    free_scene(&s);
}
END_TEST

START_TEST(settings_and_marks) {
    scene s;
    random_state = 8;
    make_scene(&s, 5);
    (void)check_step(&s);
    ck_assert_uint_eq(check_step(&s).moved_bodies, 0);
    ck_ok(vox_grid_set_cell_size(s.grid, 0.5));
    ck_assert_uint_eq(check_step(&s).moved_bodies, 5);
    ck_assert_uint_eq(check_step(&s).moved_bodies, 0);
    ck_ok(vox_grid_set_worker_count(s.grid, 2));
    ck_assert_uint_eq(check_step(&s).moved_bodies, 5);
    ck_ok(vox_grid_reserve(s.grid, 100, 10000)); /* contacts stay */
    ck_assert_uint_eq(check_step(&s).moved_bodies, 0);
    ck_ok(vox_body_mark_moved(s.grid, s.ids[2]));
    ck_assert_uint_eq(check_step(&s).moved_bodies, 1);
    ck_assert_uint_eq(check_step(&s).moved_bodies, 0);
    ck_fails(vox_body_mark_moved(NULL, s.ids[2]), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_body_mark_moved(s.grid, 77), VOX_ERROR_INVALID_HANDLE, "body id 77");
    free_scene(&s);
}
END_TEST

/* Steps, and finds constraints with a budget. */
static grid_counts step_with_budget(vox_grid* grid, uint64_t budget) {
    vox_constraint_desc desc = vox_default_constraint_desc();
    desc.closest_budget = budget;
    ck_ok(vox_grid_step(grid));
    ck_ok(vox_grid_find_constraints(grid, &desc));
    return counters_of(grid);
}

/* Depths that are carried over take nothing of a budget, and unknown ones stay so and are counted. */
START_TEST(budget_of_searches) {
    vox_grid* grid = grid_of(NULL);
    body bodies[4] = {make_box(9, 0.25f, 0, 0, 0), make_box(2, 0.25f, 0.9f, 0.9f, 0.9f),
                      make_box(9, 0.25f, 9, 0, 0), make_box(2, 0.25f, 9.9f, 0.9f, 0.9f)};
    for (int b = 0; b < 4; ++b) {
        const vox_mesh_desc mesh = body_desc(&bodies[b]);
        insert_mesh(grid, &mesh);
    }
    grid_counts counters = step_with_budget(grid, 5);
    const uint64_t unknown = counters.unknown_penetrations;
    ck_assert_uint_eq(counters.closest_searches, 5);
    ck_assert_uint_gt(unknown, 27); /* all in the second pair of boxes are among them */
    for (int step = 0; step < 3; ++step) {
        counters = step_with_budget(grid, 5);
        ck_assert_uint_eq(counters.closest_searches, 0);
        ck_assert_uint_eq(counters.unknown_penetrations, unknown);
    }
    for (int step = 0; step < 2; ++step) { /* the last box moves: the five are for its vertices */
        for (uint32_t v = 0; v < bodies[3].vertex_count; ++v) bodies[3].positions[3 * v] += 0.01f;
        counters = step_with_budget(grid, 5);
        ck_assert_uint_eq(counters.closest_searches, 5);
        ck_assert_uint_eq(counters.unknown_penetrations, unknown - 5);
    }
    counters = step_with_budget(grid, 0); /* at rest, but not what was found with a budget */
    ck_assert_uint_eq(counters.unknown_penetrations, 0);
    ck_assert_uint_eq(counters.carried_penetrations, 0);
    ck_assert_uint_gt(counters.closest_searches, unknown);
    vox_grid_destroy(grid);
    for (int b = 0; b < 4; ++b) free_body(&bodies[b]);
}
END_TEST

START_TEST(reference_engine_rests_never) {
    vox_grid_desc desc = default_desc();
    use_engine(&desc, ENGINE_REFERENCE);
    scene s;
    random_state = 9;
    make_scene_of(&s, 4, &desc);
    for (int step = 0; step < 3; ++step) {
        const grid_counts counters = check_step(&s);
        ck_assert_uint_eq(counters.moved_bodies, 4);
        ck_assert_uint_eq(counters.carried_contacts, 0);
        ck_assert_uint_gt(counters.candidates, 0);
    }
    free_scene(&s);
}
END_TEST

SUITE(contacts_at_rest) {
    TCase* tests = add_case(suite, "rest");
    tcase_add_each(tests, nothing_moves, small_and_hidden_moves, failed_steps, meshes_come_and_go,
                   bound_elsewhere, settings_and_marks, budget_of_searches, reference_engine_rests_never);
    TCase* long_tests = add_tagged_case(suite, "long", "long");
    tcase_add_each(long_tests, some_move, budget_ends_a_step);
}
