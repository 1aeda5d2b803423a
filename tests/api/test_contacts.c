/* What a contact is, through the public face: the rule of vox_contact, canonical order, and the traps that
 * grids fall into. The exact sets on random scenes are tests/internal's. */
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "scenes/bodies.h"
#include "support/constraint_checks.h"

typedef struct scene {
    vox_grid* grid;
    vox_body a, b;
} scene;

static scene new_scene(const vox_mesh_desc* a, const vox_mesh_desc* b, double cell_size) {
    vox_grid_desc desc = engine_desc();
    scene s = {NULL, 0, 0};
    desc.cell_size = cell_size;
    ck_ok(vox_grid_create(&desc, &s.grid));
    if (a) ck_ok(vox_mesh_insert(s.grid, a, &s.a));
    if (b) ck_ok(vox_mesh_insert(s.grid, b, &s.b));
    return s;
}

static vox_contact_view stepped(vox_grid* grid) {
    ck_ok(vox_grid_step(grid));
    return contacts_of(grid);
}

static uint64_t hash_of(vox_grid* grid) {
    uint64_t hash = 0;
    ck_ok(vox_grid_get_hash(grid, &hash));
    return hash;
}

static void check_order(vox_contact_view view) {
    for (uint64_t i = 1; i < view.count; ++i) {
        const vox_contact *p = &view.data[i - 1], *q = &view.data[i];
        const uint32_t left[4] = {p->body_a, p->vertex, p->body_b, p->tet};
        const uint32_t right[4] = {q->body_a, q->vertex, q->body_b, q->tet};
        int k = 0;
        while (k < 3 && left[k] == right[k]) ++k;
        ck_assert_uint_lt(left[k], right[k]);
    }
}

/* One point against the unit tet: its constraint, if it is inside. */
static uint64_t point_in_tet(const float point[3], const float corners[12], const uint32_t tet[4],
                             vox_constraint* constraint) {
    const vox_mesh_desc points = vox_mesh_desc_floats(point, 1, NULL, 0),
                        body = vox_mesh_desc_floats(corners, 4, tet, 1);
    scene s = new_scene(&points, &body, 0.3);
    const uint64_t count = stepped(s.grid).count;
    find_weights(s.grid);
    ck_assert_uint_eq(constraints_of(s.grid).count, count);
    if (count) *constraint = constraints_of(s.grid).data[0];
    vox_grid_destroy(s.grid);
    return count;
}

START_TEST(inside_and_on_the_boundary) {
    static const struct {
        float point[3];
        int inside;
        double weights[4];
    } cases[] = {
        {{0.25f, 0.25f, 0.25f}, 1, {0.25f, 0.25f, 0.25f, 0.25f}},
        {{0.25f, 0.25f, 0}, 1, {0.5f, 0.25f, 0.25f, 0}},    /* on a face */
        {{0.25f, 0.25f, 0.5f}, 1, {0, 0.25f, 0.25f, 0.5f}}, /* on the slanted face */
        {{0.5f, 0, 0}, 1, {0.5f, 0.5f, 0, 0}},              /* on an edge */
        {{0, 0, 1}, 1, {0, 0, 0, 1}},                       /* on a corner */
        {{0.25f, 0.25f, -FLT_MIN}, 0, {0}},                 /* the least bit outside */
        {{0.25f, 0.25f, 0.50000006f}, 0, {0}},
        {{1.0000001f, 0, 0}, 0, {0}},
        {{0.7f, 0.7f, 0.7f}, 0, {0}}, /* in the box, not in the tet */
    };
    const uint32_t inverted[4] = {0, 2, 1, 3};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        vox_constraint c;
        memset(&c, 0, sizeof c);
        ck_assert_uint_eq(point_in_tet(cases[i].point, unit_tet_positions, unit_tet, &c), cases[i].inside);
        for (int k = 0; k < 4 && cases[i].inside; ++k)
            ck_assert_double_eq(-c.weights[1 + k], cases[i].weights[k]);
        ck_assert_uint_eq(point_in_tet(cases[i].point, unit_tet_positions, inverted, &c), cases[i].inside);
        for (int k = 0; k < 4 && cases[i].inside; ++k)
            ck_assert_double_eq(-c.weights[1 + k], cases[i].weights[inverted[k]]);
    }
}
END_TEST

START_TEST(shared_boundary_gives_one_contact) {
    /* Every lattice point and every cube centre of a box: on corners, edges and faces of up to 24 tets at
     * once. */
    body box = make_box(4, 0.25f, -0.5f, -0.5f, -0.5f);
    body points = make_box(8, 0.125f, -0.5f, -0.5f, -0.5f);
    points.tet_count = 0;
    const vox_mesh_desc a = body_desc(&points), b = body_desc(&box);
    scene s = new_scene(&a, &b, 0.25);
    const vox_contact_view view = stepped(s.grid);
    check_order(view);
    uint64_t first = 0;
    ck_assert_uint_ge(view.count, points.vertex_count);
    for (uint32_t v = 0; v < points.vertex_count; ++v) {
        uint64_t end = first;
        while (end < view.count && view.data[end].vertex == v) ++end;
        ck_assert_uint_eq(end - first, 1); /* tets of a conforming mesh do not overlap: never two */
        first = end;
    }
    /* Corner 0 of the box belongs to tet 0 and to no other of lower index. */
    ck_assert_uint_eq(view.data[0].tet, 0);
    vox_grid_destroy(s.grid);
    free_body(&box);
    free_body(&points);
}
END_TEST

START_TEST(overlapping_tets) {
    /* Two equal tets and a larger one around the point: all three hold it inside. On the boundary of the
     * first two and inside the third: only the third. */
    const float corners[24] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, -1, -1, -1, 5, 0, 0, 0, 5, 0, 0, 0, 5};
    const uint32_t tets[12] = {0, 1, 2, 3, 4, 5, 6, 7, 1, 0, 2, 3};
    const float points[6] = {0.25f, 0.25f, 0.25f, 0.25f, 0.25f, 0};
    const vox_mesh_desc a = vox_mesh_desc_floats(points, 2, NULL, 0),
                        b = vox_mesh_desc_floats(corners, 8, tets, 3);
    scene s = new_scene(&a, &b, 0.7);
    const vox_contact_view view = stepped(s.grid);
    ck_assert_uint_eq(view.count, 4);
    for (uint32_t i = 0; i < 3; ++i) {
        ck_assert_uint_eq(view.data[i].vertex, 0);
        ck_assert_uint_eq(view.data[i].tet, i);
    }
    ck_assert_uint_eq(view.data[3].vertex, 1);
    ck_assert_uint_eq(view.data[3].tet, 1);
    vox_grid_destroy(s.grid);
}
END_TEST

START_TEST(self_contact) {
    /* Two tets of one mesh, apart in topology: vertex 7 pokes into tet 0. Own vertices never count. */
    float corners[24] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 3, 3, 3, 4, 3, 3, 3, 4, 3, 0.25f, 0.25f, 0.25f};
    const uint32_t tets[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    vox_mesh_desc desc = vox_mesh_desc_floats(corners, 8, tets, 2);
    scene without = new_scene(&desc, NULL, 0);
    ck_assert_uint_eq(stepped(without.grid).count, 0);
    vox_grid_destroy(without.grid);
    desc.filter.flags = VOX_FILTER_SELF_COLLISION;
    scene s = new_scene(&desc, NULL, 0);
    vox_contact_view view = stepped(s.grid);
    ck_assert_uint_eq(view.count, 1);
    ck_assert_uint_eq(view.data[0].body_a, s.a);
    ck_assert_uint_eq(view.data[0].body_b, s.a);
    ck_assert_uint_eq(view.data[0].vertex, 7);
    ck_assert_uint_eq(view.data[0].tet, 0);
    corners[21] = 3, corners[22] = 3, corners[23] = 4; /* moved after insertion: nothing stale */
    ck_assert_uint_eq(stepped(s.grid).count, 0);
    vox_grid_destroy(s.grid);
}
END_TEST

START_TEST(both_directions_in_canonical_order) {
    body box = make_box(3, 0.25f, 0, 0, 0), other = make_box(3, 0.25f, 0.4f, 0.3f, 0.2f);
    vox_mesh_desc a = body_desc(&box), b = body_desc(&other);
    a.flags = b.filter.flags = VOX_FILTER_SELF_COLLISION;
    scene s = new_scene(&a, &b, 0);
    vox_contact_view view = stepped(s.grid);
    uint64_t from_a = 0;
    check_order(view);
    for (uint64_t i = 0; i < view.count; ++i) {
        ck_assert_uint_ne(view.data[i].body_a, view.data[i].body_b); /* the boxes do not fold */
        from_a += view.data[i].body_a == s.a;
    }
    /* The weights of a vertex give it back. */
    find_weights(s.grid);
    const vox_constraint_view found = checked_constraints(s.grid);
    ck_assert_uint_eq(found.count, view.count);
    for (uint64_t i = 0; i < found.count; ++i) {
        const vox_constraint* c = &found.data[i];
        const body* in = c->body_b == s.a ? &box : &other;
        for (uint32_t axis = 0; axis < 3; ++axis) {
            double x = 0;
            for (int k = 1; k < 5; ++k) x -= c->weights[k] * (double)in->positions[3 * c->vertices[k] + axis];
            ck_assert_double_eq_tol(x, c->position[axis], 1e-12);
        }
    }
    ck_assert_uint_gt(from_a, 0);
    ck_assert_uint_lt(from_a, view.count);
    vox_grid_destroy(s.grid);
    free_body(&box);
    free_body(&other);
}
END_TEST

START_TEST(settings_do_not_change_contacts) {
    body box = make_box(4, 0.25f, -0.5f, -0.5f, -0.5f), other = make_box(5, 0.2f, -0.1f, -0.2f, -0.3f);
    vox_mesh_desc a = body_desc(&box), b = body_desc(&other);
    uint64_t expected = 0, count = 0;
    const double sizes[] = {0, 0.05, 0.1, 0.25, 0.5, 2.0, 1e-6, 1e-300, 1e6, 1e300};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; ++i)
        for (uint32_t flags = 0; flags < 4; ++flags)
            for (int world = 0; world < 2; ++world) {
                vox_grid_desc desc = vox_default_grid_desc();
                vox_reference_desc reference = vox_default_reference_desc();
                if ((flags & VOX_REFERENCE_DENSE) && sizes[i] != 0 && sizes[i] < 0.01)
                    continue; /* see below */
                desc.cell_size = sizes[i];
                reference.flags = flags;
                reference.hash_table_size = world ? 7 : 0; /* a table so small that every list is long */
                for (int axis = 0; axis < 3 && world; ++axis)
                    reference.world_min[axis] = -0.125,
                    reference.world_max[axis] = 0.25; /* most lies outside */
                if (suite_engine == ENGINE_REFERENCE)
                    desc.reference = &reference;
                else if (flags || world)
                    continue;
                vox_grid* grid = grid_of(&desc);
                vox_body mesh = insert_mesh(grid, &a);
                ck_ok(vox_mesh_insert(grid, &b, &mesh));
                const vox_contact_view view = stepped(grid);
                if (!expected) expected = hash_of(grid), count = view.count;
                ck_assert_uint_gt(view.count, 0);
                ck_assert_uint_eq(view.count, count);
                ck_assert_uint_eq(hash_of(grid), expected);
                vox_grid_destroy(grid);
            }
    /* Dense cells that no memory holds: an error with numbers, and the grid stays usable. */
    vox_grid_desc desc = vox_default_grid_desc();
    desc.reference = reference_with(VOX_REFERENCE_DENSE);
    desc.cell_size = 1e-6;
    vox_grid* grid = grid_of(&desc);
    vox_body mesh = insert_mesh(grid, &a);
    ck_ok(vox_mesh_insert(grid, &b, &mesh));
    const vox_result result = vox_grid_step(grid);
    ck_assert(result == VOX_ERROR_BUDGET || result == VOX_ERROR_LIMIT);
    ck_assert_ptr_nonnull(strstr(vox_last_error(), "cells"));
    ck_ok(vox_grid_set_cell_size(grid, 0.25));
    (void)stepped(grid);
    ck_assert_uint_eq(hash_of(grid), expected);
    vox_grid_destroy(grid);
    free_body(&box);
    free_body(&other);
}
END_TEST

START_TEST(hash_tells_contacts_apart) {
    /* Same contacts, same hash; another contact set, another hash; none at all, still defined. */
    body box = make_box(3, 0.25f, 0, 0, 0), other = make_box(3, 0.25f, 0.4f, 0.3f, 0.2f);
    const vox_mesh_desc a = body_desc(&box), b = body_desc(&other);
    scene s = new_scene(&a, &b, 0), t = new_scene(&a, &b, 0);
    const uint64_t none = hash_of(s.grid);
    (void)stepped(s.grid);
    (void)stepped(t.grid);
    const uint64_t some = hash_of(s.grid);
    ck_assert_uint_ne(some, none);
    ck_assert_uint_eq(some, hash_of(t.grid));
    for (int axis = 0; axis < 3; ++axis) other.positions[axis] += 1.0f / 1024; /* in the same tetrahedron */
    (void)stepped(s.grid);
    ck_assert_uint_eq(some, hash_of(s.grid));
    for (int axis = 0; axis < 3; ++axis) other.positions[axis] += 0.25f; /* one vertex in another one */
    (void)stepped(s.grid);
    ck_assert_uint_ne(some, hash_of(s.grid));
    ck_ok(vox_grid_clear(s.grid));
    ck_assert_uint_eq(none, hash_of(s.grid));
    vox_grid_destroy(s.grid);
    vox_grid_destroy(t.grid);
    free_body(&box);
    free_body(&other);
}
END_TEST

/* ---- positions ---- */

START_TEST(strided_copied_rebound) {
    body box = make_box(3, 0.25f, 0, 0, 0), other = make_box(3, 0.25f, 0.4f, 0.3f, 0.2f);
    const vox_mesh_desc a = body_desc(&box);
    vox_mesh_desc b = body_desc(&other);
    scene s = new_scene(&a, &b, 0);
    vox_contact_view view = stepped(s.grid);
    const uint64_t expected = hash_of(s.grid), count = view.count;
    ck_assert_uint_gt(count, 0);

    /* The same positions 13 bytes apart, at an odd address. */
    const size_t stride = 13;
    unsigned char* packed = malloc(1 + stride * other.vertex_count);
    for (uint32_t v = 0; v < other.vertex_count; ++v)
        memcpy(packed + 1 + stride * v, other.positions + 3 * v, 12);
    ck_ok(bind_array(s.grid, s.b, packed + 1, VOX_FORMAT_FLOAT, stride, 0));
    memset(other.positions, 0, 12 * other.vertex_count); /* no longer looked at */
    (void)stepped(s.grid);
    ck_assert_uint_eq(hash_of(s.grid), expected);
    vox_grid_destroy(s.grid);

    /* A copy taken at insertion does not see later changes; binding ends it. */
    b.positions.data = packed + 1;
    b.positions.byte_stride = stride;
    b.flags = VOX_MESH_COPY_POSITIONS;
    s = new_scene(&a, &b, 0);
    memset(packed, 0xff, 1 + stride * other.vertex_count); /* NaN, were they read */
    (void)stepped(s.grid);
    ck_assert_uint_eq(hash_of(s.grid), expected);
    ck_ok(bind_array(s.grid, s.b, packed + 1, VOX_FORMAT_FLOAT, stride, 0));
    ck_fails(vox_grid_step(s.grid), VOX_ERROR_NON_FINITE, "vertex 0");
    vox_grid_destroy(s.grid);
    free(packed);
    free_body(&box);
    free_body(&other);
}
END_TEST

START_TEST(unbound_positions) {
    vox_mesh_desc desc = vox_mesh_desc_floats(NULL, 4, unit_tet, 1);
    scene s = new_scene(&desc, NULL, 0);
    ck_fails(vox_grid_step(s.grid), VOX_ERROR_INVALID_STATE, "no positions");
    ck_ok(bind_array(s.grid, s.a, unit_tet_positions, VOX_FORMAT_FLOAT, 0, 0));
    (void)stepped(s.grid);
    vox_grid_destroy(s.grid);
}
END_TEST

START_TEST(non_finite_positions) {
    const float bad[] = {NAN, INFINITY, -INFINITY};
    body box = make_box(2, 0.5f, 0, 0, 0), other = make_box(2, 0.5f, 0.3f, 0.3f, 0.3f);
    const vox_mesh_desc a = body_desc(&box), b = body_desc(&other);
    for (int chosen = 0; chosen < 2; ++chosen) { /* the cell size given, and chosen at that very step */
        scene s = new_scene(&a, &b, chosen ? 0 : 0.5);
        char words[64];
        snprintf(words, sizeof words, "body %u (slot 1, user data 0), vertex 5", s.b);
        for (int i = 0; i < 3; ++i)
            for (int axis = 0; axis < 3; ++axis) {
                const float good = other.positions[15 + axis];
                uint64_t before = 0, after = 0;
                if (!chosen) ck_assert_uint_gt(stepped(s.grid).count, 0);
                before = grid_info(s.grid).epoch;
                other.positions[15 + axis] = bad[i];
                ck_fails(vox_grid_step(s.grid), VOX_ERROR_NON_FINITE, words);
                vox_contact_view view = contacts_of(s.grid);
                ck_assert_uint_eq(view.count, 0); /* the previous contacts are gone */
                after = grid_info(s.grid).epoch;
                ck_assert_uint_eq(after, before + 1);
                other.positions[15 + axis] = good;
            }
        ck_assert_uint_gt(stepped(s.grid).count, 0);
        vox_grid_destroy(s.grid);
    }
    free_body(&box);
    free_body(&other);
}
END_TEST

/* ---- traps ---- */

START_TEST(nothing_at_all) {
    scene s = new_scene(NULL, NULL, 0);
    ck_assert_uint_eq(stepped(s.grid).count, 0); /* no mesh */
    const vox_mesh_desc empty = vox_default_mesh_desc();
    ck_ok(vox_mesh_insert(s.grid, &empty, &s.a));
    ck_assert_uint_eq(stepped(s.grid).count, 0); /* an empty mesh */
    const vox_mesh_desc one = vox_mesh_desc_floats(unit_tet_positions, 1, NULL, 0);
    ck_ok(vox_mesh_insert(s.grid, &one, &s.a));
    ck_assert_uint_eq(stepped(s.grid).count, 0); /* one vertex */
    const vox_mesh_desc tet = vox_mesh_desc_floats(unit_tet_positions, 4, unit_tet, 1);
    ck_ok(vox_mesh_insert(s.grid, &tet, &s.b));
    ck_assert_uint_eq(stepped(s.grid).count, 1); /* that vertex on the corner of one tet */
    vox_grid_destroy(s.grid);
}
END_TEST

START_TEST(huge_coordinates) {
    /* A vertex at 1e30 stretches its tets over the world; bounded time and memory, and exact still. */
    body box = make_box(6, 0.25f, 0, 0, 0), other = make_box(6, 0.25f, 0.4f, 0.3f, 0.2f);
    const vox_mesh_desc a = body_desc(&box), b = body_desc(&other);
    const float far[] = {1e30f, -1e30f, FLT_MAX, -FLT_MAX};
    for (int i = 0; i < 4; ++i) {
        uint64_t expected = 0;
        other.positions[3 * 342] = far[i];
        for (int k = 0; k < 3; ++k) {
            const double sizes[] = {0.25, 1e-3, 1e3};
            scene s = new_scene(&a, &b, sizes[k]);
            const vox_contact_view view = stepped(s.grid);
            ck_assert_uint_gt(view.count, 0);
            if (!expected) expected = hash_of(s.grid);
            ck_assert_uint_eq(hash_of(s.grid), expected);
            grid_counts counters = counters_of(s.grid);
            ck_assert_uint_lt(counters.peak_bytes, 4u << 20);
            vox_grid_destroy(s.grid);
        }
    }
    free_body(&box);
    free_body(&other);
}
END_TEST

START_TEST(sliver_a_thousand_edges_long) {
    body box = make_box(8, 0.125f, 0, 0, 0);
    const float sliver[12] = {0, 0, 0, 125, 125, 125, 125.1f, 125, 125, 125, 125.1f, 125};
    const vox_mesh_desc a = body_desc(&box), b = vox_mesh_desc_floats(sliver, 4, unit_tet, 1);
    uint64_t expected = 0;
    for (int dense = 0; dense < (suite_engine == ENGINE_REFERENCE ? 2 : 1); ++dense) {
        scene s = {NULL, 0, 0};
        vox_grid_desc desc = engine_desc();
        desc.cell_size = 0.125;
        if (dense) desc.reference = reference_with(VOX_REFERENCE_DENSE);
        desc.byte_budget = 8u << 20;
        ck_ok(vox_grid_create(&desc, &s.grid));
        ck_ok(vox_mesh_insert(s.grid, &a, &s.a));
        ck_ok(vox_mesh_insert(s.grid, &b, &s.b));
        if (dense) { /* 1000 cells an axis do not fit the budget */
            ck_fails(vox_grid_step(s.grid), VOX_ERROR_BUDGET, "cells");
            ck_ok(vox_grid_set_cell_size(s.grid, 4));
        }
        const vox_contact_view view = stepped(s.grid);
        ck_assert_uint_ge(view.count, 1); /* the common corner at least */
        if (!expected) expected = hash_of(s.grid);
        ck_assert_uint_eq(hash_of(s.grid), expected);
        vox_grid_destroy(s.grid);
    }
    free_body(&box);
}
END_TEST

START_TEST(scaled_and_far_copies) {
    /* Millimetres, kilometres, and a million away: exact shifts and scales leave the pairs alone. */
    const float scales[] = {1.0f / 1024, 1, 1024}, offsets[] = {0, -1048576, 1048576};
    uint64_t pairs[64];
    uint64_t count = 0;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            if (scales[i] < 1 && offsets[k] != 0) continue; /* not representable */
            body box = make_box(3, 0.25f * scales[i], offsets[k], offsets[k], offsets[k]);
            body other = make_box(2, 0.25f * scales[i], 0.625f * scales[i] + offsets[k],
                                  0.625f * scales[i] + offsets[k], 0.5f * scales[i] + offsets[k]);
            const vox_mesh_desc a = body_desc(&box), b = body_desc(&other);
            scene s = new_scene(&a, &b, 0);
            const vox_contact_view view = stepped(s.grid);
            ck_assert_uint_gt(view.count, 0);
            ck_assert_uint_le(view.count, 64);
            if (!count) count = view.count;
            ck_assert_uint_eq(view.count, count);
            for (uint64_t n = 0; n < count; ++n) {
                const vox_contact* c = &view.data[n];
                const uint64_t pair = (uint64_t)(c->body_a == s.a) << 63 | (uint64_t)c->vertex << 32 | c->tet;
                if (i == 0) pairs[n] = pair;
                ck_assert_uint_eq(pair, pairs[n]);
            }
            vox_grid_destroy(s.grid);
            free_body(&box);
            free_body(&other);
        }
}
END_TEST

START_TEST(coincident_bodies) {
    body box = make_box(4, 0.25f, 0, 0, 0);
    const vox_mesh_desc desc = body_desc(&box);
    scene s = new_scene(&desc, &desc, 0);
    const vox_contact_view view = stepped(s.grid);
    ck_assert_uint_eq(view.count, 2u * box.vertex_count); /* each vertex on its twin, one contact */
    check_order(view);
    vox_grid_destroy(s.grid);
    free_body(&box);
}
END_TEST

START_TEST(flat_and_repeated_tets_hold_nothing) {
    const float corners[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1};
    const uint32_t tets[8] = {0, 1, 2, 3, 0, 1, 1, 4};
    const float point[3] = {0.25f, 0.25f, 0};
    const vox_mesh_desc a = vox_mesh_desc_floats(point, 1, NULL, 0),
                        b = vox_mesh_desc_floats(corners, 5, tets, 2);
    scene s = new_scene(&a, &b, 0.5);
    ck_assert_uint_eq(stepped(s.grid).count, 0);
    grid_counts counters = counters_of(s.grid);
    /* The fast engine meets the flat one only: the point is not in the other's box. */
    ck_assert_uint_eq(counters.skipped_degenerate, suite_engine == ENGINE_REFERENCE ? 2 : 1);
    vox_grid_destroy(s.grid);
}
END_TEST

START_TEST(removal_between_steps) {
    body box = make_box(3, 0.25f, 0, 0, 0), other = make_box(3, 0.25f, 0.4f, 0.3f, 0.2f);
    const vox_mesh_desc a = body_desc(&box), b = body_desc(&other);
    scene s = new_scene(&a, &b, 0);
    vox_contact_view view = stepped(s.grid);
    const uint64_t count = view.count, hash = hash_of(s.grid);
    ck_ok(vox_body_remove(s.grid, s.a));
    vox_contact_view kept = contacts_of(s.grid);
    ck_assert_uint_eq(kept.count, count); /* until the next step */
    ck_assert_uint_eq(hash_of(s.grid), hash);
    ck_assert_uint_eq(stepped(s.grid).count, 0);
    ck_ok(vox_mesh_insert(s.grid, &a, &s.a));
    ck_assert_uint_eq(stepped(s.grid).count, count);
    ck_ok(vox_grid_clear(s.grid));
    ck_ok(vox_grid_get_contacts(s.grid, &kept));
    ck_assert_uint_eq(kept.count, 0);
    ck_assert_uint_eq(stepped(s.grid).count, 0);
    vox_grid_destroy(s.grid);
    free_body(&box);
    free_body(&other);
}
END_TEST

START_TEST(counters_and_profile) {
    body box = make_box(3, 0.25f, 0, 0, 0), other = make_box(3, 0.25f, 0.4f, 0.3f, 0.2f);
    const vox_mesh_desc a = body_desc(&box), b = body_desc(&other);
    scene s = new_scene(&a, &b, 0.25);
    const vox_contact_view view = stepped(s.grid);
    grid_times p;
    grid_counts c = counters_of(s.grid);
    p = times_of(s.grid);
    ck_assert_uint_eq(c.bodies, 2);
    ck_assert_uint_eq(c.vertices, box.vertex_count + other.vertex_count);
    ck_assert_uint_eq(c.tets, box.tet_count + other.tet_count);
    ck_assert_uint_eq(c.contacts, view.count);
    ck_assert_uint_gt(c.cells, 0);
    ck_assert_uint_le(c.cells, c.entries);
    ck_assert_uint_le(c.entries, c.vertices);
    ck_assert_uint_ge(c.fullest_cell, (c.entries + c.cells - 1) / c.cells);
    ck_assert_uint_gt(c.visited_entries, 0);
    if (suite_engine == ENGINE_REFERENCE) ck_assert_uint_ge(c.visited_entries, c.candidates);
    ck_assert_uint_ge(c.candidates, c.contacts);
    ck_assert_uint_gt(c.bytes, 0);
    ck_assert_uint_ge(c.peak_bytes, c.bytes);
    ck_assert_uint_gt(p.step_ns, 0);
    ck_assert_uint_le(p.bin_ns + p.broad_ns + p.narrow_ns + p.contacts_ns, p.step_ns);
    vox_grid_destroy(s.grid);
    free_body(&box);
    free_body(&other);
}
END_TEST

/* bin, broad and narrow are sums of the fast engine's stages. The reference engine has these three alone. */
START_TEST(stage_times_add_up) {
    body box = make_box(6, 0.25f, 0, 0, 0), other = make_box(6, 0.25f, 0.4f, 0.3f, 0.2f);
    vox_mesh_desc a = body_desc(&box), b = body_desc(&other);
    a.filter.flags |= VOX_FILTER_SELF_COLLISION;
    scene s = new_scene(&a, &b, 0.25);
    (void)stepped(s.grid);
    grid_times p;
    p = times_of(s.grid);
    const uint64_t stages =
        p.stream_ns + p.winding_ns + p.broad_phase_ns + p.windows_ns + p.lookup_ns + p.decide_ns;
    if (suite_engine == ENGINE_REFERENCE) {
        ck_assert_uint_eq(stages, 0);
        ck_assert_uint_gt(p.bin_ns, 0);
    } else {
        ck_assert_uint_eq(p.bin_ns, p.stream_ns + p.winding_ns + p.windows_ns);
        ck_assert_uint_eq(p.broad_ns, p.broad_phase_ns + p.lookup_ns);
        ck_assert_uint_eq(p.narrow_ns, p.decide_ns);
        ck_assert_uint_gt(p.stream_ns, 0);
        ck_assert_uint_gt(p.winding_ns, 0);
        ck_assert_uint_gt(p.broad_phase_ns, 0);
        ck_assert_uint_gt(p.windows_ns, 0);
        ck_assert_uint_gt(p.lookup_ns, 0);
        ck_assert_uint_le(stages + p.contacts_ns + p.depth_ns + p.pairs_ns, p.step_ns);
    }
    vox_grid_destroy(s.grid);
    free_body(&box);
    free_body(&other);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, inside_and_on_the_boundary, shared_boundary_gives_one_contact, overlapping_tets,
                   self_contact, both_directions_in_canonical_order, hash_tells_contacts_apart,
                   strided_copied_rebound, unbound_positions, non_finite_positions, nothing_at_all,
                   huge_coordinates, sliver_a_thousand_edges_long, scaled_and_far_copies, coincident_bodies,
                   flat_and_repeated_tets_hold_nothing, removal_between_steps, counters_and_profile,
                   stage_times_add_up);
}

static void add_long_tests(TCase* tests) { tcase_add_test(tests, settings_do_not_change_contacts); }

SUITE(contacts) {
    add_for_each_engine(suite, add_tests);
    add_tagged_for_each_engine(suite, add_long_tests, "long");
}
