/* Penetrations as a whole: arguments, what the flag does, how long views live, and what they do not depend
 * on. */
#include <stddef.h>

#include "support/depth_checks.h"

/* Bodies that meet in many ways: stacked, crossing, one inside another, coincident, and one with itself. */
enum { pile_size = 7 };
typedef struct pile {
    body bodies[pile_size];
    vox_body ids[pile_size];
} pile;

static pile make_pile(float scale) {
    pile made;
    made.bodies[0] = make_box(8, 0.25f, 0, 0, 0);
    made.bodies[1] = make_box(6, 0.2f, 0.31f, 0.42f, 1.83f);
    made.bodies[2] = make_box(3, 0.07f, 0.8f, 0.9f, 0.7f);
    made.bodies[3] = make_box(8, 0.25f, 0, 0, 0);
    made.bodies[4] = make_box(10, 0.3f, -0.4f, 0.6f, 0.5f);
    made.bodies[5] = make_box(5, 0.3f, 1.3f, -0.7f, 1.1f);
    made.bodies[6] = make_box(5, 0.3f, 1.1f, 1.2f, 1.6f);
    for (uint32_t v = 0; v < made.bodies[4].vertex_count; ++v) { /* flat, and folded through itself */
        float* p = made.bodies[4].positions + 3 * v;
        p[1] = 0.6f + 0.3f * (p[1] - 0.6f);
        p[2] += 0.8f * (float)fabs((double)p[0] - 1) + 0.13f * p[1];
        if (p[0] > 1.4f) p[0] = 2.8f - 0.9f * p[0];
    }
    for (int b = 0; b < pile_size; ++b)
        for (uint32_t i = 0; i < 3 * made.bodies[b].vertex_count; ++i) made.bodies[b].positions[i] *= scale;
    return made;
}

static void insert_pile(vox_grid* grid, pile* p) {
    for (int b = 0; b < pile_size; ++b) {
        vox_mesh_desc desc = body_desc(&p->bodies[b]);
        if (b == 4) desc.filter.flags = VOX_FILTER_SELF_COLLISION;
        ck_ok(vox_mesh_insert(grid, &desc, &p->ids[b]));
    }
}

static void free_pile(pile* p) {
    for (int b = 0; b < pile_size; ++b) free_body(&p->bodies[b]);
}

/* ---- arguments and life ----------------------------------------------------------------------- */

START_TEST(arguments) {
    vox_grid* grid = grid_of(NULL);
    vox_penetration_view view = {NULL, 7, 7, 7};
    ck_fails(vox_grid_penetrations(NULL, &view), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_penetrations(grid, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_view is null");
    ck_assert_uint_eq(view.count, 7);
    vox_grid_destroy(grid);
}
END_TEST

START_TEST(flag) {
    vox_grid_desc desc = vox_default_grid_desc();
    ck_assert_uint_eq(desc.flags & VOX_GRID_PENETRATIONS, VOX_GRID_PENETRATIONS);
    vox_grid* grid = NULL;
    desc.flags = 0x4000;
    ck_fails(vox_grid_create(&desc, &grid), VOX_ERROR_INVALID_ARGUMENT, "flags is 0x4000, of which 0x4000");
    desc.flags |= VOX_GRID_PENETRATIONS;
    ck_fails(vox_grid_create(&desc, &grid), VOX_ERROR_INVALID_ARGUMENT, "flags is 0x4001, of which 0x4000");

    /* Without it no penetrations, no work, less memory, and the same contacts. */
    pile p = make_pile(1);
    uint64_t hash[2], bytes[2];
    for (uint32_t flags = 0; flags < 2; ++flags) {
        desc = engine_desc();
        desc.flags = flags;
        grid = grid_of(&desc);
        insert_pile(grid, &p);
        ck_ok(vox_grid_step(grid));
        ck_ok(vox_grid_get_hash(grid, &hash[flags]));
        const grid_counts counters = counters_of(grid);
        grid_times profile;
        profile = times_of(grid);
        bytes[flags] = counters.bytes;
        if (flags == 0) {
            vox_penetration_view view = {NULL, 0, 0, 0};
            ck_fails(vox_grid_penetrations(grid, &view), VOX_ERROR_INVALID_STATE, "VOX_GRID_PENETRATIONS");
            ck_assert_uint_eq(counters.penetrations + counters.leaving_edges + counters.edge_tests, 0);
            ck_assert_uint_eq(counters.closest_searches + counters.closest_tests, 0);
            ck_assert_uint_eq(profile.depth_ns, 0);
        } else {
            check_penetrations(grid);
            ck_assert_uint_gt(counters.leaving_edges, 0);
            ck_assert_uint_gt(counters.edge_tests, counters.leaving_edges);
            ck_assert_uint_gt(counters.closest_searches, 0);
            ck_assert_uint_gt(counters.closest_tests, counters.closest_searches);
            ck_assert_uint_gt(profile.depth_ns, 0);
            ck_assert_uint_ge(profile.step_ns, profile.depth_ns);
        }
        vox_grid_destroy(grid);
    }
    ck_assert_uint_eq(hash[0], hash[1]);
    ck_assert_uint_lt(bytes[0], bytes[1]);
    free_pile(&p);
}
END_TEST

START_TEST(older_programs_have_none) {
    /* A desc from before the field was there. */
    vox_grid_desc desc = vox_default_grid_desc();
    desc.struct_size = (uint32_t)offsetof(vox_grid_desc, flags);
    vox_grid* grid = grid_of(&desc);
    vox_penetration_view view = {NULL, 0, 0, 0};
    ck_fails(vox_grid_penetrations(grid, &view), VOX_ERROR_INVALID_STATE, "VOX_GRID_PENETRATIONS");
    vox_grid_destroy(grid);
}
END_TEST

START_TEST(views_follow_the_grid) {
    const vox_grid_desc desc = engine_desc();
    vox_grid* grid = grid_of(&desc);
    pile p = make_pile(1);
    ck_assert_uint_eq(penetrations_of(grid).count, 0);
    insert_pile(grid, &p);
    ck_assert_uint_eq(penetrations_of(grid).count, 0);
    ck_ok(vox_grid_step(grid));
    check_penetrations(grid);
    const uint64_t count = penetrations_of(grid).count;
    ck_assert_uint_gt(count, 500);

    ck_ok(vox_grid_reserve(grid, 10, 1000000)); /* the same, elsewhere */
    check_penetrations(grid);
    ck_assert_uint_eq(penetrations_of(grid).count, count);
    ck_ok(vox_body_remove(grid, p.ids[2]));
    ck_assert_uint_eq(penetrations_of(grid).count, count);
    ck_ok(vox_grid_step(grid));
    check_penetrations(grid);
    ck_assert_uint_lt(penetrations_of(grid).count, count);

    const float x = p.bodies[1].positions[30];
    p.bodies[1].positions[30] = NAN;
    ck_fails(vox_grid_step(grid), VOX_ERROR_NON_FINITE, "not finite");
    ck_assert_uint_eq(penetrations_of(grid).count, 0);
    p.bodies[1].positions[30] = x;
    ck_ok(vox_grid_step(grid));
    check_penetrations(grid);
    ck_assert_uint_gt(penetrations_of(grid).count, 0);
    ck_ok(vox_grid_clear(grid));
    ck_assert_uint_eq(penetrations_of(grid).count, 0);
    vox_grid_destroy(grid);
    free_pile(&p);
}
END_TEST

START_TEST(no_contacts_no_work) {
    body one = make_box(6, 0.25f, 0, 0, 0), other = make_box(6, 0.25f, 1.51f, 0, 0); /* boxes nearly touch */
    const vox_grid_desc desc = engine_desc();
    vox_grid* grid = grid_of(&desc);
    const vox_mesh_desc a = body_desc(&one), b = body_desc(&other);
    vox_body mesh = insert_mesh(grid, &a);
    ck_ok(vox_mesh_insert(grid, &b, &mesh));
    ck_ok(vox_grid_step(grid));
    const grid_counts counters = counters_of(grid);
    ck_assert_uint_eq(
        counters.contacts + counters.penetrations + counters.leaving_edges + counters.edge_tests, 0);
    ck_assert_uint_eq(counters.closest_searches + counters.closest_tests, 0);
    vox_grid_destroy(grid);
    free_body(&one);
    free_body(&other);
}
END_TEST

/* ---- what they do not depend on --------------------------------------------------------------- */

/* All penetrations of the pile, copied. The caller frees. */
static vox_penetration* pile_penetrations(const vox_grid_desc* desc, pile* p, double cell_size,
                                          uint64_t* count) {
    vox_grid* grid = grid_of(desc);
    insert_pile(grid, p);
    ck_ok(vox_grid_set_cell_size(grid, cell_size));
    ck_ok(vox_grid_step(grid));
    check_penetrations(grid);
    const vox_penetration_view view = penetrations_of(grid);
    ck_assert_uint_eq(view.byte_stride, sizeof(vox_penetration));
    vox_penetration* copy = (vox_penetration*)malloc(sizeof *copy * view.count);
    memcpy(copy, view.data, sizeof *copy * view.count);
    *count = view.count;
    vox_grid_destroy(grid);
    return copy;
}

START_TEST(every_way_gives_the_same_bits) {
    pile p = make_pile(1);
    uint64_t expected_count = 0, count = 0;
    const vox_grid_desc plain = vox_default_grid_desc();
    vox_penetration* expected = pile_penetrations(&plain, &p, 0, &expected_count);
    uint64_t by_state[5] = {0, 0, 0, 0, 0};
    for (uint64_t i = 0; i < expected_count; ++i) ++by_state[expected[i].state];
    for (int state = 0; state < 5; ++state)
        ck_assert_msg(by_state[state] > 0, "state %d does not occur", state);

    const vox_reference_desc* const engines[] = {NULL, reference_with(0),
                                                 reference_with(VOX_REFERENCE_DENSE)};
    for (int engine = 0; engine < 3; ++engine)
        for (uint32_t workers = 1; workers <= 4; ++workers) {
            vox_grid_desc desc = vox_default_grid_desc();
            desc.reference = engines[engine];
            desc.worker_count = workers;
            vox_penetration* other = pile_penetrations(&desc, &p, workers == 1 ? 0 : 0.1 * workers, &count);
            ck_assert_uint_eq(count, expected_count);
            ck_assert_mem_eq(other, expected, sizeof *expected * count);
            free(other);
        }
    free(expected);
    free_pile(&p);
}
END_TEST

START_TEST(every_unit_gives_the_same_answer) {
    uint64_t expected_count = 0, count = 0;
    const vox_grid_desc desc = engine_desc();
    pile p = make_pile(1);
    vox_penetration* expected = pile_penetrations(&desc, &p, 0, &expected_count);
    free_pile(&p);
    /* Powers of two are exact. */
    for (int exponent = -40; exponent <= 60; exponent += 20) {
        const float scale = ldexpf(1, exponent);
        p = make_pile(scale);
        vox_penetration* other = pile_penetrations(&desc, &p, 0, &count);
        ck_assert_uint_eq(count, expected_count);
        for (uint64_t i = 0; i < count; ++i) {
            ck_assert(other[i].depth == expected[i].depth * scale);
            other[i].depth = expected[i].depth;
        }
        ck_assert_mem_eq(other, expected, sizeof *other * count);
        free(other);
        free_pile(&p);
    }
    /* For others coordinates are rounded, which moves vertices off surfaces they lie on: of bodies 1 and 0
     * none does. */
    const float scales[] = {0.001f, 1000, 1e6f};
    for (int k = 0; k < 3; ++k) {
        p = make_pile(scales[k]);
        vox_penetration* other = pile_penetrations(&desc, &p, 0, &count);
        uint64_t compared = 0;
        for (uint64_t i = 0; i < expected_count; ++i) {
            const vox_penetration* e = &expected[i];
            if (e->body_a != p.ids[1] || e->body_b != p.ids[0]) continue;
            uint64_t j = 0;
            while (j < count && (other[j].body_a != e->body_a || other[j].vertex != e->vertex ||
                                 other[j].body_b != e->body_b))
                ++j;
            ck_assert_uint_lt(j, count);
            ck_assert_int_eq(other[j].state, e->state);
            ck_assert(fabsf(other[j].depth / scales[k] - e->depth) < 1e-5f);
            ck_assert(degrees_between(direction_of(&other[j]), direction_of(e)) < 0.01);
            ++compared;
        }
        ck_assert_uint_gt(compared, 40);
        free(other);
        free_pile(&p);
    }
    free(expected);
}
END_TEST

START_TEST(nothing_is_stale) {
    /* A grid that is stepped through a motion, with pauses, and a fresh one at every frame. */
    const vox_grid_desc desc = engine_desc();
    pile p = make_pile(1);
    vox_grid* grid = grid_of(&desc);
    insert_pile(grid, &p);
    for (int frame = 0; frame < 12; ++frame) {
        if (frame % 3 != 2)
            for (uint32_t v = 0; v < p.bodies[1].vertex_count; ++v) p.bodies[1].positions[3 * v + 2] -= 0.03f;
        if (frame == 7)
            for (uint32_t v = 0; v < p.bodies[0].vertex_count; ++v) p.bodies[0].positions[3 * v] *= 1.1f;
        ck_ok(vox_grid_step(grid));
        check_penetrations(grid);
        uint64_t count = 0;
        vox_penetration* fresh = pile_penetrations(&desc, &p, 0, &count);
        const vox_penetration_view view = penetrations_of(grid);
        ck_assert_uint_eq(view.count, count);
        ck_assert_mem_eq(view.data, fresh, sizeof *fresh * count);
        free(fresh);
    }
    vox_grid_destroy(grid);
    free_pile(&p);
}
END_TEST

START_TEST(strides_and_copies) {
    pile p = make_pile(1);
    const vox_grid_desc desc = engine_desc();
    uint64_t expected_count = 0;
    vox_penetration* expected = pile_penetrations(&desc, &p, 0, &expected_count);
    vox_grid* grid = grid_of(&desc);
    float* strided[pile_size];
    for (int b = 0; b < pile_size; ++b) {
        const body* from = &p.bodies[b];
        strided[b] = (float*)malloc(sizeof(float) * 5 * from->vertex_count);
        for (uint32_t v = 0; v < from->vertex_count; ++v)
            for (int i = 0; i < 5; ++i)
                strided[b][5 * v + (uint32_t)i] = i < 3 ? from->positions[3 * v + (uint32_t)i] : NAN;
        vox_mesh_desc mesh = body_desc(from);
        mesh.positions.data = b % 2 ? NULL : strided[b]; /* some arrive later */
        mesh.positions.byte_stride = 5 * sizeof(float);
        mesh.flags = b % 2 ? 0u : VOX_MESH_COPY_POSITIONS;
        if (b == 4) mesh.filter.flags = VOX_FILTER_SELF_COLLISION;
        ck_ok(vox_mesh_insert(grid, &mesh, &p.ids[b]));
        if (b % 2) ck_ok(bind_array(grid, p.ids[b], strided[b], VOX_FORMAT_FLOAT, 5 * sizeof(float), 0));
    }
    ck_ok(vox_grid_step(grid));
    const vox_penetration_view view = penetrations_of(grid);
    ck_assert_uint_eq(view.count, expected_count);
    ck_assert_mem_eq(view.data, expected, sizeof *expected * expected_count);
    vox_grid_destroy(grid);
    for (int b = 0; b < pile_size; ++b) free(strided[b]);
    free(expected);
    free_pile(&p);
}
END_TEST

/* Below a flat face, depths are as exact as positions, so that small differences of them are, too. */
START_TEST(depths_in_double) {
    body one = make_box(8, 0.25f, 0, 0, 0), other = make_box(3, 0.2f, 0.31f, 0.42f, 1.83f);
    const double steps[] = {0, 1e-6, 1e-9};
    double before[16], top = 2, *positions = (double*)malloc(3 * sizeof(double) * other.vertex_count);
    for (int step = 0; step < 3; ++step) {
        const vox_grid_desc desc = engine_desc();
        vox_grid* grid = grid_of(&desc);
        vox_mesh_desc mesh = body_desc(&one);
        insert_mesh(grid, &mesh);
        for (uint32_t i = 0; i < 3 * other.vertex_count; ++i)
            positions[i] = (double)other.positions[i] + 1e-11 * (i % 7) - (i % 3 == 2 ? steps[step] : 0);
        mesh = body_desc(&other);
        mesh.positions.data = positions;
        mesh.positions.format = VOX_FORMAT_DOUBLE;
        const vox_body b = insert_mesh(grid, &mesh);
        ck_ok(vox_grid_step(grid));
        check_penetrations(grid);
        const vox_penetration_view view = penetrations_of(grid);
        const vox_depth_view depths = depths_of(grid);
        uint32_t inside = 0;
        for (uint64_t i = 0; i < view.count; ++i) {
            if (view.data[i].body_a != b) continue;
            const double depth = depths.data[i].depth;
            ck_assert_double_eq_tol(depth, top - positions[3 * view.data[i].vertex + 2], 4 * 0x1p-52 * top);
            ck_assert_double_eq_tol(depths.data[i].direction[2], 1, 0x1p-50);
            ck_assert_uint_lt(inside, 16);
            if (step > 0)
                ck_assert_double_eq_tol((depth - before[inside]) / steps[step], 1, 1e-15 / steps[step]);
            if (step == 0) before[inside] = depth;
            ++inside;
        }
        ck_assert_uint_eq(inside, 16);
        vox_grid_destroy(grid);
    }
    free(positions);
    free_body(&one);
    free_body(&other);
}
END_TEST

/* The same scene in doubles: the same bits where they are floats, and defined as far as doubles go. */
START_TEST(double_positions) {
    pile p = make_pile(1);
    const vox_grid_desc desc = engine_desc();
    uint64_t count = 0;
    vox_penetration* expected = pile_penetrations(&desc, &p, 0, &count);
    const double scales[] = {1, 0x1p100, 0x1p-60, 1e-75};
    for (int k = 0; k < 4; ++k) {
        vox_grid* grid = grid_of(&desc);
        double* positions[pile_size];
        for (int b = 0; b < pile_size; ++b) {
            const body* from = &p.bodies[b];
            positions[b] = (double*)malloc(sizeof(double) * 3 * from->vertex_count);
            for (uint32_t i = 0; i < 3 * from->vertex_count; ++i)
                positions[b][i] = scales[k] * (double)from->positions[i];
            vox_mesh_desc mesh = body_desc(from);
            mesh.positions.data = positions[b];
            mesh.positions.format = VOX_FORMAT_DOUBLE;
            mesh.filter.flags = b == 4 ? VOX_FILTER_SELF_COLLISION : 0u;
            ck_ok(vox_mesh_insert(grid, &mesh, &p.ids[b]));
        }
        ck_ok(vox_grid_step(grid));
        const vox_penetration_view view = penetrations_of(grid);
        if (k < 3) ck_assert_uint_eq(view.count, count);
        ck_assert_uint_gt(view.count, count / 2);
        for (uint64_t i = 0; i < view.count; ++i) {
            vox_penetration q = *penetration_at(view, i);
            ck_assert(q.depth >= 0 && isfinite(q.depth));
            ck_assert(fabs(norm(direction_of(&q)) - 1) < 1e-6);
            if (k >= 3) continue;
            ck_assert(q.depth == (float)(scales[k] * (double)expected[i].depth));
            q.depth = expected[i].depth;
            ck_assert_mem_eq(&q, &expected[i], sizeof q);
        }
        vox_grid_destroy(grid);
        for (int b = 0; b < pile_size; ++b) free(positions[b]);
    }
    free(expected);
    free_pile(&p);
}
END_TEST

/* Where areas and volumes are too small for doubles, contacts are still exact; the rest is defined. */
START_TEST(tiny_double_positions) {
    const vox_grid_desc desc = engine_desc();
    body box = make_box(1, 1, 0, 0, 0), other = make_box(1, 1, 0.25f, 0.3125f, 0.375f);
    for (double scale = 1e-60; scale > 1e-310; scale *= 1e-10) {
        double positions[2][24];
        vox_grid* grid = grid_of(&desc);
        for (int b = 0; b < 2; ++b) {
            const body* from = b == 0 ? &box : &other;
            for (int i = 0; i < 24; ++i) positions[b][i] = scale * (double)from->positions[i];
            vox_mesh_desc mesh = body_desc(from);
            mesh.positions.data = positions[b];
            mesh.positions.format = VOX_FORMAT_DOUBLE;
            insert_mesh(grid, &mesh);
        }
        ck_ok(vox_grid_step(grid));
        const vox_penetration_view view = penetrations_of(grid);
        ck_assert_uint_eq(view.count, 2);
        for (uint64_t i = 0; i < view.count; ++i) {
            const vox_penetration* q = penetration_at(view, i);
            ck_assert(q->depth >= 0 && isfinite(q->depth));
            ck_assert(fabs(norm(direction_of(q)) - 1) < 1e-6);
        }
        vox_grid_destroy(grid);
    }
    free_body(&box);
    free_body(&other);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, arguments, flag, older_programs_have_none, views_follow_the_grid,
                   no_contacts_no_work, every_unit_gives_the_same_answer, nothing_is_stale,
                   strides_and_copies, depths_in_double, double_positions, tiny_double_positions);
}

SUITE(penetrations) {
    add_for_each_engine(suite, add_tests);
    TCase* all = add_case(suite, "all engines");
    tcase_add_test(all, every_way_gives_the_same_bits);
}
