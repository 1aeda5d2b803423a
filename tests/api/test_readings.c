/* Readings of contacts against brute force, the same from every engine and any number of workers. */
#include "support/locators.h"
#include "support/reading_checks.h"

/* Two boxes as one body, the second moved. */
static body two_boxes(uint32_t n, float x, float y, float z) {
    body first = make_box(n, 1, 0, 0, 0), second = make_box(n, 1, x, y, z);
    body both = {NULL, NULL, 2 * first.vertex_count, 2 * first.tet_count};
    both.positions = (float*)malloc(6 * sizeof(float) * first.vertex_count);
    both.tets = (uint32_t*)malloc(8 * sizeof(uint32_t) * first.tet_count);
    memcpy(both.positions, first.positions, 3 * sizeof(float) * first.vertex_count);
    memcpy(both.positions + 3 * first.vertex_count, second.positions, 3 * sizeof(float) * first.vertex_count);
    memcpy(both.tets, first.tets, 4 * sizeof(uint32_t) * first.tet_count);
    for (uint32_t i = 0; i < 4 * first.tet_count; ++i)
        both.tets[4 * first.tet_count + i] = second.tets[i] + first.vertex_count;
    free_body(&first);
    free_body(&second);
    return both;
}

static void check_depths(const world* w) {
    vox_penetration_view penetrations;
    vox_reading_view readings;
    ck_ok(vox_grid_penetrations(w->grid, &penetrations));
    vox_contact_view contacts = contacts_of(w->grid);
    ck_ok(vox_grid_readings(w->grid, &readings));
    for (uint64_t i = 0, n = 0; i < readings.count; ++i) {
        while (n + 1 < penetrations.count && penetrations.data[n + 1].contact <= i) ++n;
        const vox_penetration* p = &penetrations.data[n];
        const vox_reading* r = &readings.data[i];
        ck_assert_uint_eq(p->vertex, contacts.data[i].vertex);
        ck_assert_uint_eq(p->body_b, contacts.data[i].body_b);
        ck_assert(r->known & VOX_READING_DEPTH);
        ck_assert_int_eq(r->state, p->state);
        ck_assert_mem_eq(&r->depth, &p->depth, sizeof r->depth);
        ck_assert_mem_eq(r->direction, p->direction, sizeof r->direction);
        /* Where the depth stage takes the closest point it is this one. */
        if (p->state == VOX_PENETRATION_ENCLOSED)
            if (r->known & VOX_READING_SURFACE)
                ck_assert_double_le(fabs((double)p->depth - r->distance), 1e-6 * (1 + r->distance));
    }
}

START_TEST(by_definition) {
    uint64_t random = 17, surfaces = 0, coincident = 0;
    for (int scene = 0; scene < 120; ++scene) {
        const int coarse = scene % 2;
        world w = random_world(&random, coarse);
        ck_ok(vox_grid_step(w.grid));
        surfaces += check_readings(&w, 0);
        check_depths(&w);
        /* The closest point is found by the same search. */
        vox_reading_view readings;
        ck_ok(vox_grid_readings(w.grid, &readings));
        vox_contact_view contacts = contacts_of(w.grid);
        for (uint64_t i = 0; i < readings.count; ++i) coincident += readings.data[i].distance == 0;
        for (int b = 0; b < w.count; ++b) { /* one mesh at a time can be asked alone: by its category */
            vox_filter filter = plain_filter();
            filter.category = (uint64_t)1 << b;
            ck_ok(vox_body_set_filter(w.grid, w.models[b].mesh, &filter));
        }
        vox_locator* locator = take_locator(w.grid);
        for (uint64_t i = 0; i < readings.count; i += 3) {
            const vox_reading* r = &readings.data[i];
            if (!(r->known & VOX_READING_SURFACE)) continue;
            const vox_query_desc desc =
                query_of((uint64_t)1 << index_of(&w, contacts.data[i].body_b), VOX_NULL_BODY);
            const vox_closest_hit hit = closest_to(locator, r->position, &desc);
            const double distance = fabs(hit.distance);
            ck_assert_uint_eq(hit.body, contacts.data[i].body_b);
            ck_assert_double_le(fabs(distance - r->distance), 1e-15 + 1e-12 * distance);
        }
        vox_locator_release(locator);
        end_world(&w);
    }
    ck_assert_uint_gt(surfaces, 2000);
    ck_assert_uint_gt(coincident, 100);
}
END_TEST

/* Boxes on a lattice: distances are exact, and so is which triangle is the lowest of those equally far. */
START_TEST(ties) {
    uint64_t random = 5, surfaces = 0;
    for (int scene = 0; scene < 60; ++scene) {
        world w;
        memset(&w, 0, sizeof w);
        w.count = 3;
        for (int b = 0; b < w.count; ++b) {
            float at[3];
            for (int axis = 0; axis < 3; ++axis) at[axis] = 0.5f * (float)random_below(&random, 5);
            w.models[b].shape = make_box(2, 1, at[0], at[1], at[2]);
            complete(&w.models[b]);
        }
        w.grid = new_grid(suite_engine, 0, 1);
        insert(&w, w.grid);
        ck_ok(vox_grid_step(w.grid));
        surfaces += check_readings(&w, 1);
        end_world(&w);
    }
    ck_assert_uint_gt(surfaces, 1000);
}
END_TEST

/* A body of two boxes in each other: the fold that a vertex has entered is the other box. */
START_TEST(self_contact) {
    uint64_t random = 23, surfaces = 0;
    for (int scene = 0; scene < 20; ++scene) {
        world w;
        memset(&w, 0, sizeof w);
        w.count = 1;
        model* m = &w.models[0];
        const uint32_t n = 2 + random_below(&random, 2);
        const float x = random_float(&random, 0.2f, 0.9f) * (float)n, y = random_float(&random, -0.7f, 0.7f),
                    z = random_float(&random, -0.7f, 0.7f);
        m->shape = two_boxes(n, x, y, z);
        m->tets_a_part = m->shape.tet_count / 2;
        m->self = 1;
        complete(m);
        w.grid = new_grid(suite_engine, VOX_GRID_PENETRATIONS, 1);
        insert(&w, w.grid);
        ck_ok(vox_grid_step(w.grid));
        surfaces += check_readings(&w, 0);
        check_depths(&w);
        end_world(&w);
    }
    ck_assert_uint_gt(surfaces, 200);
}
END_TEST

/* A fold of one piece: a vertex is never answered by a triangle of which it is a corner. */
START_TEST(self_contact_of_one_piece) {
    world w;
    memset(&w, 0, sizeof w);
    w.count = 1;
    model* m = &w.models[0];
    m->shape = make_box(6, 1, 0, 0, 0);
    uint64_t found = 0;
    for (uint32_t v = 0; v < m->shape.vertex_count; ++v) { /* the upper half folded down into the lower */
        float* p = m->shape.positions + 3 * v;
        if (p[2] > 3) p[2] = 6.3f - p[2];
        p[0] += 0.01f * p[1];
    }
    m->self = 1;
    complete(m);
    w.grid = new_grid(suite_engine, VOX_GRID_PENETRATIONS, 1);
    insert(&w, w.grid);
    ck_ok(vox_grid_step(w.grid));
    ck_ok(vox_grid_prepare_readings(w.grid));
    vox_reading_view readings;
    vox_contact_view contacts = contacts_of(w.grid);
    ck_ok(vox_grid_readings(w.grid, &readings));
    for (uint64_t i = 0; i < readings.count; ++i) {
        const vox_reading* r = &readings.data[i];
        if (!(r->known & VOX_READING_SURFACE)) continue;
        ++found;
        for (int c = 0; c < 3; ++c) ck_assert_uint_ne(r->triangle[c], contacts.data[i].vertex);
        const double* corner[3];
        for (int c = 0; c < 3; ++c) corner[c] = m->positions + 3 * r->triangle[c];
        const double squared = squared_to_triangle(r->position, corner[0], corner[1], corner[2]);
        ck_assert_double_eq_tol(r->distance, sqrt(squared), 1e-12);
    }
    ck_assert_uint_gt(found, 100);
    check_depths(&w);
    end_world(&w);
}
END_TEST

/* A transform counts, to the last bit, and a body scaled to nearly nothing or nearly everything keeps its
 * normals. */
START_TEST(transform_and_scale) {
    static const double scales[] = {1, 1e-60, 1e-30, 1e30};
    for (int s = 0; s < 4; ++s) {
        const double scale = scales[s];
        world w;
        memset(&w, 0, sizeof w);
        w.count = 2;
        for (int b = 0; b < 2; ++b)
            w.models[b].shape = make_box(2, 1, (float)b, 0.3f * (float)b, 0.2f * (float)b);
        w.grid = new_grid(suite_engine, VOX_GRID_PENETRATIONS, 1);
        for (int b = 0; b < 2; ++b) {
            model* m = &w.models[b];
            const double c = 0.8 * scale, d = 0.6 * scale;
            const double matrix[12] = {c,           -d, 0, b * 0.1 * scale, d,          c, 0,
                                       0.2 * scale, 0,  0, scale,           0.3 * scale};
            complete(m);
            for (uint32_t v = 0; v < m->shape.vertex_count; ++v) {
                double x[3];
                for (int axis = 0; axis < 3; ++axis) x[axis] = m->positions[3 * v + (uint32_t)axis];
                for (int axis = 0; axis < 3; ++axis) {
                    const double* row = matrix + 4 * axis;
                    m->positions[3 * v + (uint32_t)axis] =
                        ((row[0] * x[0] + row[1] * x[1]) + row[2] * x[2]) + row[3];
                }
            }
            const vox_mesh_desc desc = desc_of(m, b);
            ck_ok(vox_mesh_insert(w.grid, &desc, &m->mesh));
            ck_ok(vox_body_set_transform(w.grid, m->mesh, matrix));
        }
        ck_ok(vox_grid_step(w.grid));
        ck_ok(vox_grid_prepare_readings(w.grid));
        vox_reading_view readings;
        ck_ok(vox_grid_readings(w.grid, &readings));
        vox_contact_view contacts = contacts_of(w.grid);
        ck_assert_uint_gt(readings.count, 4);
        for (uint64_t i = 0; i < readings.count; ++i) {
            const vox_reading* r = &readings.data[i];
            const model* a = &w.models[index_of(&w, contacts.data[i].body_a)];
            ck_assert_mem_eq(r->position, a->positions + 3 * contacts.data[i].vertex, sizeof r->position);
            /* A box: the way to its surface is its normal. */
            ck_assert_double_eq_tol(dot(r->normal, r->normal), 1, 1e-9);
            for (int axis = 0; axis < 3; ++axis)
                ck_assert_double_le(
                    fabs(r->surface_position[axis] - r->position[axis] - r->distance * r->normal[axis]),
                    1e-9 * scale);
        }
        end_world(&w);
    }
}
END_TEST

/* ---- the same from everyone ---- */

START_TEST(engines_and_workers) {
    uint64_t random = 99;
    for (int scene = 0; scene < 12; ++scene) {
        world w = random_world(&random, scene % 2);
        vox_reading_view expected, found;
        ck_ok(vox_grid_step(w.grid));
        ck_ok(vox_grid_prepare_readings(w.grid));
        ck_ok(vox_grid_readings(w.grid, &expected));
        for (uint32_t workers = 1; workers <= 8; ++workers) {
            vox_grid* other =
                new_grid(workers % 2 ? ENGINE_FAST : ENGINE_REFERENCE, VOX_GRID_PENETRATIONS, workers);
            insert(&w, other);
            ck_ok(vox_grid_step(other));
            ck_ok(vox_grid_prepare_readings(other));
            ck_ok(vox_grid_readings(other, &found));
            ck_assert_uint_eq(found.count, expected.count);
            ck_assert_mem_eq(found.data, expected.data, expected.count * sizeof *expected.data);
            vox_grid_destroy(other);
        }
        end_world(&w);
    }
}
END_TEST

/* Enough bodies that workers share them. */
START_TEST(many_bodies_and_workers) {
    enum { n = 27 };
    body bodies[n];
    vox_reading* expected = NULL;
    uint64_t count = 0;
    for (int b = 0; b < n; ++b)
        bodies[b] = make_box(4, 1, 3.9f * (float)(b % 3), 3.8f * (float)(b / 3 % 3), 3.7f * (float)(b / 9));
    for (uint32_t workers = 1; workers <= 8; workers += workers < 4 ? 1 : 4) {
        vox_grid* grid = new_grid(suite_engine, VOX_GRID_PENETRATIONS, workers);
        for (int b = 0; b < n; ++b) {
            const vox_mesh_desc desc = body_desc(&bodies[b]);
            insert_mesh(grid, &desc);
        }
        vox_reading_view view;
        ck_ok(vox_grid_step(grid));
        ck_ok(vox_grid_prepare_readings(grid));
        ck_ok(vox_grid_readings(grid, &view));
        if (!expected) {
            count = view.count;
            ck_assert_uint_gt(count, 1024);
            expected = (vox_reading*)malloc(count * sizeof *expected);
            memcpy(expected, view.data, count * sizeof *expected);
        }
        ck_assert_uint_eq(view.count, count);
        ck_assert_mem_eq(view.data, expected, count * sizeof *expected);
        vox_grid_destroy(grid);
    }
    free(expected);
    for (int b = 0; b < n; ++b) free_body(&bodies[b]);
}
END_TEST

/* A double of this kind: usual; of any size; a few units of the least denormal. */
static double odd_double(uint64_t* random, int kind) {
    const double mantissa = random_symmetric(random);
    if (kind == 0) return mantissa;
    if (kind == 1) return ldexp(mantissa, (int)(1100 * random_unit(random)) - 1000);
    return ldexp(floor(16 * mantissa), -1074);
}

/* A vertex in a tetrahedron whose corners are as odd as doubles can be. */
START_TEST(odd_bodies) {
    uint64_t random = 11, surfaces = 0;
    for (int scene = 0; scene < 6000; ++scene) {
        double corners[12], inner[3] = {0, 0, 0};
        for (int i = 0; i < 12; ++i) {
            corners[i] = odd_double(&random, (scene + (scene % 2 ? i : 0)) % 3);
            if (fabs(corners[i]) > 1e38) corners[i] = 1e38;
        }
        for (int i = 0; i < 12; ++i) inner[i % 3] += corners[i] / 4;
        vox_grid* grid = new_grid(suite_engine, 0, 1);
        vox_mesh_desc desc = vox_mesh_desc_floats(NULL, 4, unit_tet, 1);
        desc.positions.data = corners;
        desc.positions.format = VOX_FORMAT_DOUBLE;
        insert_mesh(grid, &desc);
        desc.positions.data = inner;
        desc.positions.count = 1;
        desc.tet_count = 0;
        insert_mesh(grid, &desc);
        ck_ok(vox_grid_step(grid));
        ck_ok(vox_grid_prepare_readings(grid));
        vox_reading_view readings;
        ck_ok(vox_grid_readings(grid, &readings));
        for (uint64_t i = 0; i < readings.count; ++i) {
            const vox_reading* r = &readings.data[i];
            double sum = 0;
            if (!(r->known & VOX_READING_SURFACE)) continue;
            for (int k = 0; k < 3; ++k) {
                ck_assert_double_ge(r->barycentric[k], 0);
                ck_assert_double_le(r->barycentric[k], 1);
                sum += r->barycentric[k];
                const double bound = r->distance + 1e-6 * fabs(r->position[k]) + 1e-150;
                ck_assert_double_le(fabs(r->surface_position[k] - r->position[k]), bound);
            }
            ck_assert_double_eq_tol(sum, 1, 1e-15);
            ++surfaces;
        }
        vox_grid_destroy(grid);
    }
    ck_assert_uint_gt(surfaces, 3000);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, odd_bodies, by_definition, ties, self_contact, self_contact_of_one_piece,
                   transform_and_scale, many_bodies_and_workers);
}

SUITE(readings) {
    add_for_each_engine(suite, add_tests);
    TCase* both = add_case(suite, "both engines");
    tcase_add_test(both, engines_and_workers);
}
