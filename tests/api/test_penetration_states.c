/* Every state of the depth of a vertex: when it comes, and what gap and normal are then. */
#include "support/depth_checks.h"

static const vector up = {0, 0, 1}, down = {0, 0, -1};

static vox_body insert(vox_grid* grid, const body* b, uint32_t flags) {
    vox_mesh_desc desc = body_desc(b);
    desc.filter.flags = flags;
    return insert_mesh(grid, &desc);
}

static vox_body insert_arrays(vox_grid* grid, const float* positions, uint64_t vertices, const uint32_t* tets,
                              uint64_t tet_count) {
    const vox_mesh_desc desc = vox_mesh_desc_floats(positions, vertices, tets, tet_count);
    return insert_mesh(grid, &desc);
}

static void step(vox_grid* grid) {
    ck_ok(vox_grid_step(grid));
    check_depths(grid);
}

/* Depth and direction as they have to be. */
static void expect(const vox_grid* grid, vox_body a, uint32_t vertex, vox_body b, vox_depth_state state,
                   double depth, vector direction) {
    const vox_constraint* p = inside_of(grid, a, vertex, b);
    ck_assert_msg(p != NULL, "vertex %u is not inside", vertex);
    ck_assert_msg(p->state == state, "vertex %u: state %d, expected %d", vertex, (int)p->state, (int)state);
    ck_assert_msg(fabs(depth_of(p) - depth) < 1e-14, "vertex %u: depth %.9g, expected %.9g", vertex,
                  depth_of(p), depth);
    ck_assert_msg(degrees_between(normal_of(p), direction) < 0.01, "vertex %u: direction (%g, %g, %g)",
                  vertex, p->normal[0], p->normal[1], p->normal[2]);
}

/* A tetrahedron that pokes its vertex 0 into the top of the unit box, by `depth`. */
static const uint32_t poke_tet[4] = {0, 1, 2, 3};
static void make_poke(float positions[12], float depth) {
    const float p[12] = {0.45f, 0.55f, 1 - depth, 0.2f, 0.3f, 1.5f, 0.8f, 0.3f, 1.5f, 0.5f, 0.8f, 1.5f};
    memcpy(positions, p, sizeof p);
}

/* ---- surface, propagated ---- */

START_TEST(one_vertex_in_a_box) {
    body box = make_box(4, 0.25f, 0, 0, 0);
    float positions[12];
    for (int i = 1; i < 20; ++i) {
        vox_grid* grid = depth_grid();
        make_poke(positions, (float)i * 0.01f);
        const vox_body b = insert(grid, &box, 0), a = insert_arrays(grid, positions, 4, poke_tet, 1);
        step(grid);
        expect(grid, a, 0, b, VOX_DEPTH_SURFACE, 1 - (double)positions[2], up);
        if (i < 8) { /* later a vertex of the box is in the tetrahedron, too */
            ck_assert_uint_eq(constraints_of(grid).count, 1);
            ck_assert_uint_eq(counters_of(grid).leaving_edges, 3);
        }
        ck_assert_uint_eq(counters_of(grid).closest_searches, 0);
        vox_grid_destroy(grid);
    }
    free_body(&box);
}
END_TEST

START_TEST(waves_reach_deep_vertices) {
    /* A narrow block sunk into a wide one: its sides lead through the top face only. */
    body wide = make_box(8, 0.25f, 0, 0, 0), narrow = make_box(6, 0.125f, 0.6f, 0.65f, 1.45f);
    vox_grid* grid = depth_grid();
    const vox_body b = insert(grid, &wide, 0), a = insert(grid, &narrow, 0);
    step(grid);
    uint32_t surface = 0, propagated = 0;
    for (uint32_t v = 0; v < narrow.vertex_count; ++v) {
        const double depth = 2 - (double)narrow.positions[3 * v + 2];
        if (depth <= 0) continue;
        const int top = depth < 0.125; /* the layer whose neighbours are out */
        expect(grid, a, v, b, top ? VOX_DEPTH_SURFACE : VOX_DEPTH_PROPAGATED, depth, up);
        surface += top;
        propagated += !top;
    }
    ck_assert_uint_eq(surface, 49);
    ck_assert_uint_eq(propagated, 49 * 4);
    vox_grid_destroy(grid);
    free_body(&wide);
    free_body(&narrow);
}
END_TEST

START_TEST(the_faces_of_a_box_stay_flat) {
    /* Near an edge, too: normals are not smoothed over it. */
    body box = make_box(3, 1.0f / 3, 0, 0, 0);
    float positions[12] = {0.9f, 0.5f, 0.97f, 0.85f, 0.45f, 1.1f, 0.95f, 0.45f, 1.1f, 0.9f, 0.55f, 1.1f};
    vox_grid* grid = depth_grid();
    const vox_body b = insert(grid, &box, 0), a = insert_arrays(grid, positions, 4, poke_tet, 1);
    step(grid);
    expect(grid, a, 0, b, VOX_DEPTH_SURFACE, 1 - (double)positions[2], up);
    vox_grid_destroy(grid);
    free_body(&box);
}
END_TEST

/* ---- closest ---- */

START_TEST(body_inside_a_body) {
    body outer_box = make_box(6, 0.25f, 0, 0, 0), inner_box = make_box(3, 0.0625f, 0.3f, 0.55f, 0.9f);
    surface s = surface_of(&outer_box);
    vox_grid* grid = depth_grid();
    const vox_body b = insert(grid, &outer_box, 0), a = insert(grid, &inner_box, 0);
    step(grid);
    ck_assert_uint_eq(count_state(grid, a, VOX_DEPTH_CLOSEST), inner_box.vertex_count);
    ck_assert_uint_eq(constraints_of(grid).count, inner_box.vertex_count);
    ck_assert_uint_eq(counters_of(grid).closest_searches, inner_box.vertex_count);
    ck_assert_uint_eq(counters_of(grid).leaving_edges, 0);
    for (uint32_t v = 0; v < inner_box.vertex_count; ++v) check_closest(inside_of(grid, a, v, b), &s);
    vox_grid_destroy(grid);
    free_surface(&s);
    free_body(&outer_box);
    free_body(&inner_box);
}
END_TEST

START_TEST(points_without_edges) {
    body box = make_box(4, 0.25f, 0, 0, 0);
    const float points[6] = {0.5f, 0.5f, 0.9f, 0.1f, 0.4f, 0.5f};
    vox_grid* grid = depth_grid();
    const vox_body b = insert(grid, &box, 0), a = insert_arrays(grid, points, 2, NULL, 0);
    step(grid);
    expect(grid, a, 0, b, VOX_DEPTH_CLOSEST, 1 - (double)points[2], up);
    expect(grid, a, 1, b, VOX_DEPTH_CLOSEST, (double)points[3], (vector){-1, 0, 0});
    vox_grid_destroy(grid);
    free_body(&box);
}
END_TEST

/* ---- ambiguous ---- */

/* A plate of 8 x 8 x 1 cubes of edge 1/8, and a tetrahedron whose vertex 0 is in it and whose edges leave on
 * both sides. */
static body make_plate(void) {
    body plate = make_box(8, 0.125f, 0, 0, 0);
    for (uint32_t v = 0; v < plate.vertex_count; ++v) plate.positions[3 * v + 2] *= 0.125f;
    return plate;
}

START_TEST(edges_leave_on_opposite_sides) {
    body plate = make_plate();
    surface s = surface_of(&plate);
    /* Two above and two below, as far away: a pair of tetrahedra over a common edge. */
    const float positions[18] = {0.5f, 0.5f, 0.0625f,  0.6f, 0.5f, 0.3625f,  0.4f, 0.5f, 0.3625f,
                                 0.5f, 0.6f, -0.2375f, 0.5f, 0.4f, -0.2375f, 0.5f, 0.5f, 0.9f};
    const uint32_t tets[8] = {0, 1, 2, 3, 0, 1, 2, 4};
    vox_grid* grid = depth_grid();
    const vox_body b = insert(grid, &plate, 0), a = insert_arrays(grid, positions, 5, tets, 2);
    step(grid);
    const vox_constraint* p = inside_of(grid, a, 0, b);
    ck_assert_ptr_nonnull(p);
    ck_assert_int_eq(p->state, VOX_DEPTH_AMBIGUOUS);
    check_closest(p, &s);
    ck_assert(fabs(depth_of(p) - 0.0625) < 1e-15);
    vox_grid_destroy(grid);
    free_surface(&s);
    free_body(&plate);
}
END_TEST

START_TEST(crossing_bars) {
    /* A bar through a bar: what comes in at both ends meets in the middle, and there goes to the nearer side.
     * No edge leads through the other sides, though they may be closer. */
    body x_bar = make_box(12, 0.25f, -1.5f, -1.5f, -1.5f), y_bar = make_box(12, 0.25f, -1.5f, -1.5f, -1.5f);
    for (uint32_t v = 0; v < x_bar.vertex_count; ++v) {
        float *p = x_bar.positions + 3 * v, *q = y_bar.positions + 3 * v;
        p[0] += 0.01f, p[1] *= 0.3f, p[2] = 0.3f * p[2] + 0.01f;
        q[0] *= 0.3f, q[1] = 0.7f * q[1] + 0.02f, q[2] *= 0.3f;
    }
    surface of_x = surface_of(&x_bar), of_y = surface_of(&y_bar);
    vox_grid* grid = depth_grid();
    const vox_body a = insert(grid, &x_bar, 0), b = insert(grid, &y_bar, 0);
    step(grid);
    const vox_constraint_view view = constraints_of(grid);
    uint64_t by_state[5] = {0, 0, 0, 0, 0};
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_constraint* p = &view.data[i];
        ++by_state[p->state];
        ck_assert_double_lt(depth_of(p), 0.5); /* half of a bar's width, and a bit */
        if (p->state == VOX_DEPTH_AMBIGUOUS) {
            const int of_x_bar = p->body_a == a;
            const vector end = plus_times(vector_of(p->position), depth_of(p), normal_of(p));
            ck_assert(norm(way_to(of_x_bar ? &of_y : &of_x, end)) < 1e-14);
            ck_assert(fabs(p->normal[of_x_bar ? 0 : 1]) > 0.999999);
        }
    }
    ck_assert_uint_gt(by_state[VOX_DEPTH_SURFACE], 0);
    ck_assert_uint_gt(by_state[VOX_DEPTH_PROPAGATED], 0);
    ck_assert_uint_gt(by_state[VOX_DEPTH_AMBIGUOUS], 0);
    ck_assert_uint_eq(by_state[VOX_DEPTH_CLOSEST], 0);
    ck_assert_uint_eq(counters_of(grid).closest_searches, 0);
    (void)b;
    vox_grid_destroy(grid);
    free_surface(&of_x);
    free_surface(&of_y);
    free_body(&x_bar);
    free_body(&y_bar);
}
END_TEST

/* Vertex 0 of a small tetrahedron is in the lower of three that share the facet (0, 1, 2); the way up leads
 * through it. */
START_TEST(no_way_through_a_facet_of_three) {
    float solid[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0.3f, 0.3f, -1, 0.3f, 0.3f, 1, 0.4f, 0.2f, 0.5f};
    uint32_t tets[12] = {0, 1, 2, 3, 0, 1, 2, 4, 0, 1, 2, 5};
    const float poke[12] = {0.3f, 0.3f, -0.05f, 0.2f, 0.3f, 1.5f, 0.4f, 0.3f, 1.5f, 0.3f, 0.4f, 1.5f};
    const body of_three = {solid, tets, 6, 3};
    surface s = surface_of(&of_three);
    ck_assert_uint_eq(s.count, 9);
    vox_grid* grid = depth_grid();
    const vox_body b = insert_arrays(grid, solid, 6, tets, 3), a = insert_arrays(grid, poke, 4, poke_tet, 1);
    step(grid);
    const vox_constraint* p = inside_of(grid, a, 0, b);
    ck_assert_ptr_nonnull(p);
    ck_assert_int_eq(p->state, VOX_DEPTH_AMBIGUOUS);
    check_closest(p, &s);
    vox_grid_destroy(grid);
    free_surface(&s);
}
END_TEST

START_TEST(no_surface_at_all) {
    /* The five tetrahedra of four of five vertices each: every facet belongs to two. */
    const float solid[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0.25f, 0.25f, 0.25f};
    const uint32_t tets[20] = {0, 1, 2, 3, 0, 1, 2, 4, 0, 1, 3, 4, 0, 2, 3, 4, 1, 2, 3, 4};
    const float poke[12] = {0.3f, 0.3f, 0.3f, 0.2f, 0.3f, 1.5f, 0.4f, 0.3f, 1.5f, 0.3f, 0.4f, 1.5f};
    vox_grid* grid = depth_grid();
    const vox_body b = insert_arrays(grid, solid, 5, tets, 5), a = insert_arrays(grid, poke, 4, poke_tet, 1);
    step(grid);
    const vox_constraint* p = inside_of(grid, a, 0, b);
    ck_assert_ptr_nonnull(p);
    ck_assert_int_eq(p->state, VOX_DEPTH_AMBIGUOUS);
    ck_assert(p->gap == 0);
    vox_grid_destroy(grid);
}
END_TEST

/* ---- touching ---- */

START_TEST(coincident_bodies) {
    body one = make_box(4, 0.25f, 0, 0, 0), other = make_box(4, 0.25f, 0, 0, 0);
    surface s = surface_of(&one);
    vox_grid* grid = depth_grid();
    const vox_body a = insert(grid, &one, 0), b = insert(grid, &other, 0);
    step(grid);
    ck_assert_uint_eq(constraints_of(grid).count, 2 * one.vertex_count);
    for (uint32_t v = 0; v < one.vertex_count; ++v) {
        const vox_constraint* p = inside_of(grid, a, v, b);
        const vector at = place(one.positions, v);
        const int inside = at.x > 0 && at.x < 1 && at.y > 0 && at.y < 1 && at.z > 0 && at.z < 1;
        ck_assert_int_eq(p->state, inside ? VOX_DEPTH_CLOSEST : VOX_DEPTH_TOUCHING);
        check_closest(p, &s);
        const vector from_middle = {at.x - 0.5, at.y - 0.5, at.z - 0.5};
        if (!inside) ck_assert(inner(normal_of(p), from_middle) > 0.49); /* the normal of a face it is on */
    }
    vox_grid_destroy(grid);
    free_surface(&s);
    free_body(&one);
    free_body(&other);
}
END_TEST

START_TEST(stacked_boxes_touch) {
    /* Vertices on faces, edges and corners of tetrahedra, all on the plane between two boxes. */
    body lower = make_box(4, 0.25f, 0, 0, 0), upper = make_box(4, 0.25f, 0.125f, 0.125f, 1),
         aligned = make_box(4, 0.25f, 3, 0, 1), under = make_box(4, 0.25f, 3, 0, 0);
    vox_grid* grid = depth_grid();
    const vox_body a = insert(grid, &lower, 0), b = insert(grid, &upper, 0), c = insert(grid, &aligned, 0),
                   d = insert(grid, &under, 0);
    step(grid);
    const vox_constraint_view view = constraints_of(grid);
    ck_assert_uint_eq(view.count, 16 + 16 + 25 + 25);
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_constraint* p = &view.data[i];
        ck_assert_int_eq(p->state, VOX_DEPTH_TOUCHING);
        const vector out = p->body_a == a || p->body_a == d ? down : up; /* up: out of the lower one */
        const int on_edge = p->body_a == c || p->body_a == d; /* where it may be another face's normal */
        if (!on_edge) ck_assert(degrees_between(normal_of(p), out) < 0.01);
    }
    for (uint32_t v = 0; v < aligned.vertex_count; ++v) {
        const vector at = place(aligned.positions, v);
        if (at.z == 1 && at.x > 3 && at.x < 4 && at.y > 0 && at.y < 1)
            expect(grid, c, v, d, VOX_DEPTH_TOUCHING, 0, up);
    }
    (void)b;
    vox_grid_destroy(grid);
    free_body(&lower);
    free_body(&upper);
    free_body(&aligned);
    free_body(&under);
}
END_TEST

START_TEST(lattices_that_coincide) {
    /* Every vertex of one lies on vertices, edges and facets inside the other; the ways out run along them.
     */
    body lower = make_box(8, 0.125f, 0, 0, 0), upper = make_box(4, 0.125f, 0.25f, 0.25f, 0.75f);
    vox_grid* grid = depth_grid();
    const vox_body b = insert(grid, &lower, 0), a = insert(grid, &upper, 0);
    step(grid);
    for (uint32_t v = 0; v < upper.vertex_count; ++v) {
        const double depth = 1 - (double)upper.positions[3 * v + 2];
        if (depth < 0) continue;
        if (depth == 0)
            expect(grid, a, v, b, VOX_DEPTH_TOUCHING, 0, up);
        else if (depth == 0.125 || depth == 0.25)
            expect(grid, a, v, b, VOX_DEPTH_PROPAGATED, depth, up);
    }
    vox_grid_destroy(grid);
    free_body(&lower);
    free_body(&upper);
}
END_TEST

START_TEST(on_the_surface_of_a_part_and_inside_another) {
    /* Two boxes of one mesh that overlap; the point is on the top of the lower one. Its only contact is
     * inside the other. */
    body low = make_box(2, 0.5f, 0, 0, 0), high = make_box(2, 0.5f, 0.1f, 0.2f, 0.3f);
    float positions[3 * 54];
    uint32_t tets[4 * 80];
    memcpy(positions, low.positions, sizeof positions / 2);
    memcpy(positions + 3 * 27, high.positions, sizeof positions / 2);
    for (uint32_t i = 0; i < 4 * 40; ++i) tets[i] = low.tets[i], tets[4 * 40 + i] = high.tets[i] + 27;
    const float point[3] = {0.55f, 0.6f, 1};
    vox_grid* grid = depth_grid();
    const vox_body b = insert_arrays(grid, positions, 54, tets, 80),
                   a = insert_arrays(grid, point, 1, NULL, 0);
    step(grid);
    ck_assert_uint_eq(counters_of(grid).contacts, 1);
    expect(grid, a, 0, b, VOX_DEPTH_TOUCHING, 0, up);
    vox_grid_destroy(grid);
    free_body(&low);
    free_body(&high);
}
END_TEST

/* ---- meshes that are not as they should be ---- */

static void swap_corners(body* b, uint32_t from, uint32_t every) {
    for (uint32_t t = from; t < b->tet_count; t += every) {
        const uint32_t corner = b->tets[4 * t + 2];
        b->tets[4 * t + 2] = b->tets[4 * t + 3];
        b->tets[4 * t + 3] = corner;
    }
}

START_TEST(winding_does_not_matter) {
    body plain = make_box(6, 0.25f, 0, 0, 0), upper = make_box(6, 0.2f, 0.1f, 0.15f, 1.3f);
    body wound = make_box(6, 0.25f, 0, 0, 0);
    vox_grid* grid = depth_grid();
    const vox_body b = insert(grid, &plain, 0), a = insert(grid, &upper, 0);
    step(grid);
    for (uint32_t every = 1; every <= 3; ++every) { /* all of them, and mixed */
        vox_grid* again = depth_grid();
        swap_corners(&wound, 0, every);
        ck_assert_uint_eq(insert(again, &wound, 0), b);
        ck_assert_uint_eq(insert(again, &upper, 0), a);
        step(again);
        const vox_constraint_view before = constraints_of(grid), after = constraints_of(again);
        ck_assert_uint_eq(before.count, after.count);
        for (uint64_t i = 0; i < before.count; ++i) {
            const vox_constraint *p = &before.data[i], *q = &after.data[i];
            ck_assert_int_eq(p->state, q->state);
            ck_assert(fabs(p->gap - q->gap) < 1e-14);
            ck_assert(degrees_between(normal_of(p), normal_of(q)) < 0.01);
        }
        vox_grid_destroy(again);
    }
    vox_grid_destroy(grid);
    free_body(&plain);
    free_body(&upper);
    free_body(&wound);
}
END_TEST

START_TEST(doubled_tets) {
    body box = make_box(4, 0.25f, 0, 0, 0);
    uint32_t* twice = (uint32_t*)malloc(8 * sizeof(uint32_t) * box.tet_count);
    memcpy(twice, box.tets, 4 * sizeof(uint32_t) * box.tet_count);
    memcpy(twice + 4 * box.tet_count, box.tets, 4 * sizeof(uint32_t) * box.tet_count);
    float positions[12];
    make_poke(positions, 0.3f);
    vox_grid* grid = depth_grid();
    const vox_body b = insert_arrays(grid, box.positions, box.vertex_count, twice, 2 * box.tet_count),
                   a = insert_arrays(grid, positions, 4, poke_tet, 1);
    step(grid);
    expect(grid, a, 0, b, VOX_DEPTH_SURFACE, 1 - (double)positions[2], up);
    vox_grid_destroy(grid);
    free(twice);
    free_body(&box);
}
END_TEST

START_TEST(flat_tets_on_the_surface) {
    /* Four vertices of the top face, and tetrahedra that name a vertex twice, which have no facets. */
    body box = make_box(4, 0.25f, 0, 0, 0);
    const uint32_t top = 4 * 25, n = box.tet_count;
    uint32_t* tets = (uint32_t*)malloc(4 * sizeof(uint32_t) * (n + 8));
    memcpy(tets, box.tets, 4 * sizeof(uint32_t) * n);
    for (uint32_t i = 0; i < 4; ++i) {
        const uint32_t v = top + 5 * (i + 1) / 2 + i;
        const uint32_t flat[8] = {v, v + 1, v + 5, v + 6, v, v + 1, v + 1, v + 7};
        memcpy(tets + 4 * (n + 2 * i), flat, sizeof flat);
    }
    vox_grid* grid = depth_grid();
    const vox_body b = insert_arrays(grid, box.positions, box.vertex_count, tets, n + 8);
    body upper = make_box(6, 0.125f, 0.12f, 0.11f, 0.93f);
    const vox_body a = insert(grid, &upper, 0);
    step(grid);
    for (uint32_t v = 0; v < upper.vertex_count; ++v) {
        if (upper.positions[3 * v + 2] >= 1) continue;
        const vox_constraint* p = inside_of(grid, a, v, b);
        ck_assert(fabs(depth_of(p) - (1 - (double)upper.positions[3 * v + 2])) < 1e-14);
        ck_assert(degrees_between(normal_of(p), up) < 0.01);
    }
    vox_grid_destroy(grid);
    free(tets);
    free_body(&box);
    free_body(&upper);
}
END_TEST

START_TEST(inverted_tets) {
    /* Vertices thrown about until many tetrahedra are inverted. Whatever comes is defined, hardly any of it
     * needs a search, and none is farther away than what an edge may lead to. */
    body box = make_box(6, 0.25f, 0, 0, 0), upper = make_box(6, 0.2f, 0.13f, 0.17f, 0.9f);
    uint32_t random = 1;
    for (uint32_t i = 0; i < 3 * box.vertex_count; ++i)
        box.positions[i] += ((float)(random_quick(&random) >> 8) / 16777216.0f - 0.5f) * 0.5f;
    vox_grid* grid = depth_grid();
    insert(grid, &box, VOX_FILTER_SELF_COLLISION);
    insert(grid, &upper, 0);
    step(grid);
    const vox_constraint_view view = constraints_of(grid);
    uint64_t ambiguous = 0;
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_constraint* p = &view.data[i];
        ck_assert_double_lt(depth_of(p), 1);
        ambiguous += p->state == VOX_DEPTH_AMBIGUOUS;
    }
    ck_assert_uint_gt(ambiguous, 50);
    ck_assert_uint_lt(counters_of(grid).closest_searches, ambiguous / 4);
    vox_grid_destroy(grid);
    free_body(&box);
    free_body(&upper);
}
END_TEST

/* ---- self-contact, several bodies ---- */

enum { fold_cells = 96 };

/* A bar with a cross-section of 1 x 1 in 4 x 4 cubes: along x for 8 units, round a half circle upwards and
 * back, and a bit further. The way back sinks by 0.24 a unit, so that the ends overlap. Sheared a little in
 * y, so that the sides of the two arms do not coincide. */
static body make_fold(void) {
    body bar = {NULL, NULL, (fold_cells + 1) * 25, fold_cells * 16 * 6};
    bar.positions = (float*)malloc(3 * sizeof(float) * bar.vertex_count);
    bar.tets = (uint32_t*)malloc(4 * sizeof(uint32_t) * bar.tet_count);
    const float pi = 3.14159265f, radius = 1.25f, arm = 8, length = 2 * arm + pi * radius + 0.4f;
    for (uint32_t i = 0, v = 0; i <= fold_cells; ++i)
        for (uint32_t j = 0; j < 5; ++j)
            for (uint32_t k = 0; k < 5; ++k, ++v) {
                const float s = length * (float)i / fold_cells, h = (float)k * 0.25f - 0.5f;
                float* p = bar.positions + 3 * v;
                p[1] = (float)j * 0.25f + 0.01f * s;
                if (s < arm) {
                    p[0] = s, p[2] = h;
                } else if (s < arm + pi * radius) {
                    const float angle = (s - arm) / radius;
                    p[0] = arm + (radius - h) * sinf(angle), p[2] = radius - (radius - h) * cosf(angle);
                } else {
                    p[0] = 2 * arm + pi * radius - s, p[2] = 2 * radius - h - 0.24f * (arm - p[0]);
                }
            }
    static const uint8_t order[6][2] = {{0, 1}, {0, 2}, {1, 0}, {1, 2}, {2, 0}, {2, 1}}; /* Kuhn */
    const uint32_t stride[3] = {25, 5, 1};
    for (uint32_t i = 0, t = 0; i < fold_cells; ++i)
        for (uint32_t j = 0; j < 4; ++j)
            for (uint32_t k = 0; k < 4; ++k)
                for (int o = 0; o < 6; ++o, ++t) {
                    const uint32_t v = i * 25 + j * 5 + k, w = v + stride[order[o][0]],
                                   x = w + stride[order[o][1]];
                    const uint32_t tet[4] = {v, w, x, v + 31};
                    memcpy(bar.tets + 4 * t, tet, sizeof tet);
                }
    return bar;
}

START_TEST(self_fold) {
    body bar = make_fold();
    vox_grid* grid = depth_grid();
    const vox_body a = insert(grid, &bar, VOX_FILTER_SELF_COLLISION);
    step(grid);
    const vox_constraint_view view = constraints_of(grid);
    uint64_t by_state[5] = {0, 0, 0, 0, 0}, in_middle = 0;
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_constraint* p = &view.data[i];
        ck_assert_uint_eq(p->body_a, a);
        ck_assert_uint_eq(p->body_b, a);
        ++by_state[p->state];
        const vector at = place(bar.positions, p->vertices[0]);
        /* Near the sides and the ends, the ways out lead there. */
        if (p->vertices[0] / 5 % 5 != 2 || at.x < 0.8) continue;
        ++in_middle;
        /* The lower arm's top is z = 0.5; the upper arm's bottom falls to the left. Out of the other arm: */
        const int upper = p->vertices[0] >= bar.vertex_count / 2;
        const double slope = 0.24, into_lower = 0.5 - at.z, into_upper = at.z - (2 - slope * (8 - at.x));
        const double depth = upper ? into_lower : into_upper / sqrt(1 + slope * slope);
        const vector out = upper ? up : (vector){slope, 0, -1};
        ck_assert_int_eq(p->state, VOX_DEPTH_SURFACE);
        ck_assert_msg(fabs(depth_of(p) - depth) < 1e-6, "vertex %u: depth %g, not %g", p->vertices[0],
                      depth_of(p), depth);
        ck_assert_msg(degrees_between(normal_of(p), out) < 0.01, "vertex %u: direction (%g, %g, %g)",
                      p->vertices[0], p->normal[0], p->normal[1], p->normal[2]);
    }
    ck_assert_uint_gt(in_middle, 5);
    ck_assert_uint_gt(by_state[VOX_DEPTH_SURFACE], 20);
    ck_assert_uint_eq(by_state[VOX_DEPTH_CLOSEST], 0);
    vox_grid_destroy(grid);
    free_body(&bar);
}
END_TEST

START_TEST(one_vertex_in_two_bodies) {
    body low = make_box(4, 0.25f, 0, 0, 0), wide = make_box(4, 0.5f, -0.5f, -0.5f, -1.05f);
    float positions[12];
    make_poke(positions, 0.2f);
    vox_grid* grid = depth_grid();
    const vox_body b = insert(grid, &low, 0), a = insert_arrays(grid, positions, 4, poke_tet, 1),
                   c = insert(grid, &wide, 0);
    step(grid);
    expect(grid, a, 0, b, VOX_DEPTH_SURFACE, 1 - (double)positions[2], up);
    const double top = (double)wide.positions[3 * wide.vertex_count - 1];
    expect(grid, a, 0, c, VOX_DEPTH_SURFACE, top - (double)positions[2], up);
    vox_grid_destroy(grid);
    free_body(&low);
    free_body(&wide);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, one_vertex_in_a_box, waves_reach_deep_vertices, the_faces_of_a_box_stay_flat,
                   body_inside_a_body, points_without_edges, edges_leave_on_opposite_sides,
                   no_way_through_a_facet_of_three, no_surface_at_all, coincident_bodies, stacked_boxes_touch,
                   lattices_that_coincide, on_the_surface_of_a_part_and_inside_another,
                   winding_does_not_matter, doubled_tets, flat_tets_on_the_surface, self_fold,
                   one_vertex_in_two_bodies);
}

static void add_long_tests(TCase* tests) { tcase_add_each(tests, crossing_bars, inverted_tets); }

SUITE(penetration_states) {
    add_for_each_engine(suite, add_tests);
    add_tagged_for_each_engine(suite, add_long_tests, "long");
}
