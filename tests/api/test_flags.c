/* Flags of a grid that change, and sensors, which have no constraints. */
#include "scenes/random.h"
#include "support/depth_checks.h"
#include "support/ledger.h"

enum { most = 5 };

typedef struct scene {
    body bodies[most];
    vox_body ids[most];
    vox_grid* grid;
} scene;

/* Boxes in each other, the last one folded through itself. */
static void make_bodies(scene* s) {
    s->bodies[0] = make_box(4, 0.25f, 0, 0, 0);
    s->bodies[1] = make_box(3, 0.3f, 0.41f, 0.32f, 0.53f);
    s->bodies[2] = make_box(2, 0.11f, 0.6f, 0.61f, 0.67f);
    s->bodies[3] = make_box(4, 0.25f, -0.37f, 0.22f, 0.33f);
    s->bodies[4] = make_box(4, 0.25f, 0.52f, -0.41f, 0.26f);
    for (uint32_t v = 0; v < s->bodies[4].vertex_count; ++v) {
        float* p = s->bodies[4].positions + 3 * v;
        if (p[0] > 1) p[0] = 2 - 0.9f * p[0] + 0.1f * p[1];
    }
}

static void insert_bodies(scene* s, const vox_grid_desc* desc) {
    s->grid = grid_of(desc);
    for (int b = 0; b < most; ++b) {
        vox_mesh_desc mesh = body_desc(&s->bodies[b]);
        if (b == 4) mesh.filter.flags = VOX_FILTER_SELF_COLLISION;
        ck_ok(vox_mesh_insert(s->grid, &mesh, &s->ids[b]));
    }
}

static void make_scene(scene* s, uint32_t flags) {
    vox_grid_desc desc = engine_desc();
    desc.flags = flags;
    make_bodies(s);
    insert_bodies(s, &desc);
}

static void free_scene(scene* s) {
    vox_grid_destroy(s->grid);
    for (int b = 0; b < most; ++b) free_body(&s->bodies[b]);
}

static uint32_t flags_of(const vox_grid* grid) { return grid_info(grid).flags; }

static uint64_t epoch_of(const vox_grid* grid) { return grid_info(grid).epoch; }

/* But for `previous`, as the two may have begun to look for them at different times. */
static void same_in_both(const vox_grid* a, const vox_grid* b) {
    kept_constraints kept = keep_constraints(a);
    ck_assert_uint_gt(kept.count, 50);
    same_constraints(b, &kept);
    free(kept.data);
}

/* ---- constraints on and off ---- */

START_TEST(arguments) {
    vox_grid* grid = grid_of(NULL);
    ck_fails(vox_grid_set_flags(NULL, 0), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_set_flags(grid, 0x41), VOX_ERROR_INVALID_ARGUMENT,
             "flags is 0x41, of which 0x40 is unknown");
    ck_assert_uint_eq(flags_of(grid), 0);
    for (uint32_t flags = 0; flags < 8; ++flags) {
        ck_ok(vox_grid_set_flags(grid, flags));
        ck_assert_uint_eq(flags_of(grid), flags);
    }
    vox_grid_destroy(grid);
    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags = 0x4000 | VOX_GRID_CONSTRAINTS;
    grid = NULL;
    ck_fails(vox_grid_create(&desc, &grid), VOX_ERROR_INVALID_ARGUMENT, "flags is 0x4001, of which 0x4000");
}
END_TEST

START_TEST(on_later_is_on_from_the_start) {
    scene s, later;
    make_scene(&s, VOX_GRID_CONSTRAINTS);
    make_scene(&later, 0);
    ck_ok(vox_grid_step(s.grid));
    for (int round = 0; round < 3; ++round) {
        vox_constraint_view view;
        ck_ok(vox_grid_step(later.grid));
        ck_fails(vox_grid_get_constraints(later.grid, &view), VOX_ERROR_INVALID_STATE,
                 "set VOX_GRID_CONSTRAINTS");
        const vox_contact_view contacts = contacts_of(later.grid);
        const uint64_t epoch = epoch_of(later.grid);
        ck_ok(vox_grid_set_flags(later.grid, VOX_GRID_CONSTRAINTS));
        /* The contacts are still there; constraints come with the next step, or when they are asked for. */
        ck_assert_uint_gt(epoch_of(later.grid), epoch);
        ck_assert_uint_eq(contacts_of(later.grid).count, contacts.count);
        ck_fails(vox_grid_get_constraints(later.grid, &view), VOX_ERROR_INVALID_STATE, "since the last step");
        if (round == 1) {
            ck_ok(vox_grid_find_constraints(later.grid, NULL));
            same_in_both(s.grid, later.grid);
        }
        for (int step = 0; step < 3; ++step) { /* at rest, too */
            ck_ok(vox_grid_step(later.grid));
            check_depths(later.grid);
            same_in_both(s.grid, later.grid);
        }
        const uint64_t before = epoch_of(later.grid);
        ck_ok(vox_grid_set_flags(later.grid, VOX_GRID_CONSTRAINTS)); /* no change */
        ck_assert_uint_eq(epoch_of(later.grid), before);
        ck_ok(vox_grid_set_flags(later.grid, 0));
        ck_assert_uint_eq(contacts_of(later.grid).count, contacts.count);
        if (round == 1) {
            ck_ok(vox_grid_find_constraints(later.grid, NULL));
            same_in_both(s.grid, later.grid);
        }
    }
    free_scene(&s);
    free_scene(&later);
}
END_TEST

/* Bars laid across each other, whose edges alone meet: what was prepared is given up with the flag, and made
 * again where constraints are asked for. */
START_TEST(off_after_a_step) {
    vox_grid_desc settings = engine_desc();
    settings.flags = VOX_GRID_EDGES | VOX_GRID_CONSTRAINTS;
    vox_grid* grid = grid_of(&settings);
    body bars[2] = {make_block(&five_cut, 3, 1, 1), make_block(&five_cut, 1, 3, 1)};
    for (int b = 0; b < 2; ++b) {
        for (uint32_t v = 0; v < bars[b].vertex_count; ++v) bars[b].positions[3 * v + (uint32_t)b] *= 3;
        move_body(&bars[b], b ? -0.5 : -4.5, b ? -4.5 : -0.5, b ? 0.75 : 0);
        const vox_mesh_desc desc = body_desc(&bars[b]);
        insert_mesh(grid, &desc);
    }
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(contacts_of(grid).count, 0);
    kept_constraints kept = keep_constraints(grid);
    ck_assert_uint_gt(kept.count, 4);
    ck_ok(vox_grid_set_flags(grid, VOX_GRID_EDGES));
    ck_ok(vox_grid_find_constraints(grid, NULL));
    same_constraints(grid, &kept);
    free(kept.data);
    vox_grid_destroy(grid);
    for (int b = 0; b < 2; ++b) free_body(&bars[b]);
}
END_TEST

/* Edits while it is off are in what is prepared when it is on again. */
START_TEST(edits_while_off) {
    scene s, later;
    make_scene(&s, VOX_GRID_CONSTRAINTS);
    make_scene(&later, VOX_GRID_CONSTRAINTS);
    ck_ok(vox_grid_step(later.grid));
    ck_ok(vox_grid_set_flags(later.grid, 0));
    for (int g = 0; g < 2; ++g) {
        vox_grid* const grid = g ? later.grid : s.grid;
        uint32_t off[12];
        for (uint32_t i = 0; i < 12; ++i) off[i] = 5 * i + 2;
        ck_ok(vox_mesh_set_tets_enabled(grid, s.ids[0], off, 12, 0));
        ck_ok(vox_mesh_remove_tets(grid, s.ids[1], off, 3));
        const vox_mesh_desc other = body_desc(&s.bodies[3]);
        ck_ok(vox_mesh_set_topology(grid, s.ids[2], &other));
    }
    ck_ok(vox_grid_set_flags(later.grid, VOX_GRID_CONSTRAINTS));
    ck_ok(vox_grid_step(s.grid));
    ck_ok(vox_grid_step(later.grid));
    check_depths(later.grid);
    same_in_both(s.grid, later.grid);
    free_scene(&s);
    free_scene(&later);
}
END_TEST

/* What a grid holds does not depend on what its flags were before. */
START_TEST(memory_comes_back) {
    uint64_t bytes[2], before = 0;
    for (uint32_t flags = 0; flags < 2; ++flags) {
        scene s;
        make_scene(&s, flags);
        before = counters_of(s.grid).bytes;
        ck_ok(vox_grid_set_flags(s.grid, 1 - flags));
        ck_assert_uint_ne(counters_of(s.grid).bytes, before);
        ck_ok(vox_grid_set_flags(s.grid, flags));
        ck_assert_uint_eq(counters_of(s.grid).bytes, before);
        bytes[flags] = before;
        ck_ok(vox_grid_step(s.grid));
        const uint64_t stepped = counters_of(s.grid).bytes;
        ck_ok(vox_grid_set_flags(s.grid, 1));
        ck_ok(vox_grid_step(s.grid));
        ck_ok(vox_grid_set_flags(s.grid, 0));
        if (flags == 0) ck_assert_uint_eq(counters_of(s.grid).bytes, stepped);
        free_scene(&s);
    }
    scene s;
    uint64_t tets = 0;
    make_bodies(&s);
    for (int b = 0; b < most; ++b) tets += s.bodies[b].tet_count, free_body(&s.bodies[b]);
    ck_assert_uint_gt(bytes[1] - bytes[0], 20 * tets);
}
END_TEST

/* Without memory for one mesh none is prepared, and all is as before. */
START_TEST(all_or_nothing) {
    ledger l = {0};
    vox_grid_desc desc = engine_desc();
    desc.allocator = ledger_allocator(&l);
    scene s;
    make_bodies(&s);
    uint64_t failures = 0, hash = 0, again = 0;
    desc.flags = VOX_GRID_SKIP_BAD_BODIES;
    insert_bodies(&s, &desc);
    ck_ok(vox_grid_step(s.grid));
    ck_ok(vox_grid_get_hash(s.grid, &hash));
    for (vox_result result = VOX_ERROR_OUT_OF_MEMORY; result != VOX_OK;) {
        const uint64_t bytes = l.bytes, epoch = epoch_of(s.grid);
        l.calls = 0;
        l.fail_at = failures + 1;
        result = vox_grid_set_flags(s.grid, VOX_GRID_CONSTRAINTS);
        l.fail_at = 0;
        if (result == VOX_OK) break;
        ++failures;
        ck_assert_int_eq(result, VOX_ERROR_OUT_OF_MEMORY);
        ck_assert_uint_eq(l.bytes, bytes);
        ck_assert_uint_eq(epoch_of(s.grid), epoch);
        ck_assert_uint_eq(flags_of(s.grid), VOX_GRID_SKIP_BAD_BODIES);
        if (failures % 8 != 1) continue;
        ck_ok(vox_grid_step(s.grid));
        ck_ok(vox_grid_get_hash(s.grid, &again));
        ck_assert_uint_eq(hash, again);
    }
    ck_assert_uint_gt(failures, 20);
    ck_assert_uint_eq(flags_of(s.grid), VOX_GRID_CONSTRAINTS);
    ck_ok(vox_grid_step(s.grid));
    check_depths(s.grid);
    free_scene(&s);
    ck_assert_uint_eq(l.bytes, 0);
}
END_TEST

START_TEST(budget) {
    scene s;
    make_scene(&s, 0);
    const uint64_t without = counters_of(s.grid).bytes;
    ck_ok(vox_grid_set_flags(s.grid, VOX_GRID_CONSTRAINTS));
    const uint64_t with = counters_of(s.grid).bytes;
    free_scene(&s);
    vox_grid_desc desc = engine_desc();
    desc.flags = 0;
    desc.byte_budget = (without + with) / 2;
    make_bodies(&s);
    insert_bodies(&s, &desc);
    ck_fails(vox_grid_set_flags(s.grid, VOX_GRID_CONSTRAINTS), VOX_ERROR_BUDGET, "budget");
    ck_assert_uint_eq(counters_of(s.grid).bytes, without);
    ck_assert_uint_eq(flags_of(s.grid), 0);
    free_scene(&s);
}
END_TEST

/* ---- sensors ---- */

static void set_sensor(vox_grid* grid, vox_body mesh, uint32_t sensor) {
    vox_filter filter = plain_filter();
    ck_ok(get_filter(grid, mesh, &filter));
    filter.flags = (filter.flags & VOX_FILTER_SELF_COLLISION) | (sensor ? VOX_FILTER_SENSOR : 0u);
    ck_ok(vox_body_set_filter(grid, mesh, &filter));
}

static int body_of(const scene* s, vox_body mesh) {
    for (int b = 0; b < most; ++b)
        if (s->ids[b] == mesh) return b;
    ck_abort_msg("no mesh %u", mesh);
    return -1;
}

/* The contacts and pairs of `s` are those of `all`, and so are its constraints, without those of sensors. */
static uint64_t check_sensors(const scene* s, const vox_grid* all, const uint32_t* sensors) {
    const vox_constraint_view found = check_depths(s->grid), every = constraints_of(all);
    const vox_pair_view pairs = pairs_of(s->grid), all_pairs = pairs_of(all);
    uint64_t hashes[2], n = 0;
    ck_ok(vox_grid_get_hash(s->grid, &hashes[0]));
    ck_ok(vox_grid_get_hash(all, &hashes[1]));
    ck_assert_uint_eq(hashes[0], hashes[1]);
    ck_assert_uint_eq(pairs.count, all_pairs.count);
    ck_assert_mem_eq(pairs.data, all_pairs.data, pairs.count * sizeof *pairs.data);
    for (uint64_t i = 0; i < every.count; ++i) {
        vox_constraint c = every.data[i];
        if (sensors[body_of(s, c.body_a)] || sensors[body_of(s, c.body_b)]) continue;
        ck_assert_uint_lt(n, found.count);
        c.previous = found.data[n].previous;
        ck_assert_mem_eq(&found.data[n], &c, sizeof c);
        ++n;
    }
    ck_assert_uint_eq(n, found.count);
    return n;
}

START_TEST(sensors_have_none) {
    uint64_t random = 3, some = 0, left_out = 0;
    scene s, all;
    make_scene(&s, VOX_GRID_CONSTRAINTS | VOX_GRID_EDGES);
    make_scene(&all, VOX_GRID_CONSTRAINTS | VOX_GRID_EDGES);
    ck_ok(vox_grid_set_margin(s.grid, 0.05));
    ck_ok(vox_grid_set_margin(all.grid, 0.05));
    uint32_t sensors[most] = {0};
    for (int step = 0; step < 30; ++step) {
        for (int b = 0; b < most; ++b) {
            /* Some keep their filters, some move: what is carried over is as if it was found. */
            if (random_below(&random, 2))
                set_sensor(s.grid, s.ids[b], sensors[b] = random_below(&random, 3) == 0);
            if (random_below(&random, 3)) continue;
            const float by = random_float(&random, -0.05f, 0.05f);
            for (uint32_t v = 0; v < s.bodies[b].vertex_count; ++v) {
                s.bodies[b].positions[3 * v] += by;
                all.bodies[b].positions[3 * v] += by;
            }
        }
        for (int again = 0; again < 2; ++again) {
            ck_ok(vox_grid_step(s.grid));
            ck_ok(vox_grid_step(all.grid));
            const uint64_t n = check_sensors(&s, all.grid, sensors);
            some += n;
            left_out += constraints_of(all.grid).count - n;
            /* Nor where they are asked for. */
            ck_ok(vox_grid_find_constraints(s.grid, NULL));
            (void)check_sensors(&s, all.grid, sensors);
        }
    }
    ck_assert_uint_gt(some, 3000);
    ck_assert_uint_gt(left_out, 3000);
    if (suite_engine == ENGINE_FAST) ck_assert_uint_gt(counters_of(s.grid).carried_contacts, 0);
    free_scene(&s);
    free_scene(&all);
}
END_TEST

/* A sensor is not prepared for constraints, whenever that is said. */
START_TEST(memory_of_a_mesh) {
    scene s;
    uint64_t none[3];
    make_bodies(&s);
    for (int how = 0; how < 3; ++how) { /* no flag, at insertion, later */
        vox_grid* grid = how == 0 ? engine_grid() : depth_grid();
        vox_filter filter = plain_filter();
        if (how == 1) filter.flags |= VOX_FILTER_SENSOR;
        for (int b = 0; b < most; ++b) {
            vox_mesh_desc mesh = body_desc(&s.bodies[b]);
            mesh.filter = filter;
            ck_ok(vox_mesh_insert(grid, &mesh, &s.ids[b]));
            const uint64_t with = counters_of(grid).bytes;
            if (how == 2) {
                set_sensor(grid, s.ids[b], 1);
                ck_assert_uint_gt(with, counters_of(grid).bytes + 20 * s.bodies[b].tet_count);
            }
        }
        none[how] = counters_of(grid).bytes;
        ck_assert_uint_eq(none[how], none[0]);
        if (how > 0) { /* off and on again: nothing to prepare */
            ck_ok(vox_grid_set_flags(grid, 0));
            ck_ok(vox_grid_set_flags(grid, VOX_GRID_CONSTRAINTS));
            ck_assert_uint_eq(counters_of(grid).bytes, none[0]);
            ck_ok(vox_grid_step(grid));
            ck_assert_uint_eq(constraints_of(grid).count, 0);
            ck_assert_uint_gt(contacts_of(grid).count, 0);
        }
        vox_grid_destroy(grid);
    }
    for (int b = 0; b < most; ++b) free_body(&s.bodies[b]);
}
END_TEST

/* No memory for a mesh that is to be no sensor any more: its filter stays. */
START_TEST(filter_all_or_nothing) {
    ledger l = {0};
    vox_grid_desc desc = depth_desc();
    desc.allocator = ledger_allocator(&l);
    scene s;
    make_bodies(&s);
    insert_bodies(&s, &desc);
    vox_filter filter = plain_filter();
    filter.flags |= VOX_FILTER_SENSOR;
    ck_ok(vox_body_set_filter(s.grid, s.ids[0], &filter));
    uint64_t failures = 0;
    filter = plain_filter();
    filter.self_rings = 2;
    for (;; ++failures) {
        const uint64_t bytes = l.bytes;
        l.calls = 0;
        l.fail_at = failures + 1;
        const vox_result result = vox_body_set_filter(s.grid, s.ids[0], &filter);
        l.fail_at = 0;
        if (result == VOX_OK) break;
        ck_assert_int_eq(result, VOX_ERROR_OUT_OF_MEMORY);
        ck_assert_uint_eq(l.bytes, bytes);
        vox_filter kept = plain_filter();
        ck_ok(get_filter(s.grid, s.ids[0], &kept));
        ck_assert_uint_eq(kept.flags, VOX_FILTER_SENSOR);
        ck_assert_uint_eq(kept.self_rings, 0);
    }
    ck_assert_uint_gt(failures, 10);
    ck_ok(vox_grid_step(s.grid));
    check_depths(s.grid);
    free_scene(&s);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, arguments, on_later_is_on_from_the_start, off_after_a_step, edits_while_off,
                   memory_comes_back, all_or_nothing, budget, sensors_have_none, memory_of_a_mesh,
                   filter_all_or_nothing);
}

SUITE(flags) { add_for_each_engine(suite, add_tests); }
