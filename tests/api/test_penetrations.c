/* Depths as a whole: what the flag does, and what they do not depend on. */
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

/* ---- the flag ----------------------------------------------------------------------------------- */

/* Without it no constraints, no work, less memory, and the same contacts. */
START_TEST(flag) {
    pile p = make_pile(1);
    uint64_t hash[2], bytes[2];
    ck_assert_uint_eq(vox_default_grid_desc().flags, 0);
    for (uint32_t flags = 0; flags < 2; ++flags) {
        vox_grid_desc desc = engine_desc();
        desc.flags = flags;
        vox_grid* grid = grid_of(&desc);
        insert_pile(grid, &p);
        hash[flags] = hash_of_step(grid);
        const grid_counts counters = counters_of(grid);
        const grid_times times = times_of(grid);
        bytes[flags] = counters.bytes;
        if (flags == 0) {
            vox_constraint_view view;
            ck_fails(vox_grid_get_constraints(grid, &view), VOX_ERROR_INVALID_STATE, "VOX_GRID_CONSTRAINTS");
            ck_assert_uint_eq(counters.constraints + counters.penetrations, 0);
            ck_assert_uint_eq(counters.leaving_edges + counters.edge_tests, 0);
            ck_assert_uint_eq(counters.closest_searches + counters.closest_tests, 0);
            ck_assert_uint_eq(times.depth_ns + times.constraints_ns, 0);
        } else {
            ck_assert_uint_eq(counters.penetrations, check_depths(grid).count);
            ck_assert_uint_gt(counters.leaving_edges, 0);
            ck_assert_uint_gt(counters.edge_tests, counters.leaving_edges);
            ck_assert_uint_gt(counters.closest_searches, 0);
            ck_assert_uint_gt(counters.closest_tests, counters.closest_searches);
            ck_assert_uint_gt(times.depth_ns, 0);
            ck_assert_uint_gt(times.constraints_ns, 0);
            ck_assert_uint_ge(times.step_ns, times.depth_ns + times.constraints_ns);
        }
        vox_grid_destroy(grid);
    }
    ck_assert_uint_eq(hash[0], hash[1]);
    ck_assert_uint_lt(bytes[0], bytes[1]);
    free_pile(&p);
}
END_TEST

START_TEST(no_contacts_no_work) {
    body one = make_box(6, 0.25f, 0, 0, 0), other = make_box(6, 0.25f, 1.51f, 0, 0); /* boxes nearly touch */
    vox_grid* grid = depth_grid();
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

/* All constraints of the pile. */
static kept_constraints constraints_of_pile(const vox_grid_desc* desc, pile* p, double cell_size) {
    vox_grid* grid = grid_of(desc);
    insert_pile(grid, p);
    ck_ok(vox_grid_set_cell_size(grid, cell_size));
    ck_ok(vox_grid_step(grid));
    check_depths(grid);
    const kept_constraints kept = keep_constraints(grid);
    vox_grid_destroy(grid);
    return kept;
}

static void check_same(kept_constraints found, kept_constraints expected) {
    ck_assert_uint_eq(found.count, expected.count);
    ck_assert_mem_eq(found.data, expected.data, found.count * sizeof *found.data);
}

START_TEST(every_way_gives_the_same_bits) {
    pile p = make_pile(1);
    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags = VOX_GRID_CONSTRAINTS;
    const kept_constraints expected = constraints_of_pile(&desc, &p, 0);
    uint64_t by_state[7] = {0};
    for (uint64_t i = 0; i < expected.count; ++i) ++by_state[expected.data[i].state];
    for (int state = VOX_DEPTH_SURFACE; state <= VOX_DEPTH_TOUCHING; ++state)
        ck_assert_msg(by_state[state] > 0, "state %d does not occur", state);

    const vox_reference_desc* const engines[] = {NULL, reference_with(0),
                                                 reference_with(VOX_REFERENCE_DENSE)};
    for (int engine = 0; engine < 3; ++engine)
        for (uint32_t workers = 1; workers <= 4; ++workers) {
            desc.reference = engines[engine];
            desc.worker_count = workers;
            kept_constraints other = constraints_of_pile(&desc, &p, workers == 1 ? 0 : 0.1 * workers);
            check_same(other, expected);
            free(other.data);
        }
    free(expected.data);
    free_pile(&p);
}
END_TEST

/* What has a length is `scale` times as long, where that is a power of two; all else is the same. */
static void unscale(kept_constraints c, double scale) {
    for (uint64_t i = 0; i < c.count; ++i) {
        c.data[i].gap /= scale;
        c.data[i].offset /= scale;
        for (int k = 0; k < 3; ++k) c.data[i].position[k] /= scale;
    }
}

START_TEST(every_unit_gives_the_same_answer) {
    const vox_grid_desc desc = depth_desc();
    pile p = make_pile(1);
    const kept_constraints expected = constraints_of_pile(&desc, &p, 0);
    free_pile(&p);
    for (int exponent = -40; exponent <= 60; exponent += 20) {
        const float scale = ldexpf(1, exponent);
        p = make_pile(scale);
        kept_constraints other = constraints_of_pile(&desc, &p, 0);
        unscale(other, (double)scale);
        check_same(other, expected);
        free(other.data);
        free_pile(&p);
    }
    /* For others coordinates are rounded, which moves vertices off surfaces they lie on: of bodies 1 and 0
     * none does. */
    const float scales[] = {0.001f, 1000, 1e6f};
    for (int k = 0; k < 3; ++k) {
        p = make_pile(scales[k]);
        kept_constraints other = constraints_of_pile(&desc, &p, 0);
        uint64_t compared = 0;
        for (uint64_t i = 0; i < expected.count; ++i) {
            const vox_constraint *e = &expected.data[i], *c = other.data;
            if (e->body_a != p.ids[1] || e->body_b != p.ids[0]) continue;
            while (c < other.data + other.count &&
                   (c->body_a != e->body_a || c->body_b != e->body_b || c->vertices[0] != e->vertices[0]))
                ++c;
            ck_assert_ptr_ne(c, other.data + other.count);
            ck_assert_int_eq(c->state, e->state);
            ck_assert(fabs(c->gap / (double)scales[k] - e->gap) < 1e-5);
            ck_assert(degrees_between(normal_of(c), normal_of(e)) < 0.01);
            ++compared;
        }
        ck_assert_uint_gt(compared, 40);
        free(other.data);
        free_pile(&p);
    }
    free(expected.data);
}
END_TEST

START_TEST(nothing_is_stale) {
    /* A grid that is stepped through a motion, with pauses, and a fresh one at every frame. */
    const vox_grid_desc desc = depth_desc();
    pile p = make_pile(1);
    vox_grid* grid = grid_of(&desc);
    insert_pile(grid, &p);
    for (int frame = 0; frame < 12; ++frame) {
        if (frame % 3 != 2)
            for (uint32_t v = 0; v < p.bodies[1].vertex_count; ++v) p.bodies[1].positions[3 * v + 2] -= 0.03f;
        if (frame == 7)
            for (uint32_t v = 0; v < p.bodies[0].vertex_count; ++v) p.bodies[0].positions[3 * v] *= 1.1f;
        ck_ok(vox_grid_step(grid));
        check_depths(grid);
        kept_constraints fresh = constraints_of_pile(&desc, &p, 0);
        same_constraints(grid, &fresh);
        free(fresh.data);
    }
    vox_grid_destroy(grid);
    free_pile(&p);
}
END_TEST

START_TEST(strides_and_copies) {
    pile p = make_pile(1);
    const vox_grid_desc desc = depth_desc();
    const kept_constraints expected = constraints_of_pile(&desc, &p, 0);
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
    same_constraints(grid, &expected);
    vox_grid_destroy(grid);
    for (int b = 0; b < pile_size; ++b) free(strided[b]);
    free(expected.data);
    free_pile(&p);
}
END_TEST

/* Below a flat face, depths are as exact as positions, so that small differences of them are, too. */
START_TEST(depths_in_double) {
    body one = make_box(8, 0.25f, 0, 0, 0), other = make_box(3, 0.2f, 0.31f, 0.42f, 1.83f);
    const double steps[] = {0, 1e-6, 1e-9};
    double before[16], top = 2, *positions = (double*)malloc(3 * sizeof(double) * other.vertex_count);
    for (int step = 0; step < 3; ++step) {
        vox_grid* grid = depth_grid();
        vox_mesh_desc mesh = body_desc(&one);
        insert_mesh(grid, &mesh);
        for (uint32_t i = 0; i < 3 * other.vertex_count; ++i)
            positions[i] = (double)other.positions[i] + 1e-11 * (i % 7) - (i % 3 == 2 ? steps[step] : 0);
        mesh = body_desc(&other);
        mesh.positions.data = positions;
        mesh.positions.format = VOX_FORMAT_DOUBLE;
        const vox_body b = insert_mesh(grid, &mesh);
        ck_ok(vox_grid_step(grid));
        const vox_constraint_view view = check_depths(grid);
        uint32_t inside = 0;
        for (uint64_t i = 0; i < view.count; ++i) {
            const vox_constraint* c = &view.data[i];
            if (c->body_a != b) continue;
            const double depth = depth_of(c);
            ck_assert_double_eq_tol(depth, top - positions[3 * c->vertices[0] + 2], 4 * 0x1p-52 * top);
            ck_assert_double_eq_tol(c->normal[2], 1, 0x1p-50);
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
    const vox_grid_desc desc = depth_desc();
    const kept_constraints expected = constraints_of_pile(&desc, &p, 0);
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
        check_depths(grid);
        kept_constraints found = keep_constraints(grid);
        unscale(found, scales[k]);
        if (k < 3) check_same(found, expected);
        ck_assert_uint_gt(found.count, expected.count / 2);
        free(found.data);
        vox_grid_destroy(grid);
        for (int b = 0; b < pile_size; ++b) free(positions[b]);
    }
    free(expected.data);
    free_pile(&p);
}
END_TEST

/* Where areas and volumes are too small for doubles, contacts are still exact; the rest is defined. */
START_TEST(tiny_double_positions) {
    body box = make_box(1, 1, 0, 0, 0), other = make_box(1, 1, 0.25f, 0.3125f, 0.375f);
    for (double scale = 1e-60; scale > 1e-310; scale *= 1e-10) {
        double positions[2][24];
        vox_grid* grid = depth_grid();
        for (int b = 0; b < 2; ++b) {
            const body* from = b == 0 ? &box : &other;
            for (int i = 0; i < 24; ++i) positions[b][i] = scale * (double)from->positions[i];
            vox_mesh_desc mesh = body_desc(from);
            mesh.positions.data = positions[b];
            mesh.positions.format = VOX_FORMAT_DOUBLE;
            insert_mesh(grid, &mesh);
        }
        ck_ok(vox_grid_step(grid));
        const vox_constraint_view view = constraints_of(grid);
        ck_assert_uint_eq(view.count, 2);
        for (uint64_t i = 0; i < view.count; ++i) {
            const vox_constraint* c = &view.data[i];
            double sum = 0;
            ck_assert(c->gap <= 0 && isfinite(c->gap) && isfinite(c->offset));
            ck_assert(fabs(norm(normal_of(c)) - 1) < 1e-14);
            for (int k = 1; k < 5; ++k) {
                ck_assert(c->weights[k] <= 0 && c->weights[k] >= -1);
                sum += c->weights[k];
            }
            ck_assert_double_eq_tol(sum, -1, 1e-15);
        }
        vox_grid_destroy(grid);
    }
    free_body(&box);
    free_body(&other);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, flag, no_contacts_no_work, every_unit_gives_the_same_answer, nothing_is_stale,
                   strides_and_copies, depths_in_double, double_positions, tiny_double_positions);
}

SUITE(penetrations) {
    add_for_each_engine(suite, add_tests);
    TCase* all = add_case(suite, "all engines");
    tcase_add_test(all, every_way_gives_the_same_bits);
}
