/* What is promised of depths and normals on smooth convex bodies, and of the work that they take. */
#include <vox/vox_io.h>

#include "support/depth_checks.h"

/* A ball, turned and moved, as float arrays. */
static body make_ball(double radius, double cell, double angle, double x) {
    vox_io_mesh* mesh = NULL;
    vox_io_mesh_view view;
    ck_ok(vox_io_make_ball(radius, cell, &mesh));
    ck_ok(vox_io_mesh_get_arrays(mesh, &view));
    body made = {NULL, NULL, (uint32_t)view.vertex_count, (uint32_t)view.tet_count};
    made.positions = (float*)malloc(3 * sizeof(float) * made.vertex_count);
    made.tets = (uint32_t*)malloc(4 * sizeof(uint32_t) * made.tet_count);
    memcpy(made.tets, view.tets, 4 * sizeof(uint32_t) * made.tet_count);
    const double c = cos(angle), s = sin(angle);
    for (uint32_t v = 0; v < made.vertex_count; ++v) {
        const double *p = view.positions + 3 * v, y = s * p[0] + c * p[1];
        made.positions[3 * v] = (float)(c * p[0] - s * p[1] + x);
        made.positions[3 * v + 1] = (float)(c * y - s * p[2]);
        made.positions[3 * v + 2] = (float)(s * y + c * p[2]);
    }
    vox_io_mesh_destroy(mesh);
    return made;
}

static vox_body insert(vox_grid* grid, const body* b) {
    const vox_mesh_desc desc = body_desc(b);
    return insert_mesh(grid, &desc);
}

/* Two balls of radius 1 that overlap by this. Their cells are 0.06. */
static const double overlaps[] = {0.02, 0.05, 0.1, 0.15};

START_TEST(two_balls) {
    const double overlap = overlaps[_i];
    body balls[2] = {make_ball(1, 0.06, 0.3, 2 - overlap), make_ball(1, 0.06, 0, 0)};
    const double centre[2] = {2 - overlap, 0};
    vox_grid* grid = depth_grid();
    vox_body ids[2];
    surface surfaces[2];
    for (int b = 0; b < 2; ++b) {
        ids[b] = insert(grid, &balls[b]);
        surfaces[b] = surface_of(&balls[b]);
    }
    ck_ok(vox_grid_step(grid));
    const vox_constraint_view view = check_depths(grid);
    ck_assert_uint_gt(view.count, 50);
    double worst_depth = 0, worst_angle = 0;
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_constraint* p = &view.data[i];
        const int a = p->body_a == ids[0] ? 0 : 1, b = 1 - a;
        ck_assert(p->state == VOX_DEPTH_SURFACE || p->state == VOX_DEPTH_PROPAGATED);
        /* The true distance to the surface, as it is triangulated, ... */
        const vector at = vector_of(p->position), way = way_to(&surfaces[b], at);
        worst_depth = fmax(worst_depth, fabs(depth_of(p) / norm(way) - 1));
        worst_angle = fmax(worst_angle, degrees_between(normal_of(p), way));
        /* ... and to the sphere, whose triangles are up to cell^2 / 8 inside it. */
        const vector from_centre = {at.x - centre[b], at.y, at.z};
        ck_assert(fabs(depth_of(p) - (1 - norm(from_centre))) < 0.01 * overlap + 0.06 * 0.06 / 4);
    }
    ck_assert_msg(worst_depth < 0.05, "depth off by %.2f %%", 100 * worst_depth);
    ck_assert_msg(worst_angle < 5, "direction off by %.2f degrees", worst_angle);
    vox_grid_destroy(grid);
    for (int b = 0; b < 2; ++b) {
        free_surface(&surfaces[b]);
        free_body(&balls[b]);
    }
}
END_TEST

/* No jump of direction between neighbouring vertices, in shallow contact and in deep. */
START_TEST(directions_change_smoothly) {
    const double overlap = _i == 0 ? 0.1 : _i == 1 ? 0.3 : 0.5;
    body balls[2] = {make_ball(1, 0.09, 0.3, 2 - overlap), make_ball(1, 0.09, 0, 0)};
    vox_grid* grid = depth_grid();
    for (int b = 0; b < 2; ++b) {
        const vox_body id = insert(grid, &balls[b]);
        ck_assert_uint_eq(vox_body_is_valid(grid, id), 1);
    }
    ck_ok(vox_grid_step(grid));
    const vox_constraint_view view = check_depths(grid);
    double worst = 0;
    uint64_t edges = 0;
    for (int b = 0; b < 2; ++b) {
        const vox_constraint** of = (const vox_constraint**)calloc(balls[b].vertex_count, sizeof *of);
        for (uint64_t i = 0; i < view.count; ++i)
            if ((view.data[i].body_a > view.data[i].body_b) == (b == 1))
                of[view.data[i].vertices[0]] = &view.data[i];
        for (uint32_t t = 0; t < balls[b].tet_count; ++t)
            for (int i = 0; i < 4; ++i)
                for (int j = 0; j < i; ++j) {
                    const vox_constraint *p = of[balls[b].tets[4 * t + (uint32_t)i]],
                                         *q = of[balls[b].tets[4 * t + (uint32_t)j]];
                    if (!p || !q) continue;
                    ++edges;
                    worst = fmax(worst, degrees_between(normal_of(p), normal_of(q)));
                }
        free(of);
    }
    ck_assert_uint_gt(edges, 100);
    ck_assert_msg(worst < 30, "directions of neighbours %.1f degrees apart", worst);
    vox_grid_destroy(grid);
    for (int b = 0; b < 2; ++b) free_body(&balls[b]);
}
END_TEST

START_TEST(ball_in_a_box) {
    /* Resting on the inside of nothing: a ball deep in a box of tetrahedra, and one that sinks into its top.
     */
    body box = make_box(10, 0.4f, -2, -2, -2), ball = make_ball(0.5, 0.08, 0.2, 0.1);
    surface s = surface_of(&box);
    for (int sunk = 0; sunk < 2; ++sunk) {
        if (sunk)
            for (uint32_t v = 0; v < ball.vertex_count; ++v) ball.positions[3 * v + 2] += 2.3f;
        vox_grid* grid = depth_grid();
        const vox_body b = insert(grid, &box), a = insert(grid, &ball);
        ck_ok(vox_grid_step(grid));
        const vox_constraint_view view = check_depths(grid);
        ck_assert_uint_eq(count_state(grid, a, VOX_DEPTH_CLOSEST), sunk ? 0 : ball.vertex_count);
        for (uint64_t i = 0; i < view.count; ++i) {
            const vox_constraint* p = &view.data[i];
            if (p->body_a != a) continue;
            ck_assert_uint_eq(p->body_b, b);
            if (!sunk) {
                check_closest(p, &s);
            } else { /* the top is flat */
                ck_assert(fabs(depth_of(p) - (2 - p->position[2])) < 1e-5);
                ck_assert(degrees_between(normal_of(p), (vector){0, 0, 1}) < 0.01);
            }
        }
        vox_grid_destroy(grid);
    }
    free_surface(&s);
    free_body(&box);
    free_body(&ball);
}
END_TEST

/* ---- work ------------------------------------------------------------------------------------- */

/* The counters when a ball of radius 0.5 sinks by `depth` into the middle of the top of a box of n * n * n /
 * 2 cubes. */
static grid_counts work_of(uint32_t n, double cell, double depth) {
    body box = make_box(n, 0.1f, -0.05f * (float)n, -0.05f * (float)n, -0.1f * (float)n);
    body ball = make_ball(0.5, cell, 0.2, 0.017);
    for (uint32_t v = 0; v < ball.vertex_count; ++v) ball.positions[3 * v + 2] += (float)(0.5 - depth);
    vox_grid* grid = depth_grid();
    insert(grid, &box);
    insert(grid, &ball);
    ck_ok(vox_grid_step(grid));
    const grid_counts counters = counters_of(grid);
    vox_grid_destroy(grid);
    free_body(&box);
    free_body(&ball);
    return counters;
}

START_TEST(work_is_that_of_the_colliding_vertices) {
    /* A body of eight times as many tetrahedra, of which as many are hit: the same work, but for the
     * lattice's parity. */
    const grid_counts small = work_of(16, 0.04, 0.1), large = work_of(32, 0.04, 0.1);
    ck_assert_uint_eq(small.penetrations, large.penetrations);
    ck_assert_uint_eq(small.leaving_edges, large.leaving_edges);
    ck_assert_uint_eq(small.edge_tests, large.edge_tests);
    ck_assert_uint_eq(small.closest_tests + large.closest_tests, 0);
    /* More colliding vertices: no more edges than these have, each through no more tetrahedra than lie on it.
     */
    for (double cell = 0.06; cell > 0.02; cell *= 0.7) {
        const grid_counts work = work_of(16, cell, 0.1);
        ck_assert_uint_gt(work.penetrations, 20);
        ck_assert_uint_le(work.leaving_edges, 10 * work.penetrations);
        ck_assert_uint_ge(work.edge_tests, work.leaving_edges);
        ck_assert_uint_le(work.edge_tests, 5 * work.leaving_edges);
    }
}
END_TEST

START_TEST(searches_are_short) {
    /* All of a ball inside a box of 20 times as many triangles or of 80 times: hardly more of them are looked
     * at. */
    const grid_counts small = work_of(16, 0.1, 1.2), large = work_of(32, 0.1, 1.2);
    ck_assert_uint_gt(small.closest_searches, 100);
    ck_assert_uint_eq(small.closest_searches, large.closest_searches);
    ck_assert_uint_le(large.closest_tests, 60 * large.closest_searches);
}
END_TEST

SUITE(penetration_figures) {
    TCase* tests = add_case(suite, "figures");
    tcase_add_loop_test(tests, two_balls, 0, 4);
    tcase_add_loop_test(tests, directions_change_smoothly, 0, 3);
    tcase_add_each(tests, ball_in_a_box, work_is_that_of_the_colliding_vertices, searches_are_short);
}
