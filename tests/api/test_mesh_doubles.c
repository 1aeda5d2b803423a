/* Double positions: exact for the doubles given, in every range of them, mixed with floats; and what does not
 * fit. */
#include "support/solids_of_doubles.h"

#include <stdio.h>

/* ---- against brute force ---------------------------------------------------------------------------------
 */

START_TEST(exact_for_the_doubles_given) {
    state = 1;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i) {
        size_t contacts = 0;
        uint64_t exact_tests = 0;
        for (int scene = 0; scene < 16; ++scene) {
            const uint32_t count = 2 + random_below(&state, 2);
            vox_grid* grid = new_grid(1);
            solid solids[3];
            vox_body ids[3];
            for (uint32_t m = 0; m < count; ++m) {
                solids[m] = make_solid(1 + random_below(&state, 3));
                const double x = random_double(-1, 1), y = random_double(-1, 1), z = random_double(-1, 1);
                place(&solids[m], &kinds[i], x, y, z);
                write_solid(&solids[m], VOX_FORMAT_DOUBLE, 24 + random_below(&state, 3) * 4);
                ids[m] = insert_self(grid, &solids[m]);
            }
            ck_ok(vox_grid_step(grid));
            contacts += check_contacts(grid, solids, count, ids, 1);
            grid_counts counters = counters_of(grid);
            exact_tests += counters.exact_tests;
            vox_grid_destroy(grid);
            for (uint32_t m = 0; m < count; ++m) free_solid(&solids[m]);
        }
        ck_assert_msg(contacts > 50, "%s: %zu contacts", kinds[i].name, contacts);
        ck_assert_msg(!kinds[i].coarse || exact_tests > 20, "%s: %llu exact tests", kinds[i].name,
                      (unsigned long long)exact_tests);
    }
}
END_TEST

START_TEST(floats_and_doubles_in_one_grid) {
    static const kind here = {"", 1.0 / 3, 0, 0.4, 1}, far = {"", 1.0 / 3, 1000, 0.4, 1};
    state = 2;
    size_t contacts = 0;
    for (int scene = 0; scene < 40; ++scene) {
        vox_grid* grid = new_grid(1);
        solid solids[3];
        vox_body ids[3];
        for (uint32_t m = 0; m < 3; ++m) {
            solids[m] = make_solid(1 + random_below(&state, 3));
            const double x = random_double(-1, 1), y = random_double(-1, 1);
            place(&solids[m], scene % 2 ? &far : &here, x, y, 0);
            const int floats = m < 2 ? (int)m : (int)random_below(&state, 2);
            write_solid(&solids[m], floats ? VOX_FORMAT_FLOAT : VOX_FORMAT_DOUBLE,
                        (floats ? 12 : 24) + random_below(&state, 3) * 4);
            ids[m] = insert(grid, &solids[m], 0);
        }
        ck_ok(vox_grid_step(grid));
        contacts += check_contacts(grid, solids, 3, ids, 0);
        vox_grid_destroy(grid);
        for (uint32_t m = 0; m < 3; ++m) free_solid(&solids[m]);
    }
    ck_assert_uint_gt(contacts, 500);
}
END_TEST

/* A vertex one double off a face, where all floats are the same: inside or not. */
START_TEST(less_than_a_float_apart) {
    const double at = 4097.1;
    double tet[12] = {at, at, at, at + 1, at, at, at, at + 1, at, at, at, at + 1};
    double point[3] = {at + 0.25, at + 0.25, at};
    vox_grid* grid = new_grid(1);
    vox_mesh_desc a = vox_default_mesh_desc(), b = vox_default_mesh_desc();
    a.positions.format = b.positions.format = VOX_FORMAT_DOUBLE;
    a.positions.data = point;
    a.positions.count = 1;
    b.positions.data = tet;
    b.positions.count = 4;
    b.tets = unit_tet;
    b.tet_count = 1;
    vox_body mesh = insert_mesh(grid, &a);
    ck_ok(vox_mesh_insert(grid, &b, &mesh));
    for (int round = 0; round < 3; ++round) { /* each is a move that no float shows */
        point[2] = nextafter(at, 0);
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_eq(contacts_of(grid).count, 0);
        point[2] = at;
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_eq(contacts_of(grid).count, 1);
        ck_assert_uint_eq(contacts_of(grid).interiors[0], 0);
        find_weights(grid);
        ck_assert_double_eq(constraints_of(grid).data[0].weights[4], 0);
        tet[2] = tet[5] = tet[8] = nextafter(at, 2 * at); /* the tet moves away from the point */
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_eq(contacts_of(grid).count, 0);
        tet[2] = tet[5] = tet[8] = at;
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_eq(contacts_of(grid).count, 1);
    }
    vox_grid_destroy(grid);
}
END_TEST

/* ---- against floats -------------------------------------------------------------------------------------
 */

START_TEST(doubles_of_floats_are_those_floats) {
    state = 3;
    for (int scene = 0; scene < 12; ++scene) {
        uint64_t hash[2][3] = {{0}};
        solid solids[2];
        for (int m = 0; m < 2; ++m) {
            solids[m] = make_solid(scene % 3 == 2 ? 9 : 4);
            place(&solids[m], &(kind){"", 1, 0, scene % 2 ? 0.25 : 0, scene % 2}, 0.3 * m, 0.4 * m, 0.2 * m);
        }
        for (int format = 0; format < 2; ++format)
            for (uint32_t workers = 1; workers <= 3; ++workers) {
                vox_grid* grid = new_grid(workers);
                for (int m = 0; m < 2; ++m) {
                    const vox_format f = format ? VOX_FORMAT_DOUBLE : VOX_FORMAT_FLOAT;
                    if (!format)
                        write_solid(&solids[m], f, 12);
                    else
                        write_solid(&solids[m], f, workers == 2 ? 40 : 24);
                    (void)insert_self(grid, &solids[m]);
                }
                hash[format][workers - 1] = hash_of_step(grid);
                ck_assert_uint_gt(contacts_of(grid).count, 0);
                vox_grid_destroy(grid);
            }
        for (int i = 0; i < 6; ++i) ck_assert_uint_eq(hash[i / 3][i % 3], hash[0][0]);
        for (int m = 0; m < 2; ++m) free_solid(&solids[m]);
    }
}
END_TEST

/* Large enough for the winding numbers of its surface to matter; folded, so that it does meet itself. Far
 * away the same body is moved by what doubles hold exactly, floats not at all. */
START_TEST(self_contact_of_large_bodies) {
    static const double offsets[] = {0, 0x1p30};
    uint64_t hashes[3] = {0};
    uint64_t count = 0;
    for (int i = 0; i < 3; ++i) {
        solid s = make_solid(12);
        for (uint32_t v = 0; v < s.vertex_count; ++v) {
            double* p = s.positions + 3 * v;
            if (p[2] > 8) p[0] += p[2] - 8;             /* sheared ... */
            if (p[2] > 11) p[2] = 11 - 4 * (p[2] - 11); /* ... and its top pushed down into it */
            for (int a = 0; a < 3; ++a) p[a] += offsets[i == 2];
        }
        write_solid(&s, i == 0 ? VOX_FORMAT_FLOAT : VOX_FORMAT_DOUBLE, i == 0 ? 12 : 24);
        vox_grid* grid = new_grid(1);
        (void)insert_self(grid, &s);
        hashes[i] = hash_of_step(grid);
        count = contacts_of(grid).count;
        ck_assert_uint_gt(count, 50);
        vox_grid_destroy(grid);
        free_solid(&s);
    }
    ck_assert_uint_eq(hashes[1], hashes[0]);
    ck_assert_uint_eq(hashes[2], hashes[0]);
}
END_TEST

/* The same of doubles that are no floats, in both engines: near zero, and where floats are coarse. */
START_TEST(engines_agree_on_large_bodies) {
    static const kind places[] = {
        {"", 1.0 / 3, 0, 0.05, 0}, {"", 1.0 / 3, 30, 0.05, 0}, {"", 1e-3, 1e7, 0.05, 0}};
    state = 7;
    for (int i = 0; i < 6; ++i) {
        solid s = make_solid(11);
        for (uint32_t v = 0; v < s.vertex_count && i % 2; ++v) {
            double* p = s.positions + 3 * v;
            if (p[2] > 9) p[2] = 9 - 3 * (p[2] - 9); /* its top pushed down into it */
        }
        place(&s, &places[i / 2], 0, 0, 0);
        write_solid(&s, VOX_FORMAT_DOUBLE, 24);
        uint64_t hashes[2], contacts = 0;
        for (int e = 0; e < 2; ++e) {
            suite_engine = e ? ENGINE_FAST : ENGINE_REFERENCE;
            vox_grid* grid = new_grid(1);
            (void)insert_self(grid, &s);
            hashes[e] = hash_of_step(grid);
            contacts = contacts_of(grid).count;
            vox_grid_destroy(grid);
        }
        ck_assert_uint_eq(hashes[0], hashes[1]);
        if (i % 2)
            ck_assert_uint_gt(contacts, 100);
        else
            ck_assert_uint_eq(contacts, 0);
        free_solid(&s);
    }
}
END_TEST

/* ---- what does not fit -----------------------------------------------------------------------------------
 */

START_TEST(limits) {
    static const double refused[] = {1e300, -1e39, 0x1.ffffffp127, INFINITY, -INFINITY, NAN};
    solid a = make_solid(2), b = make_solid(2);
    for (int far = 0; far < 2; ++far) { /* near zero, and where floats are taken around another point */
        for (uint32_t i = 0; i < 3 * a.vertex_count; ++i) {
            a.positions[i] += far * 1e6;
            b.positions[i] += far * 1e6;
        }
        write_solid(&a, VOX_FORMAT_DOUBLE, 24);
        write_solid(&b, VOX_FORMAT_DOUBLE, far ? 24 : 32);
        vox_grid* grid = new_grid(1);
        const vox_body other = insert(grid, &a, 0), mesh = insert(grid, &b, 0);
        const uint64_t hash = hash_of_step(grid);
        char text[64];
        snprintf(text, sizeof text, "body %u (slot 1, user data 0), vertex 7: position (", mesh);
        for (size_t i = 0; i < sizeof refused / sizeof *refused; ++i) {
            const double kept = b.positions[3 * 7 + 1];
            memcpy(b.bytes + 7 * b.stride + 8, &refused[i], sizeof(double));
            ck_fails(vox_grid_step(grid), isfinite(refused[i]) ? VOX_ERROR_LIMIT : VOX_ERROR_NON_FINITE,
                     text);
            if (isfinite(refused[i])) ck_assert_ptr_nonnull(strstr(vox_last_error(), "2^128 - 2^103"));
            ck_assert_uint_eq(contacts_of(grid).count, 0);
            memcpy(b.bytes + 7 * b.stride + 8, &kept, sizeof(double));
            ck_assert_uint_eq(hash_of_step(grid), hash);
        }
        /* The largest that fit, both ways from the rest. */
        solid solids[2] = {a, b};
        const vox_body ids[2] = {other, mesh};
        for (int sign = -1; sign <= 1; sign += 2) {
            const double kept = b.positions[3 * 7 + 1];
            b.positions[3 * 7 + 1] = sign * nextafter(0x1.ffffffp127, 0);
            write_solid(&b, VOX_FORMAT_DOUBLE, b.stride);
            ck_ok(bind_array(grid, mesh, b.bytes, b.format, b.stride, 0));
            ck_ok(vox_grid_step(grid));
            solids[1] = b;
            (void)check_contacts(grid, solids, 2, ids, 0);
            b.positions[3 * 7 + 1] = kept;
            write_solid(&b, VOX_FORMAT_DOUBLE, b.stride);
            ck_ok(bind_array(grid, mesh, b.bytes, b.format, b.stride, 0));
        }
        vox_grid_destroy(grid);
    }
    free_solid(&a);
    free_solid(&b);
}
END_TEST

/* ---- the steady state, and the cell size ------------------------------------------------------------------
 */

START_TEST(steady_state_holds_the_same_memory) {
    solid a = make_solid(6), b = make_solid(6);
    state = 6;
    place(&a, &kinds[0], 0, 0, 0);
    place(&b, &kinds[0], 0.5, 0.5, 0.5);
    write_solid(&a, VOX_FORMAT_DOUBLE, 24);
    write_solid(&b, VOX_FORMAT_DOUBLE, 24);
    vox_grid* grid = new_grid(1);
    (void)insert_self(grid, &a);
    (void)insert(grid, &b, 0);
    grid_counts before = counters_of(grid), after = before;
    for (int step = 0; step < 12; ++step) {
        if (step == 3) before = counters_of(grid);
        for (uint32_t v = 0; v < b.vertex_count; ++v) ((double*)(void*)b.bytes)[3 * v] += 1e-9;
        (void)hash_of_step(grid);
    }
    after = counters_of(grid);
    ck_assert_uint_eq(after.bytes, before.bytes);
    vox_grid_destroy(grid);
    free_solid(&a);
    free_solid(&b);
}
END_TEST

START_TEST(suggested_cell_size) {
    solid s = make_solid(4);
    vox_cell_size_result out[3];
    vox_geometry measured[3];
    for (int i = 0; i < 3; ++i) {
        if (i == 2)
            for (uint32_t v = 0; v < 3 * s.vertex_count; ++v)
                s.positions[v] += 0x1p40; /* no float is there */
        write_solid(&s, i == 0 ? VOX_FORMAT_FLOAT : VOX_FORMAT_DOUBLE, i == 0 ? 12 : 24);
        const vox_mesh_desc desc = solid_desc(&s);
        out[i].struct_size = sizeof out[i];
        ck_ok(vox_suggest_cell_size(NULL, &desc, 1, &out[i]));
        ck_assert_double_eq(out[i].cell_size, out[0].cell_size);
        measured[i].struct_size = sizeof measured[i];
        ck_ok(vox_measure_geometry(&desc, 1, &measured[i]));
        ck_assert_double_eq(measured[i].mean_volume, measured[0].mean_volume);
        ck_assert_double_eq(measured[i].bounds_max[1], 4 + (i == 2 ? 0x1p40 : 0));
    }
    s.positions[4] = 1e200;
    write_solid(&s, VOX_FORMAT_DOUBLE, 24);
    const vox_mesh_desc desc = solid_desc(&s);
    ck_fails(vox_suggest_cell_size(NULL, &desc, 1, &out[0]), VOX_ERROR_LIMIT,
             "mesh 0 (user data 0), vertex 1");
    free_solid(&s);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, floats_and_doubles_in_one_grid, less_than_a_float_apart, limits,
                   steady_state_holds_the_same_memory);
}

static void add_long_tests(TCase* tests) {
    tcase_add_each(tests, exact_for_the_doubles_given, doubles_of_floats_are_those_floats,
                   self_contact_of_large_bodies);
}

SUITE(mesh_doubles) {
    add_for_each_engine(suite, add_tests);
    add_tagged_for_each_engine(suite, add_long_tests, "long");
    TCase* others = add_case(suite, "both engines, or none");
    tcase_add_test(others, suggested_cell_size);
    TCase* long_tests = add_tagged_case(suite, "long", "long");
    tcase_add_test(long_tests, engines_agree_on_large_bodies);
}
