/* A transform a step in place of new positions, exact in its result; and bodies without tetrahedra: points
 * and surfaces that sense or cut others. */
#include "scenes/bodies.h"
#include "scenes/random.h"
#include "support/oracle.h"
#include "support/suite.h"

#include <math.h>
#include <string.h>

static uint64_t state = 1;

static double random_double(double min, double max) { return min + (max - min) * random_unit(&state); }

static vox_body insert(vox_grid* grid, const vox_mesh_desc* desc) { return insert_mesh(grid, desc); }

static uint64_t count_of(vox_grid* grid) {
    vox_contact_view view = contacts_of(grid);
    return view.count;
}

/* The interface's definition, operation by operation. */
static void transformed(const double m[12], const double* from, uint32_t vertices, double* to) {
    for (uint32_t v = 0; v < vertices; ++v)
        for (int row = 0; row < 3; ++row) {
            const double* r = m + 4 * row;
            volatile double sum = r[0] * from[3 * v];
            volatile double term = r[1] * from[3 * v + 1];
            sum = sum + term;
            term = r[2] * from[3 * v + 2];
            sum = sum + term;
            to[3 * v + (uint32_t)row] = sum + r[3];
        }
}

/* A rotation by a random unit quaternion, and a translation. */
static void random_rigid(double m[12], double reach) {
    double q[4], norm = 0;
    for (int i = 0; i < 4; ++i) {
        q[i] = random_double(-1, 1);
        norm += q[i] * q[i];
    }
    for (int i = 0; i < 4; ++i) q[i] /= sqrt(norm);
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double r[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                         2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                         2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    for (int row = 0; row < 3; ++row) {
        for (int c = 0; c < 3; ++c) m[4 * row + c] = r[3 * row + c];
        m[4 * row + 3] = random_double(-reach, reach);
    }
}

/* A rigid body over floats or doubles, with no new positions, against doubles that were transformed before
 * and brute force over these. */
START_TEST(exact_in_its_result) {
    state = 1;
    uint64_t contacts = 0;
    for (int scene = 0; scene < 20; ++scene) {
        const int doubles = scene % 2;
        body tool = make_box(3, 0.5f, -0.75f, -0.75f, -0.75f), soft = make_box(3, 0.5f, 0, 0, 0);
        const uint32_t n = tool.vertex_count;
        double *wide = (double*)malloc(3 * sizeof(double) * n),
               *moved = (double*)malloc(3 * sizeof(double) * n),
               *soft_wide = (double*)malloc(3 * sizeof(double) * soft.vertex_count);
        for (uint32_t i = 0; i < 3 * n; ++i) {
            wide[i] = (double)tool.positions[i] + (doubles ? random_double(-0.1, 0.1) : 0);
            if (!doubles) tool.positions[i] = (float)wide[i];
        }
        memcpy(moved, wide, 3 * sizeof(double) * n);
        for (uint32_t i = 0; i < 3 * soft.vertex_count; ++i) soft_wide[i] = (double)soft.positions[i];
        vox_grid *grid = engine_grid(), *plain = engine_grid();
        vox_mesh_desc a = body_desc(&tool), b = body_desc(&soft), c = body_desc(&tool);
        if (doubles) {
            a.positions.data = wide;
            a.positions.format = VOX_FORMAT_DOUBLE;
        }
        c.positions.data = moved;
        c.positions.format = VOX_FORMAT_DOUBLE;
        const vox_body rigid = insert(grid, &a);
        (void)insert(grid, &b);
        (void)insert(plain, &c);
        (void)insert(plain, &b);
        for (int step = 0; step < 5; ++step) {
            double m[12];
            random_rigid(m, 1.5);
            ck_ok(vox_body_set_transform(grid, rigid, m));
            transformed(m, wide, n, moved);
            const uint64_t hash = hash_of_step(grid);
            ck_assert_uint_eq(hash, hash_of_step(plain));
            ck_assert_uint_eq(hash, hash_of_step(grid)); /* at rest */
            const oracle_mesh_d meshes[2] = {{moved, tool.tets, n, tool.tet_count, 0},
                                             {soft_wide, soft.tets, soft.vertex_count, soft.tet_count, 0}};
            oracle_contact* expected = NULL;
            const size_t count = oracle_contacts_d(meshes, 2, &expected);
            vox_contact_view view = contacts_of(grid);
            ck_assert_uint_eq(view.count, count);
            for (size_t i = 0; i < count; ++i) {
                ck_assert_uint_eq(view.data[i].vertex, expected[i].vertex);
                ck_assert_uint_eq(view.data[i].tet, expected[i].tet);
            }
            contacts += count;
            free(expected);
        }
        vox_grid_destroy(grid);
        vox_grid_destroy(plain);
        free(wide);
        free(moved);
        free(soft_wide);
        free_body(&tool);
        free_body(&soft);
    }
    ck_assert_uint_gt(contacts, 500);
}
END_TEST

START_TEST(identity_null_and_other_positions) {
    static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    static const double aside[12] = {1, 0, 0, 8, 0, 1, 0, 0, 0, 0, 1, 0};
    body a = make_box(3, 0.5f, 0.1f, 0.2f, 0), b = make_box(3, 0.5f, 0, 0, 0),
         c = make_box(3, 0.5f, -7.8f, 0.3f, 0);
    vox_mesh_desc first = body_desc(&a), second = body_desc(&b);
    vox_grid* grid = engine_grid();
    const vox_body mesh = insert(grid, &first);
    (void)insert(grid, &second);
    const uint64_t hash = hash_of_step(grid);
    ck_assert_uint_gt(count_of(grid), 0);
    ck_ok(vox_body_set_transform(grid, mesh, identity));
    ck_assert_uint_eq(hash_of_step(grid), hash);
    ck_ok(vox_body_set_transform(grid, mesh, aside));
    ck_assert_uint_ne(hash_of_step(grid), hash);
    ck_assert_uint_eq(count_of(grid), 0);
    /* It stays when other positions are bound, and goes with null. */
    ck_ok(bind_array(grid, mesh, c.positions, VOX_FORMAT_FLOAT, 0, 0));
    (void)hash_of_step(grid);
    ck_assert_uint_gt(count_of(grid), 0);
    ck_ok(vox_body_set_transform(grid, mesh, NULL));
    (void)hash_of_step(grid);
    ck_assert_uint_eq(count_of(grid), 0);
    ck_ok(bind_array(grid, mesh, a.positions, VOX_FORMAT_FLOAT, 0, 0));
    ck_assert_uint_eq(hash_of_step(grid), hash);
    /* A slot's next mesh has none. */
    ck_ok(vox_body_set_transform(grid, mesh, aside));
    ck_ok(vox_body_remove(grid, mesh));
    (void)insert(grid, &first);
    (void)hash_of_step(grid);
    ck_assert_uint_gt(count_of(grid), 0);
    vox_grid_destroy(grid);
    free_body(&a);
    free_body(&b);
    free_body(&c);
}
END_TEST

START_TEST(what_does_not_fit) {
    double m[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    vox_grid* grid = engine_grid();
    vox_mesh_desc desc = vox_mesh_desc_floats(unit_tet_positions, 4, unit_tet, 1);
    const vox_body mesh = insert(grid, &desc);
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 12; ++i)
        for (int k = 0; k < 3; ++k) {
            const double kept = m[i];
            char words[16] = "matrix[?] is";
            if (i < 10)
                words[7] = (char)('0' + i);
            else
                memcpy(words, "matrix[1", 9);
            m[i] = bad[k];
            ck_fails(vox_body_set_transform(grid, mesh, m), VOX_ERROR_INVALID_ARGUMENT, words);
            m[i] = kept;
        }
    ck_fails(vox_body_set_transform(NULL, mesh, m), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_body_set_transform(grid, mesh + 1, m), VOX_ERROR_INVALID_HANDLE, "stale");
    ck_ok(vox_grid_step(grid));
    m[5] = 1e300; /* vertex 2 is at y = 1 */
    ck_ok(vox_body_set_transform(grid, mesh, m));
    ck_fails(vox_grid_step(grid), VOX_ERROR_LIMIT, "vertex 2: position (0, 1e+300, 0) is too large");
    m[5] = m[7] = 1.7e308;
    ck_ok(vox_body_set_transform(grid, mesh, m));
    ck_fails(vox_grid_step(grid), VOX_ERROR_LIMIT, "vertex 0: position (0, 1.7e+308, 0)");
    m[7] = 0;
    m[5] = 1.7e308;
    m[4] = 1.7e308;
    m[6] = 1.7e308;
    double sum[12];
    memcpy(sum, m, sizeof sum);
    float corner[12];
    memcpy(corner, unit_tet_positions, sizeof corner);
    corner[3] = corner[4] = 1; /* vertex 1 is at (1, 1, 0): the sum overflows */
    ck_ok(bind_array(grid, mesh, corner, VOX_FORMAT_FLOAT, 0, 0));
    ck_ok(vox_body_set_transform(grid, mesh, sum));
    ck_fails(vox_grid_step(grid), VOX_ERROR_NON_FINITE, "vertex 1: position (1, inf, 0) is not finite");
    ck_ok(vox_body_set_transform(grid, mesh, NULL));
    ck_ok(vox_grid_step(grid));
    vox_grid_destroy(grid);
}
END_TEST

/* Positions that the library owns, and a transform over them. */
START_TEST(over_mapped_positions) {
    static const double aside[12] = {1, 0, 0, 100, 0, 1, 0, 0, 0, 0, 1, 0};
    body a = make_box(2, 0.5f, -100, 0.1f, 0), b = make_box(2, 0.5f, 0.1f, 0, 0);
    vox_mesh_desc first = body_desc(&a), second = body_desc(&b);
    vox_grid* grid = engine_grid();
    const vox_body mesh = insert(grid, &first);
    (void)insert(grid, &second);
    void* mapped = NULL;
    ck_ok(vox_mesh_map_positions(grid, mesh, &mapped));
    ck_ok(vox_body_set_transform(grid, mesh, aside));
    const uint64_t hash = hash_of_step(grid);
    ck_assert_uint_gt(count_of(grid), 0);
    ck_assert_float_eq(((float*)mapped)[0], -100); /* what is stored stays what it is */
    for (uint32_t v = 0; v < a.vertex_count; ++v) ((float*)mapped)[3 * v] -= 0.25f;
    ck_assert_uint_ne(hash_of_step(grid), hash);
    for (uint32_t v = 0; v < a.vertex_count; ++v) ((float*)mapped)[3 * v] += 0.25f;
    ck_assert_uint_eq(hash_of_step(grid), hash);
    vox_grid_destroy(grid);
    free_body(&a);
    free_body(&b);
}
END_TEST

/* ---- bodies without tetrahedra ---------------------------------------------------------------------------
 */

/* A cloth of n * n vertices over a unit square at height z: a mesh of vertices alone. */
static float* make_cloth(uint32_t n, float z) {
    float* positions = (float*)malloc(3 * sizeof(float) * n * n);
    for (uint32_t j = 0, v = 0; j < n; ++j)
        for (uint32_t i = 0; i < n; ++i, ++v) {
            positions[3 * v] = (float)i / (float)(n - 1);
            positions[3 * v + 1] = (float)j / (float)(n - 1);
            positions[3 * v + 2] = z;
        }
    return positions;
}

/* It falls through a body: while it is inside, all its vertices are, each in one tetrahedron or on a face of
 * some; what it does to others never comes the other way. */
START_TEST(cloth_falls_through_a_body) {
    const uint32_t n = 9;
    body box = make_box(4, 0.25f, 0, 0, 0);
    float* cloth = make_cloth(n, 2);
    vox_grid* grid = engine_grid();
    vox_mesh_desc points = vox_mesh_desc_floats(cloth, n * n, NULL, 0), solid = body_desc(&box);
    points.filter.flags = VOX_FILTER_SELF_COLLISION; /* nothing to collide with */
    const vox_body sheet = insert(grid, &points);
    const vox_body body_mesh = insert(grid, &solid);
    int inside = 0;
    for (int step = 0; step < 25; ++step) {
        const float z = 2 - 0.125f * (float)step;
        for (uint32_t v = 0; v < n * n; ++v) cloth[3 * v + 2] = z;
        (void)hash_of_step(grid);
        vox_contact_view view = contacts_of(grid);
        if (z < 0 || z > 1) {
            ck_assert_uint_eq(view.count, 0);
            continue;
        }
        ++inside;
        ck_assert_uint_eq(view.count, n * n);
        for (uint32_t v = 0; v < n * n; ++v) {
            const vox_contact* c = &view.data[v];
            ck_assert_uint_eq(c->body_a, sheet);
            ck_assert_uint_eq(c->vertex, v);
            ck_assert_uint_eq(c->body_b, body_mesh);
        }
    }
    ck_assert_int_eq(inside, 9);
    vox_grid_destroy(grid);
    free_body(&box);
    free(cloth);
}
END_TEST

/* A probe of a few points on a rigid tool, moved by its transform alone; points of doubles among them. */
START_TEST(sensors_on_a_tool) {
    body box = make_box(2, 0.5f, 0, 0, 0);
    const double tip[9] = {0, 0, 0, 0, 0, 0.5, 0, 0, 5};
    vox_grid* grid = engine_grid();
    vox_mesh_desc solid = body_desc(&box), points = vox_default_mesh_desc();
    points.positions = vox_double_positions(tip, 3);
    (void)insert(grid, &solid);
    const vox_body probe = insert(grid, &points);
    for (int step = 0; step <= 8; ++step) {
        const double z = 1.25 - 0.25 * step;
        const double down[12] = {1, 0, 0, 0.3, 0, 1, 0, 0.4, 0, 0, 1, z};
        ck_ok(vox_body_set_transform(grid, probe, down));
        (void)hash_of_step(grid);
        ck_assert_uint_eq(count_of(grid), (uint64_t)(z >= 0 && z <= 1) + (uint64_t)(z >= -0.5 && z <= 0.5));
    }
    vox_grid_destroy(grid);
    free_body(&box);
}
END_TEST

/* Points and points, and nothing else: no contacts, and the library chooses some cell size all the same. */
START_TEST(points_alone) {
    float* cloth = make_cloth(5, 0);
    vox_grid* grid = engine_grid();
    vox_mesh_desc points = vox_mesh_desc_floats(cloth, 25, NULL, 0);
    points.filter.flags = VOX_FILTER_SELF_COLLISION;
    (void)insert(grid, &points);
    (void)insert(grid, &points);
    (void)hash_of_step(grid);
    ck_assert_uint_eq(count_of(grid), 0);
    vox_grid_destroy(grid);
    free(cloth);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, exact_in_its_result, identity_null_and_other_positions, what_does_not_fit,
                   over_mapped_positions, cloth_falls_through_a_body, sensors_on_a_tool, points_alone);
}

SUITE(mesh_transform) { add_for_each_engine(suite, add_tests); }
