/* Shapes and loose vertices in a grid, for tests of both. */
#ifndef VOX_TESTS_SHAPE_CHECKS_H
#define VOX_TESTS_SHAPE_CHECKS_H

#include "support/constraint_checks.h"

static const double unmoved[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

static inline vox_shape_desc shape_desc(vox_shape_kind kind) {
    vox_shape_desc desc = vox_default_shape_desc();
    desc.kind = kind;
    return desc;
}

static inline vox_shape_desc round_shape(vox_shape_kind kind, double radius, double half_length) {
    vox_shape_desc desc = shape_desc(kind);
    desc.radius = radius;
    desc.half_length = half_length;
    return desc;
}

static inline vox_shape_desc box_shape(double x, double y, double z) {
    vox_shape_desc desc = shape_desc(VOX_SHAPE_BOX);
    desc.half_size[0] = x;
    desc.half_size[1] = y;
    desc.half_size[2] = z;
    return desc;
}

static inline vox_shape_desc triangle_shape(vox_shape_kind kind, const double* xyz, uint64_t points,
                                            const uint32_t* triangles, uint64_t triangle_count) {
    vox_shape_desc desc = shape_desc(kind);
    desc.positions = vox_double_positions(xyz, points);
    desc.triangles = triangles;
    desc.triangle_count = triangle_count;
    return desc;
}

/* The surface of a cube from -1 to 1. */
static const double cube_points[24] = {-1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1,
                                       -1, -1, 1,  1, -1, 1,  -1, 1, 1,  1, 1, 1};
static const uint32_t cube_triangles[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                            2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
static inline vox_shape_desc cube_solid(void) {
    return triangle_shape(VOX_SHAPE_SOLID, cube_points, 8, cube_triangles, 12);
}

/* A rectangle in z = 0, from -1 to 1. */
static const uint32_t rectangle_triangles[6] = {0, 1, 3, 0, 3, 2};
static inline vox_shape_desc rectangle(vox_shape_kind kind) {
    static const double points[12] = {-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0};
    return triangle_shape(kind, points, 4, rectangle_triangles, 2);
}

static inline vox_body insert_shape(vox_grid* grid, const vox_shape_desc* desc) {
    vox_body shape = VOX_NULL_BODY;
    ck_ok(vox_shape_insert(grid, desc, &shape));
    return shape;
}

/* Vertices without tetrahedra; the array is borrowed. */
static inline vox_body insert_points(vox_grid* grid, const double* xyz, uint64_t count) {
    const vox_mesh_desc desc = vox_mesh_desc_doubles(xyz, count, NULL, 0);
    return insert_mesh(grid, &desc);
}

static inline void move_shape(vox_grid* grid, vox_body shape, double x, double y, double z) {
    double m[12];
    memcpy(m, unmoved, sizeof m);
    m[3] = x;
    m[7] = y;
    m[11] = z;
    ck_ok(vox_body_set_transform(grid, shape, m));
}

/* A grid that finds constraints. */
static inline vox_grid* constraint_grid(void) {
    vox_grid_desc desc = engine_desc();
    desc.flags = VOX_GRID_CONSTRAINTS;
    return grid_of(&desc);
}

/* The state of the only pair of the last step; -1: there is none. */
static inline int only_pair(const vox_grid* grid) {
    const vox_pair_view view = pairs_of(grid);
    ck_assert_uint_le(view.count, 1);
    return view.count ? (int)view.data[0].state : -1;
}

static inline int stepped_pair(vox_grid* grid) {
    ck_ok(vox_grid_step(grid));
    return only_pair(grid);
}

#endif
