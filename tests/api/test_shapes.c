/* Rigid shapes: what is inside, gaps, normals, transforms, impacts, refusals. Examples that a reader can
 * follow; internal/test_shape_points.cpp and test_shape_steps.cpp have thousands. */
#include "support/shape_checks.h"

typedef struct seen_vertex {
    double at[3];
    int kind; /* of the constraint; -1: none */
    double gap, normal[3];
} seen_vertex;

#define INSIDE VOX_CONSTRAINT_INSIDE
#define NEAR_BY VOX_CONSTRAINT_PROXIMITY
#define NONE (-1)
#define MOST_SEEN 16

/* What the shape says of each vertex, as floats and as doubles, in rows and in columns. */
static void check_seen(const vox_shape_desc* desc, const double* place, double margin, const seen_vertex* v,
                       uint32_t count, int has_triangles) {
    double rows[3 * MOST_SEEN], columns[3 * MOST_SEEN];
    float floats[3 * MOST_SEEN];
    ck_assert_uint_le(count, MOST_SEEN);
    for (uint32_t i = 0; i < 3 * count; ++i) {
        rows[i] = columns[i % 3 * count + i / 3] = v[i / 3].at[i % 3];
        floats[i] = (float)rows[i];
        ck_assert_double_eq((double)floats[i], rows[i]);
    }
    for (int format = 0; format < (count > 1 ? 3 : 2); ++format) {
        vox_grid* grid = constraint_grid();
        ck_ok(vox_grid_set_margin(grid, margin));
        const vox_body shape = insert_shape(grid, desc);
        if (place) ck_ok(vox_body_set_transform(grid, shape, place));
        vox_mesh_desc mesh = vox_mesh_desc_floats(floats, count, NULL, 0);
        if (format) mesh.positions = vox_double_positions(format == 1 ? rows : columns, count);
        if (format == 2) {
            mesh.positions.byte_stride = sizeof(double);
            mesh.positions.component_byte_stride = count * sizeof(double);
        }
        const vox_body points = insert_mesh(grid, &mesh);
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_eq(contacts_of(grid).count, 0);
        for (uint32_t i = 0; i < count; ++i) {
            const vox_constraint* c = find_constraint(grid, points, i, shape);
            ck_assert_msg((c ? (int)c->kind : NONE) == v[i].kind, "vertex %u: %d, expected %d", i,
                          c ? (int)c->kind : NONE, v[i].kind);
            if (!c) continue;
            ck_assert_double_eq_tol(c->gap, v[i].gap, 1e-15);
            for (int k = 0; k < 3; ++k) {
                ck_assert_msg(fabs(c->normal[k] - v[i].normal[k]) < 1e-13, "vertex %u: normal (%g, %g, %g)",
                              i, c->normal[0], c->normal[1], c->normal[2]);
                ck_assert_double_eq(c->position[k], v[i].at[k]);
            }
            if (v[i].gap == 0) ck_assert(c->gap == 0);
            ck_assert_int_eq(c->state, v[i].gap == 0 ? VOX_DEPTH_TOUCHING : VOX_DEPTH_CLOSEST);
            ck_assert(has_triangles ? c->element_b < desc->triangle_count + 8 : c->element_b == VOX_NONE);
            ck_assert_uint_eq(c->count, 1);
            ck_assert_double_eq(c->time, 1);
            ck_assert_double_eq_tol(c->offset + v[i].at[0] * c->normal[0] + v[i].at[1] * c->normal[1] +
                                        v[i].at[2] * c->normal[2],
                                    c->gap, 1e-13);
        }
        vox_grid_destroy(grid);
    }
}

#define CHECK_SEEN(desc, place, margin, vertices, has_triangles)                                             \
    check_seen(desc, place, margin, vertices, (uint32_t)(sizeof vertices / sizeof *(vertices)), has_triangles)

START_TEST(half_spaces) {
    static const seen_vertex all[] = {{{7, -3, 0}, INSIDE, 0, {0, 0, 1}},
                                      {{1e6f, 1e6f, -2}, INSIDE, -2, {0, 0, 1}},
                                      {{0, 0, 0.25}, NEAR_BY, 0.25, {0, 0, 1}},
                                      {{0, 0, 0.25f + 1e-7f}, NONE, 0, {0, 0, 0}},
                                      {{0, 0, 0x1p-149}, NEAR_BY, 0x1p-149, {0, 0, 1}},
                                      {{-5, 2, -0x1p-149}, INSIDE, -0x1p-149, {0, 0, 1}}};
    const vox_shape_desc floor = shape_desc(VOX_SHAPE_HALF_SPACE);
    CHECK_SEEN(&floor, NULL, 0.25, all, 0);
}
END_TEST

START_TEST(round_shapes) {
    static const seen_vertex of_ball[] = {{{0, 0, 0}, INSIDE, -5, {0, 0, 1}},
                                          {{3, 4, 0}, INSIDE, 0, {0.6, 0.8, 0}},
                                          {{0, -3, -4}, INSIDE, 0, {0, -0.6, -0.8}},
                                          {{6, 8, 0}, NEAR_BY, 5, {0.6, 0.8, 0}},
                                          {{3, 4, 0x1p-20}, NEAR_BY, 0x1p-40 / 10, {0.6, 0.8, 0x1p-20 / 5}},
                                          {{8, 8, 0}, NONE, 0, {0, 0, 0}}};
    static const seen_vertex of_capsule[] = {{{5, 0, 1}, INSIDE, 0, {1, 0, 0}},
                                             {{0, 0, 2}, INSIDE, -5, {1, 0, 0}},
                                             {{3, 0, 6}, INSIDE, 0, {0.6, 0, 0.8}},
                                             {{0, -4, -5}, INSIDE, 0, {0, -0.8, -0.6}},
                                             {{0, 0, 8}, NEAR_BY, 1, {0, 0, 1}}};
    static const seen_vertex of_cylinder[] = {{{3, 4, 2}, INSIDE, 0, {0.6, 0.8, 0}},
                                              {{0, 0, 2}, INSIDE, 0, {0, 0, 1}},
                                              {{0, 0, -1.5}, INSIDE, -0.5, {0, 0, -1}},
                                              {{4.75, 0, 0}, INSIDE, -0.25, {1, 0, 0}},
                                              {{3, 4, 3}, NEAR_BY, 1, {0, 0, 1}},
                                              {{8, 0, -6}, NEAR_BY, 5, {0.6, 0, -0.8}},
                                              {{3, 4, 2 + 0x1p-20}, NEAR_BY, 0x1p-20, {0, 0, 1}}};
    const vox_shape_desc ball = round_shape(VOX_SHAPE_SPHERE, 5, 0),
                         capsule = round_shape(VOX_SHAPE_CAPSULE, 5, 2),
                         cylinder = round_shape(VOX_SHAPE_CYLINDER, 5, 2);
    CHECK_SEEN(&ball, NULL, 5, of_ball, 0);
    CHECK_SEEN(&capsule, NULL, 5, of_capsule, 0);
    CHECK_SEEN(&cylinder, NULL, 5, of_cylinder, 0);
}
END_TEST

/* A box and the solid with the same surface. */
START_TEST(boxes_and_solids) {
    static const seen_vertex all[] = {{{1, 0.25, 0}, INSIDE, 0, {1, 0, 0}},
                                      {{0.5, 0.25, 0}, INSIDE, -0.5, {1, 0, 0}},
                                      {{0.25, -0.75, 0}, INSIDE, -0.25, {0, -1, 0}},
                                      {{0, 0.5, -1}, INSIDE, 0, {0, 0, -1}},
                                      {{2, 0.5, 0.25}, NEAR_BY, 1, {1, 0, 0}},
                                      {{1.75, 2, 0}, NEAR_BY, 1.25, {0.6, 0.8, 0}},
                                      {{2, 3, 3}, NEAR_BY, 3, {1 / 3., 2 / 3., 2 / 3.}},
                                      {{0.5, -0.5, 4.5}, NONE, 0, {0, 0, 0}},
                                      {{1 + 0x1p-23, 0.25, 0}, NEAR_BY, 0x1p-23, {1, 0, 0}}};
    const vox_shape_desc box = box_shape(1, 1, 1), solid = cube_solid();
    CHECK_SEEN(&box, NULL, 3, all, 0);
    CHECK_SEEN(&solid, NULL, 3, all, 1);
}
END_TEST

/* On corners and edges, which is inside with any normal; vertical faces, and the diagonals of faces. */
START_TEST(corners_and_edges) {
    double at[3 * 27];
    for (int i = 0; i < 27; ++i)
        for (int k = 0; k < 3; ++k) at[3 * i + k] = (k == 0 ? i % 3 : k == 1 ? i / 3 % 3 : i / 9) - 1;
    vox_shape_desc shapes[3] = {box_shape(1, 1, 1), cube_solid(), cube_solid()};
    double sheared[24]; /* along z */
    for (int i = 0; i < 24; ++i) sheared[i] = cube_points[i] + (i % 3 == 2 ? 0.5 * cube_points[i - 2] : 0);
    shapes[2].positions = vox_double_positions(sheared, 8);
    for (int s = 0; s < 3; ++s) {
        vox_grid* grid = constraint_grid();
        if (s == 2)
            for (int i = 0; i < 27; ++i) at[3 * i + 2] += 0.5 * at[3 * i];
        const vox_body shape = insert_shape(grid, &shapes[s]), points = insert_points(grid, at, 27);
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_eq(constraints_of(grid).count, 27);
        for (uint32_t i = 0; i < 27; ++i) {
            const vox_constraint* c = find_constraint(grid, points, i, shape);
            ck_assert_int_eq(c->kind, VOX_CONSTRAINT_INSIDE);
            ck_assert((c->gap == 0) == (i != 13));
        }
        vox_grid_destroy(grid);
    }
}
END_TEST

START_TEST(terrain) {
    static const double heights[6] = {0, 0, 1, 0, 2, 1};
    static const seen_vertex all[] = {
        {{0, 0, 0}, INSIDE, 0, {0, 0, 1}},         {{1, 0, 0}, INSIDE, 0, {0, 0, 1}},
        {{0.5, 0.125, -4}, INSIDE, -4, {0, 0, 1}}, {{0.5, 0.125, 3}, NONE, 0, {0, 0, 0}},
        {{-0.25, 0, -1}, NONE, 0, {0, 0, 0}}, /* beside it */
        {{2, 0, 1}, INSIDE, 0, {-1, 0, 1}},        {{2.25, 0.25, 0.5}, NONE, 0, {0, 0, 0}}};
    vox_shape_desc desc = shape_desc(VOX_SHAPE_HEIGHTFIELD);
    desc.heights = heights;
    desc.columns = 3;
    desc.rows = 2;
    desc.spacing[0] = desc.spacing[1] = 1;
    vox_grid* grid = constraint_grid();
    double at[21];
    for (int i = 0; i < 21; ++i) at[i] = all[i / 3].at[i % 3];
    const vox_body shape = insert_shape(grid, &desc), points = insert_points(grid, at, 7);
    ck_ok(vox_grid_step(grid));
    for (uint32_t i = 0; i < 7; ++i) {
        const vox_constraint* c = find_constraint(grid, points, i, shape);
        ck_assert_int_eq(c ? (int)c->kind : NONE, all[i].kind);
        if (!c) continue;
        ck_assert(all[i].gap == 0 ? c->gap == 0 : c->gap < 0);
        ck_assert(c->normal[2] > 0 && c->element_b < 4);
    }
    vox_grid_destroy(grid);
}
END_TEST

/* Many vertices in one block, of which one end is below terrain and the other is beside it. */
START_TEST(below_the_border_of_terrain) {
    static const double heights[4] = {0, 0, 0, 0};
    double at[3 * 8];
    for (int i = 0; i < 8; ++i) {
        at[3 * i] = i - 6.5;
        at[3 * i + 1] = 5;
        at[3 * i + 2] = -50;
    }
    vox_shape_desc desc = shape_desc(VOX_SHAPE_HEIGHTFIELD);
    desc.heights = heights;
    desc.columns = desc.rows = 2;
    desc.spacing[0] = desc.spacing[1] = 10;
    vox_grid* grid = constraint_grid();
    (void)insert_shape(grid, &desc);
    (void)insert_points(grid, at, 8);
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(constraints_of(grid).count, 1);
    ck_assert_uint_eq(constraints_of(grid).data[0].vertices[0], 7);
    ck_assert_double_eq(constraints_of(grid).data[0].gap, -50);
    vox_grid_destroy(grid);
}
END_TEST

START_TEST(sheets_and_needles) {
    static const seen_vertex of_sheet[] = {{{0.5, 0.25, 0}, INSIDE, 0, {0, 0, 1}},
                                           {{1, 1, 0}, INSIDE, 0, {0, 0, 1}},
                                           {{0.25, 0.5, 0.5}, NEAR_BY, 0.5, {0, 0, 1}},
                                           {{0.25, 0.5, -0.5}, NEAR_BY, 0.5, {0, 0, -1}},
                                           {{1.375, 0, 0.5}, NEAR_BY, 0.625, {0.6, 0, 0.8}},
                                           {{1 + 0x1p-23, 0, 0}, NEAR_BY, 0x1p-23, {1, 0, 0}},
                                           {{0, 0, 2}, NONE, 0, {0, 0, 0}}};
    static const seen_vertex of_plate[] = {{{0.5, 0.25, 0}, INSIDE, -0.5, {0, 0, 1}},
                                           {{0.25, 0.5, -0.5}, INSIDE, 0, {0, 0, -1}},
                                           {{1.375, 0, -0.5}, NEAR_BY, 0.125, {0.6, 0, -0.8}}};
    static const seen_vertex of_needle[] = {{{0.5, 0, 1}, INSIDE, 0, {1, 0, 0}},
                                            {{0, -0.25, 1}, INSIDE, -0.25, {0, -1, 0}},
                                            {{0.5, 0, 3}, NEAR_BY, 0.5, {1, 0, 0}},
                                            {{0, 0, 4.75}, NEAR_BY, 0.25, {0, 0, 1}}};
    static const double ends[9] = {0, 0, 0, 0, 0, 2, 0, 0, 4};
    static const uint32_t segments[6] = {0, 1, 1, 2, 1, 2};
    vox_shape_desc sheet = rectangle(VOX_SHAPE_SHEET),
                   needle = triangle_shape(VOX_SHAPE_SHEET, ends, 3, segments, 2);
    CHECK_SEEN(&sheet, NULL, 1, of_sheet, 1);
    sheet.radius = 0.5;
    CHECK_SEEN(&sheet, NULL, 1, of_plate, 1);
    needle.radius = 0.5;
    for (int i = 0; i < 4; ++i) {
        seen_vertex one[1] = {of_needle[i]};
        if (i == 2) one[0].gap = 0, one[0].kind = INSIDE;
        CHECK_SEEN(&needle, NULL, 1, one, 1);
    }
    /* On its axis, the way out is across. */
    static const double on_axis[3] = {0, 0, 1};
    vox_grid* grid = constraint_grid();
    (void)insert_shape(grid, &needle);
    (void)insert_points(grid, on_axis, 1);
    ck_ok(vox_grid_step(grid));
    ck_assert_double_eq(constraints_of(grid).data[0].gap, -0.5);
    ck_assert_double_eq(constraints_of(grid).data[0].normal[2], 0);
    vox_grid_destroy(grid);
}
END_TEST

/* Without a size, a shape has its surface still. */
START_TEST(nothing_but_surface) {
    static const double ends[6] = {-1, 0, 0, 1, 0, 0};
    static const uint32_t segment[3] = {0, 1, 1}, point[3] = {0, 0, 0}, flat[6] = {0, 1, 2, 0, 2, 1};
    static const double corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const struct {
        vox_shape_desc desc;
        double on[3], off[3];
    } all[] = {{round_shape(VOX_SHAPE_SPHERE, 0, 0), {0, 0, 0}, {0, 0x1p-1000, 0}},
               {round_shape(VOX_SHAPE_CAPSULE, 0, 1), {0, 0, 0.3}, {0, 0, 1.0000001}},
               {round_shape(VOX_SHAPE_CAPSULE, 0, 0), {0, 0, 0}, {0, 0, 1e-300}},
               {round_shape(VOX_SHAPE_CYLINDER, 0, 1), {0, 0, -1}, {1e-300, 0, 0}},
               {round_shape(VOX_SHAPE_CYLINDER, 5, 0), {3, 4, 0}, {0, 0, 0x1p-1074}},
               {box_shape(0, 0, 0), {0, 0, 0}, {0, 0, -0x1p-1074}},
               {box_shape(1, 0, 2), {0.3, 0, 1.7}, {0.3, 0x1p-1074, 1.7}},
               {triangle_shape(VOX_SHAPE_SHEET, ends, 2, segment, 1), {0.3, 0, 0}, {0.3, 0x1p-1074, 0}},
               {triangle_shape(VOX_SHAPE_SHEET, ends, 2, point, 1), {-1, 0, 0}, {-1, 0, 0x1p-1074}},
               {triangle_shape(VOX_SHAPE_SOLID, corners, 3, flat, 2), {0.25, 0.5, 0}, {0.25, 0.5, -1e-300}}};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) {
        double at[6];
        memcpy(at, all[i].on, sizeof all[i].on);
        memcpy(at + 3, all[i].off, sizeof all[i].off);
        vox_grid* grid = constraint_grid();
        ck_ok(vox_grid_set_margin(grid, 1e-5));
        const vox_body shape = insert_shape(grid, &all[i].desc), points = insert_points(grid, at, 2);
        ck_ok(vox_grid_step(grid));
        const vox_constraint *on = find_constraint(grid, points, 0, shape),
                             *off = find_constraint(grid, points, 1, shape);
        ck_assert_msg(on && on->kind == VOX_CONSTRAINT_INSIDE && on->gap == 0, "shape %zu", i);
        ck_assert_msg(off && off->kind == VOX_CONSTRAINT_PROXIMITY && off->gap >= 0, "shape %zu", i);
        for (int k = 0; k < 2; ++k) {
            const double* n = k ? off->normal : on->normal;
            ck_assert_double_eq_tol(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-14);
        }
        vox_grid_destroy(grid);
    }
}
END_TEST

/* Of a ball, half as long as a distance may be. */
static void half_distances(const double* points, uint64_t count, double* distances, double* gradients,
                           void* user) {
    const double radius = *(const double*)user;
    ck_assert_uint_le(count, 8);
    for (uint64_t i = 0; i < count; ++i) {
        const double* p = points + 3 * i;
        const double to = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) - radius;
        distances[i] = to > 0 ? 0.5 * to : to;
        for (int k = 0; k < 3; ++k) gradients[3 * i + (uint64_t)k] = 7 * p[k];
    }
}

START_TEST(fields) {
    static double radius = 1;
    static const seen_vertex all[] = {{{0, 0, 0}, INSIDE, -1, {0, 0, 1}},
                                      {{0, 1, 0}, INSIDE, 0, {0, 1, 0}},
                                      {{0, 0.5, 0}, INSIDE, -0.5, {0, 1, 0}},
                                      {{0, 0, -1.5}, NEAR_BY, 0.25, {0, 0, -1}},
                                      {{0, 0, -2}, NONE, 0, {0, 0, 0}}};
    vox_shape_desc desc = box_shape(1, 1, 1);
    desc.kind = VOX_SHAPE_FIELD;
    desc.field = half_distances;
    desc.field_user = &radius;
    CHECK_SEEN(&desc, NULL, 0.25, all, 0);
}
END_TEST

/* ---- transforms --------------------------------------------------------------------------------- */

START_TEST(placed) {
    /* z goes to x, x to y, y to z; twice as large, and moved. */
    static const double place[12] = {0, 0, 2, 10, 2, 0, 0, 20, 0, 2, 0, 30};
    static const seen_vertex of_floor[] = {{{10, 5, 5}, INSIDE, 0, {1, 0, 0}},
                                           {{8, 0, 0}, INSIDE, -2, {1, 0, 0}},
                                           {{11, 0, 0}, NEAR_BY, 1, {1, 0, 0}},
                                           {{12, 0, 0}, NONE, 0, {0, 0, 0}}};
    static const seen_vertex of_ball[] = {{{10, 26, 38}, INSIDE, 0, {0, 0.6, 0.8}},
                                          {{10, 20, 41}, NEAR_BY, 1, {0, 0, 1}},
                                          {{10, 20, 39}, INSIDE, -1, {0, 0, 1}}};
    static const seen_vertex of_solid[] = {{{12, 20, 30.5}, INSIDE, 0, {1, 0, 0}},
                                           {{10, 21, 30.25}, INSIDE, -1, {0, 1, 0}},
                                           {{10, 20, 27}, NEAR_BY, 1, {0, 0, -1}}};
    const vox_shape_desc floor = shape_desc(VOX_SHAPE_HALF_SPACE), ball = round_shape(VOX_SHAPE_SPHERE, 5, 0),
                         solid = cube_solid();
    CHECK_SEEN(&floor, place, 1, of_floor, 0);
    CHECK_SEEN(&ball, place, 1, of_ball, 0);
    CHECK_SEEN(&solid, place, 1, of_solid, 1);
    /* Upside down is a rotation. */
    static const double down[12] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0};
    static const seen_vertex of_ceiling[] = {{{3, 3, 2}, INSIDE, -2, {0, 0, -1}},
                                             {{0, 0, -2}, NONE, 0, {0, 0, 0}}};
    CHECK_SEEN(&floor, down, 1, of_ceiling, 0);
}
END_TEST

START_TEST(refused_transforms) {
    static const double zero[12] = {0}, mirror[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0},
                        shear[12] = {1, 0.25, 0, 0, 0, 0.968245836551854256, 0, 0, 0, 0, 1, 0},
                        uneven[12] = {1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0},
                        tiny[12] = {1e-31, 0, 0, 0, 0, 1e-31, 0, 0, 0, 0, 1e-31, 0},
                        off[12] = {1, 0, 0, 0, 0, 1 + 2e-5, 0, 0, 0, 0, 1, 0},
                        nearly[12] = {1, 0, 0, 0, 0, 1 + 9e-6, 0, 0, 0, 0, 1, 0},
                        far[12] = {1, 0, 0, 0, 0, 1, 0, -1e300, 0, 0, 1, 0},
                        nan[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, NAN, 1, 0};
    const struct {
        const double* matrix;
        const char* words;
    } all[] = {{zero, "scales the axes by 0, 0 and 0"},
               {mirror, "mirrors (its determinant is -1)"},
               {shear, "their cosine is 0.25"},
               {uneven, "scales the axes by 1, 2 and 1"},
               {tiny, "scales the axes by 1e-31"},
               {off, "scales the axes by 1, 1.00002 and 1"},
               {far, "[7] is -1e+300, the limit is 3.40282e+38"},
               {nan, "matrix[9] is nan"}};
    static const double at[3] = {0, 0, -1};
    vox_grid* grid = constraint_grid();
    const vox_shape_desc floor = shape_desc(VOX_SHAPE_HALF_SPACE);
    const vox_body shape = insert_shape(grid, &floor), points = insert_points(grid, at, 1);
    ck_ok(vox_body_set_transform(grid, shape, nearly));
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) {
        ck_fails(vox_body_set_transform(grid, shape, all[i].matrix), VOX_ERROR_INVALID_ARGUMENT,
                 all[i].words);
        ck_fails(vox_shape_set_previous_transform(grid, shape, all[i].matrix), VOX_ERROR_INVALID_ARGUMENT,
                 all[i].words);
    }
    for (int i = 1; i < 5; ++i) /* which a mesh takes */
        ck_ok(vox_body_set_transform(grid, points, all[i].matrix));
    ck_ok(vox_body_set_transform(grid, points, NULL));
    vox_body_info info;
    info.struct_size = sizeof info;
    ck_ok(vox_body_get_info(grid, shape, &info)); /* nothing has changed */
    ck_assert_mem_eq(info.transform, nearly, sizeof nearly);
    ck_ok(vox_grid_step(grid));
    ck_assert_double_eq(constraints_of(grid).data[0].gap, -1);
    vox_grid_destroy(grid);
}
END_TEST

/* ---- impacts ------------------------------------------------------------------------------------ */

/* The vertex, the shape, or both move by so much along z, from `from` on. Checks the impact: when, where to,
 * how far behind. */
static void check_impact(const vox_shape_desc* desc, const double from[3], double way, double time,
                         double up) {
    for (int who = 0; who < 3; ++who) {
        const double of_vertex = who == 0 ? way : who == 1 ? 0 : 0.25 * way;
        double to[3] = {from[0], from[1], from[2] + of_vertex}, before[12];
        vox_grid* grid = constraint_grid();
        const vox_body shape = insert_shape(grid, desc), points = insert_points(grid, to, 1);
        if (who != 1) ck_ok(bind_previous_array(grid, points, from, VOX_FORMAT_DOUBLE, 0, 0));
        memcpy(before, unmoved, sizeof before);
        move_shape(grid, shape, 0, 0, of_vertex - way);
        if (who > 0) ck_ok(vox_shape_set_previous_transform(grid, shape, before));
        ck_ok(vox_grid_step(grid));
        const vox_constraint* c = find_constraint(grid, points, 0, shape);
        if (up == 0) {
            ck_assert_ptr_null(c);
            ck_assert_int_eq(only_pair(grid), -1);
        } else {
            ck_assert_ptr_nonnull(c);
            ck_assert_int_eq(c->kind, VOX_CONSTRAINT_IMPACT);
            ck_assert_int_eq(c->state, VOX_DEPTH_PLANE);
            ck_assert_double_eq_tol(c->time, time, 1e-12);
            ck_assert_double_eq_tol(c->normal[2], up, 1e-12);
            ck_assert_double_eq_tol(c->gap, (1 - time) * way * up, 1e-12);
            ck_assert_int_eq(only_pair(grid), VOX_PAIR_BEGAN);
        }
        vox_grid_destroy(grid);
    }
}

START_TEST(went_through) {
    static const double above[3] = {0.3, 0.1, 3}, below[3] = {0.3, 0.1, -3}, beside[3] = {1.5, 0, 3},
                        on_axis[3] = {0, 0, 3}, ends[6] = {-5, 0.1, 0, 5, 0.1, 0};
    static const uint32_t segment[3] = {0, 1, 1};
    vox_shape_desc sheet = rectangle(VOX_SHAPE_SHEET),
                   needle = triangle_shape(VOX_SHAPE_SHEET, ends, 2, segment, 1),
                   ball = round_shape(VOX_SHAPE_SPHERE, 1, 0);
    const vox_shape_desc solid = cube_solid(), box = box_shape(1, 1, 1),
                         capsule = round_shape(VOX_SHAPE_CAPSULE, 0.5, 0.5),
                         cylinder = round_shape(VOX_SHAPE_CYLINDER, 1, 1);
    check_impact(&sheet, above, -6, 0.5, 1);
    check_impact(&sheet, below, 6, 0.5, -1); /* from either side */
    check_impact(&sheet, beside, -6, 0, 0);
    check_impact(&sheet, above, 6, 0, 0); /* away */
    sheet.radius = 0.5;
    check_impact(&sheet, above, -6, 2.5 / 6, 1);
    needle.radius = 1e-4; /* much thinner than the way is long */
    check_impact(&needle, above, -6, (3 - 1e-4) / 6, 1);
    check_impact(&ball, on_axis, -6, 2 / 6., 1);
    check_impact(&ball, beside, -6, 0, 0);
    check_impact(&capsule, on_axis, -6, 2 / 6., 1);
    check_impact(&cylinder, above, -6, 2 / 6., 1);
    check_impact(&box, below, 6, 2 / 6., -1);
    check_impact(&solid, below, 6, 2 / 6., -1);
    static double radius = 1;
    vox_shape_desc field = box_shape(1, 1, 1);
    field.kind = VOX_SHAPE_FIELD;
    field.field = half_distances;
    field.field_user = &radius;
    check_impact(&field, on_axis, -6, 2 / 6., 1);
    check_impact(&field, beside, -6, 0, 0);
    ball.radius = 0; /* through the centre */
    check_impact(&ball, on_axis, -6, 0.5, 1);
}
END_TEST

/* A vertex ends inside; begins inside and leaves; is turned around with the shape. */
START_TEST(in_out_and_around) {
    double at[6] = {0, 0, -1, 0, 0, 1};
    static const double from[6] = {0, 0, 3, 0, 0, -1};
    vox_grid* grid = constraint_grid();
    const vox_shape_desc floor = shape_desc(VOX_SHAPE_HALF_SPACE);
    const vox_body shape = insert_shape(grid, &floor), points = insert_points(grid, at, 2);
    ck_ok(bind_previous_array(grid, points, from, VOX_FORMAT_DOUBLE, 0, 0));
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(constraints_of(grid).count, 1);
    const vox_constraint* c = find_constraint(grid, points, 0, shape);
    ck_assert(c->kind == VOX_CONSTRAINT_INSIDE && fabs(c->time - 0.75) < 1e-12 && c->gap == -1);
    /* With the floor upside down before, the vertices go the other way through its frame. */
    static const double down[12] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0};
    ck_ok(bind_previous_array(grid, points, NULL, VOX_FORMAT_DOUBLE, 0, 0));
    ck_ok(vox_shape_set_previous_transform(grid, shape, down));
    ck_ok(vox_grid_step(grid));
    c = find_constraint(grid, points, 0, shape);
    ck_assert(c->kind == VOX_CONSTRAINT_INSIDE && fabs(c->time - 0.5) < 1e-12);
    ck_ok(vox_shape_set_previous_transform(grid, shape, NULL));
    ck_ok(vox_grid_step(grid));
    ck_assert_double_eq(find_constraint(grid, points, 0, shape)->time, 1);
    vox_grid_destroy(grid);
}
END_TEST

/* A vertex on one triangle, or closer to it than rounding errors, leaves that one, and goes through another.
 */
START_TEST(leaves_and_goes_through) {
    static const double corners[18] = {-1, -1, 0, 1, -1, 0, 0, 1, 0, -1, -1, 1, 1, -1, 1, 0, 1, 1};
    static const uint32_t triangles[6] = {0, 1, 2, 3, 4, 5};
    static const struct {
        double from[3], to_z;
        double time; /* -1: it meets nothing */
        uint32_t triangle;
    } all[] = {{{0, 0, 1e-18}, 2, 0.5, 1}, {{0, 0, 1e-18}, -2, 0, 0}, {{0, 0, 0}, 2, 0.5, 1},
               {{0, 0, 0}, 0.75, -1, 0},   {{0, 0, 0}, -2, -1, 0},    {{0, -1, 0}, 2, 0.5, 1},
               {{0, -1, 0}, -2, -1, 0},    {{-1, -1, 0}, 2, 0.5, 1},  {{-1, -1, 0}, -2, -1, 0},
               {{0, 0, 1}, -1, 0.5, 0},    {{0, 0, 1}, 2, -1, 0}};
    const vox_shape_desc sheet = triangle_shape(VOX_SHAPE_SHEET, corners, 6, triangles, 2);
    for (size_t i = 0; i < sizeof all / sizeof all[0]; ++i) {
        const double* const from = all[i].from;
        const double to[3] = {from[0], from[1], all[i].to_z};
        vox_grid* grid = constraint_grid();
        (void)insert_shape(grid, &sheet);
        const vox_body points = insert_points(grid, to, 1);
        ck_ok(bind_previous_array(grid, points, from, VOX_FORMAT_DOUBLE, 0, 0));
        ck_ok(vox_grid_step(grid));
        ck_assert_msg(constraints_of(grid).count == (all[i].time >= 0), "case %zu", i);
        if (all[i].time >= 0) {
            const vox_constraint* c = &constraints_of(grid).data[0];
            ck_assert_int_eq(c->kind, VOX_CONSTRAINT_IMPACT);
            ck_assert_double_eq_tol(c->time, all[i].time, 1e-12);
            ck_assert_double_eq_tol(c->gap, -(1 - all[i].time) * fabs(to[2] - from[2]), 1e-12);
            ck_assert_uint_eq(c->element_b, all[i].triangle);
        }
        vox_grid_destroy(grid);
    }
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, half_spaces, round_shapes, boxes_and_solids, corners_and_edges, terrain,
                   below_the_border_of_terrain, sheets_and_needles, nothing_but_surface, fields, placed,
                   refused_transforms, went_through, in_out_and_around, leaves_and_goes_through);
}

SUITE(shapes) { add_for_each_engine(suite, add_tests); }
