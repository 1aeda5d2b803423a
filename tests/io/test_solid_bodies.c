/* The ready-made bodies: their shape, their tets, and bad arguments. */
#include "support/solid_checks.h"

/* ---- ball of a cubic lattice ---- */

/* The paper's spheres: tets asked for (Table 1), and what the construction gives. Their cell sizes are the
 * matter of tests/api/test_cell_size_tables.c. */
static const struct {
    uint64_t wanted, tets;
} spheres[] = {{41937, 41946}, {52326, 52302}, {60688, 60691}, {72631, 72637}, {80927, 80928}};

START_TEST(lattice_ball_is_the_papers) {
    vox_io_mesh* mesh = NULL;
    ck_ok(vox_io_make_lattice_ball(spheres[_i].wanted, 1, &mesh));
    ck_assert_uint_eq(solid_view(mesh).tet_count, spheres[_i].tets);
    check_solid(mesh);
    vox_io_mesh_destroy(mesh);
}
END_TEST

START_TEST(lattice_ball_of_any_size) {
    static const uint64_t counts[] = {1, 2, 5, 7, 10, 23, 50, 100, 321, 1000, 1999, 2000, 5000, 20000};
    uint64_t before = 0;
    for (size_t i = 0; i < sizeof counts / sizeof *counts; ++i) {
        vox_io_mesh* mesh = NULL;
        ck_ok(vox_io_make_lattice_ball(counts[i], 3, &mesh));
        const vox_io_mesh_view view = solid_view(mesh);
        check_solid(mesh);
        ck_assert_uint_ge(view.tet_count, before);
        const double off = fabs((double)view.tet_count - (double)counts[i]);
        ck_assert_msg(off <= 4.5 || off <= 0.01 * (double)counts[i], "%llu tets for %llu",
                      (unsigned long long)view.tet_count, (unsigned long long)counts[i]);
        for (size_t v = 0; v < view.vertex_count; ++v)
            ck_assert_double_le(sqrt(solid_dot(view.positions + 3 * v, view.positions + 3 * v)),
                                3 * (1 + 1e-14));
        before = view.tet_count;
        vox_io_mesh_destroy(mesh);
    }
}
END_TEST

START_TEST(lattice_ball_is_the_same_again) {
    vox_io_mesh *a = NULL, *b = NULL;
    ck_ok(vox_io_make_lattice_ball(3000, 0.5, &a));
    ck_ok(vox_io_make_lattice_ball(3000, 0.5, &b));
    check_same(a, b);
    vox_io_mesh_destroy(a);
    vox_io_mesh_destroy(b);
}
END_TEST

/* ---- bodies by stuffing ---- */

typedef struct {
    const char* name;
    vox_result (*make)(double cell, vox_io_mesh** out);
    double (*depth)(const double* p); /* signed distance, positive inside */
    double longest, volume;
    long long euler;

} body_case;

static double radius_of(double x, double y, double z) { return sqrt(x * x + y * y + z * z); }

static vox_result ball(double cell, vox_io_mesh** out) { return vox_io_make_ball(1.5, cell, out); }
static double ball_depth(const double* p) { return 1.5 - radius_of(p[0], p[1], p[2]); }

static vox_result torus(double cell, vox_io_mesh** out) { return vox_io_make_torus(2, 0.7, cell, out); }
static double torus_depth(const double* p) { return 0.7 - radius_of(radius_of(p[0], p[1], 0) - 2, p[2], 0); }

static vox_result capsule(double cell, vox_io_mesh** out) { return vox_io_make_capsule(0.5, 2, cell, out); }
static double capsule_depth(const double* p) {
    return 0.5 - radius_of(p[0], p[1], fabs(p[2]) > 1 ? fabs(p[2]) - 1 : 0);
}

static vox_result cylinder(double cell, vox_io_mesh** out) { return vox_io_make_cylinder(1, 3, cell, out); }
static double cylinder_depth(const double* p) {
    const double side = radius_of(p[0], p[1], 0) - 1, end = fabs(p[2]) - 1.5;
    if (side > 0 && end > 0) return -radius_of(side, end, 0);
    return -(side > end ? side : end);
}

static const body_case bodies[] = {
    {"ball", ball, ball_depth, 3, 14.13716694115407, 2},
    {"torus", torus, torus_depth, 5.4, 19.34442463, 0},
    {"capsule", capsule, capsule_depth, 3, 2.0943951024, 2},
    {"cylinder", cylinder, cylinder_depth, 3, 9.42477796076938, 2},
};

START_TEST(stuffed_body) {
    const body_case* body = &bodies[_i % 4];
    const int across = 10 + 20 * (_i / 4); /* cells along its longest side */
    const double cell = body->longest / across;
    vox_io_mesh *mesh = NULL, *again = NULL;
    ck_ok(body->make(cell, &mesh));
    ck_ok(body->make(cell, &again));
    check_same(mesh, again);
    const vox_io_mesh_view view = solid_view(mesh);
    const solid_facts facts = check_stuffed(mesh);
    ck_assert_uint_eq(facts.pinched_edges, 0);
    ck_assert_int_eq(facts.euler, body->euler);
    double deepest = 0;
    for (size_t v = 0; v < view.vertex_count; ++v) {
        const double depth = body->depth(view.positions + 3 * v);
        ck_assert_msg(depth > -1e-9, "%s: vertex %zu lies %g outside", body->name, v, -depth);
        if (depth > deepest) deepest = depth;
    }
    ck_assert_double_gt(deepest, 0.3 * body->longest / 10);
    if (across == 50) ck_assert_double_eq_tol(facts.volume / body->volume, 1, 0.01);
    const vox_io_quality quality = quality_of(mesh, NULL);
    ck_assert_uint_eq(quality.tets, view.tet_count);
    ck_assert_uint_eq(quality.vertices, view.vertex_count);
    ck_assert_uint_eq(quality.boundary_facets, facts.boundary_facets);
    ck_assert_double_eq_tol(quality.min_dihedral, facts.min_dihedral, 1e-6);
    ck_assert_double_eq_tol(quality.max_dihedral, facts.max_dihedral, 1e-6);
    ck_assert_double_eq_tol(quality.volume, facts.volume, 1e-9);
    ck_assert_double_eq(quality.hausdorff, 0);
    vox_io_mesh_destroy(mesh);
    vox_io_mesh_destroy(again);
}
END_TEST

/* The bodies' surfaces as fine triangle meshes: a profile of (distance from the axis, z) turned around the z
 * axis. */
enum { profile_points = 240, turns = 240 };

static void profile_of(int body, int i, double* rho, double* z) {
    const double t = (double)i / profile_points, pi = 3.14159265358979323846;
    if (body == 1) { /* torus: a closed circle */
        *rho = 2 + 0.7 * cos(2 * pi * t);
        *z = 0.7 * sin(2 * pi * t);
    } else if (body ==
               3) { /* cylinder: from the middle of one end over the rims to the middle of the other */
        const double length = 5 * t;
        *rho = length < 1 ? length : length < 4 ? 1 : 5 - length;
        *z = length < 1 ? -1.5 : length < 4 ? length - 2.5 : 1.5;
    } else { /* ball, capsule: from pole to pole */
        const double r = body == 0 ? 1.5 : 0.5, end = body == 0 ? 0 : 1, angle = pi * t;
        *rho = r * sin(angle);
        *z = -r * cos(angle) + (2 * i < profile_points ? -end : end);
    }
}

static vox_io_mesh* turned_surface(int body) {
    static double positions[3 * (profile_points + 1) * turns];
    static uint32_t triangles[6 * profile_points * turns];
    uint32_t* t = triangles;
    for (uint32_t i = 0; i <= profile_points; ++i) {
        double rho = 0, z = 0;
        profile_of(body, (int)(body == 1 ? i % profile_points : i), &rho, &z);
        for (uint32_t k = 0; k < turns; ++k) {
            const double angle = 2 * 3.14159265358979323846 * k / turns;
            double* p = &positions[3 * (i * turns + k)];
            p[0] = rho * cos(angle), p[1] = rho * sin(angle), p[2] = z;
            if (i == profile_points) continue;
            const uint32_t next = (k + 1) % turns, a = i * turns + k, b = i * turns + next;
            *t++ = a, *t++ = b, *t++ = b + turns;
            *t++ = a, *t++ = b + turns, *t++ = a + turns;
        }
    }
    const vox_io_mesh_view arrays = {positions, (profile_points + 1) * turns, NULL, 0,
                                     triangles, 2 * profile_points * turns,   NULL, NULL,
                                     NULL};
    vox_io_mesh* surface = NULL;
    ck_ok(vox_io_mesh_create(&arrays, &surface));
    return surface;
}

START_TEST(stuffed_body_is_near_its_surface) {
    const body_case* body = &bodies[_i];
    const double cell = body->longest / 50;
    vox_io_mesh *mesh = NULL, *surface = turned_surface(_i);
    ck_ok(body->make(cell, &mesh));
    const vox_io_quality quality = quality_of(mesh, surface);
    ck_assert_msg(quality.hausdorff < 0.5 * cell, "%s: %g cells", body->name, quality.hausdorff / cell);
    ck_assert_double_gt(quality.hausdorff, 0);
    vox_io_mesh_destroy(mesh);
    vox_io_mesh_destroy(surface);
}
END_TEST

START_TEST(box_is_exact) {
    vox_io_mesh* mesh = NULL;
    ck_ok(vox_io_make_box(8, 1, 1.5, 0.26, &mesh)); /* 31 x 4 x 6 cuboids */
    const vox_io_mesh_view view = solid_view(mesh);
    const solid_facts facts = check_solid(mesh);
    ck_assert_uint_eq(view.tet_count, 31 * 4 * 6 * 5);
    ck_assert_uint_eq(view.vertex_count, 32 * 5 * 7);
    ck_assert_double_eq_tol(facts.volume, 12, 1e-11);
    ck_assert_int_eq(facts.euler, 2);
    ck_assert_uint_eq(facts.boundary_facets, 4 * (31 * 4 + 31 * 6 + 4 * 6));
    vox_io_mesh_destroy(mesh);

    ck_ok(vox_io_make_box(2, 2, 2, 100, &mesh)); /* one cube */
    ck_assert_uint_eq(solid_view(mesh).tet_count, 5);
    ck_assert_double_eq_tol(check_solid(mesh).volume, 8, 1e-14);
    vox_io_mesh_destroy(mesh);
}
END_TEST

/* ---- bad arguments ---- */

START_TEST(bad_arguments) {
    static const double bad[] = {0, -1, INFINITY, -INFINITY, NAN};
    vox_io_mesh* untouched = NULL;
    ck_fails(vox_io_make_lattice_ball(0, 1, &untouched), VOX_ERROR_INVALID_ARGUMENT, "tet_count is 0");
    ck_fails(vox_io_make_lattice_ball(UINT64_MAX, 1, &untouched), VOX_ERROR_INVALID_ARGUMENT,
             "tet_count is 18446744073709551615");
    ck_fails(vox_io_make_lattice_ball(1, 1, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_mesh is null");
    ck_fails(vox_io_make_ball(1, 1, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_mesh is null");
    ck_fails(vox_io_make_torus(1, 1, 1, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_mesh is null");
    ck_fails(vox_io_make_capsule(1, 1, 1, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_mesh is null");
    ck_fails(vox_io_make_cylinder(1, 1, 1, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_mesh is null");
    ck_fails(vox_io_make_box(1, 1, 1, 1, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_mesh is null");
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        const double x = bad[i];
        ck_fails(vox_io_make_lattice_ball(100, x, &untouched), VOX_ERROR_INVALID_ARGUMENT, "radius is");
        ck_fails(vox_io_make_ball(x, 1, &untouched), VOX_ERROR_INVALID_ARGUMENT, "radius is");
        ck_fails(vox_io_make_ball(1, x, &untouched), VOX_ERROR_INVALID_ARGUMENT, "cell is");
        ck_fails(vox_io_make_torus(x, 1, 1, &untouched), VOX_ERROR_INVALID_ARGUMENT, "radius is");
        ck_fails(vox_io_make_torus(1, x, 1, &untouched), VOX_ERROR_INVALID_ARGUMENT, "tube_radius is");
        ck_fails(vox_io_make_torus(1, .5, x, &untouched), VOX_ERROR_INVALID_ARGUMENT, "cell is");
        ck_fails(vox_io_make_capsule(x, 1, 1, &untouched), VOX_ERROR_INVALID_ARGUMENT, "radius is");
        ck_fails(vox_io_make_capsule(1, x, 1, &untouched), VOX_ERROR_INVALID_ARGUMENT, "length is");
        ck_fails(vox_io_make_capsule(1, 1, x, &untouched), VOX_ERROR_INVALID_ARGUMENT, "cell is");
        ck_fails(vox_io_make_cylinder(x, 1, 1, &untouched), VOX_ERROR_INVALID_ARGUMENT, "radius is");
        ck_fails(vox_io_make_cylinder(1, x, 1, &untouched), VOX_ERROR_INVALID_ARGUMENT, "length is");
        ck_fails(vox_io_make_cylinder(1, 1, x, &untouched), VOX_ERROR_INVALID_ARGUMENT, "cell is");
        ck_fails(vox_io_make_box(x, 1, 1, 1, &untouched), VOX_ERROR_INVALID_ARGUMENT, "size_x is");
        ck_fails(vox_io_make_box(1, x, 1, 1, &untouched), VOX_ERROR_INVALID_ARGUMENT, "size_y is");
        ck_fails(vox_io_make_box(1, 1, x, 1, &untouched), VOX_ERROR_INVALID_ARGUMENT, "size_z is");
        ck_fails(vox_io_make_box(1, 1, 1, x, &untouched), VOX_ERROR_INVALID_ARGUMENT, "cell is");
    }
    ck_fails(vox_io_make_torus(1, 1, .1, &untouched), VOX_ERROR_INVALID_ARGUMENT, "less than radius");
    ck_fails(vox_io_make_ball(1, 100, &untouched), VOX_ERROR_INVALID_ARGUMENT, "no tet fits");
    ck_fails(vox_io_make_ball(1, 1e-300, &untouched), VOX_ERROR_LIMIT, "cells along x");
    ck_fails(vox_io_make_ball(1, 1e-5, &untouched), VOX_ERROR_LIMIT, "at most 4096");
    ck_fails(vox_io_make_box(1, 1, 1, 1e-300, &untouched), VOX_ERROR_LIMIT, "cells along x");
    ck_fails(vox_io_make_box(1, 1, 1, 1e-4, &untouched), VOX_ERROR_LIMIT, "1000000000000 cubes");
    ck_assert_ptr_null(untouched);
}
END_TEST

SUITE(solid_bodies) {
    TCase* tests = add_case(suite, "bodies");
    tcase_add_loop_test(tests, lattice_ball_is_the_papers, 0, 5);
    tcase_add_each(tests, lattice_ball_of_any_size, lattice_ball_is_the_same_again);
    tcase_add_loop_test(tests, stuffed_body, 0, 8);
    tcase_add_each(tests, box_is_exact, bad_arguments);
    TCase* large = add_tagged_case(suite, "large", "large");
    tcase_add_loop_test(large, stuffed_body, 8, 12);
    tcase_add_loop_test(large, stuffed_body_is_near_its_surface, 0, 4);
}
