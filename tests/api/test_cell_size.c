/* The cell size: what the geometry of small scenes must be by hand, and that the answer is the minimum of the
 * cost function, in any unit. */
#include "support/suggest_scenes.h"
#include "tools/zone_distance.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define CLOSE(value, expected) ck_assert_double_eq_tol(value, expected, 1e-14 * fabs((double)(expected)))

/* ---- geometry --------------------------------------------------------------------------------- */

START_TEST(one_regular_tet) {
    const vox_mesh_desc mesh = vox_mesh_desc_floats(regular_positions, 4, unit_tet, 1);
    const vox_cell_size_result found = suggest_ok(NULL, &mesh, 1);
    const vox_geometry measured = geometry_of(&mesh, 1), *stats = &measured;
    ck_assert_uint_eq(stats->vertices, 4);
    ck_assert_uint_eq(stats->tets, 1);
    ck_assert_uint_eq(stats->edges, 6);
    ck_assert_uint_eq(stats->facets, 4);
    ck_assert_uint_eq(stats->boundary_facets, 4);
    ck_assert_uint_eq(stats->degenerate_tets, 0);
    CLOSE(stats->mean_edge, sqrt(2));
    CLOSE(stats->mean_longest_edge, sqrt(2));
    CLOSE(stats->mean_box_side, 1);
    CLOSE(stats->median_box_side, 1);
    CLOSE(stats->mean_facet_area, sqrt(3) / 2);
    CLOSE(stats->mean_tet_facet_area, sqrt(3) / 2);
    CLOSE(stats->mean_boundary_facet_area, sqrt(3) / 2);
    CLOSE(stats->mean_volume, 1.0 / 3);
    for (int axis = 0; axis < 3; ++axis) {
        ck_assert_double_eq(stats->bounds_min[axis], 0);
        ck_assert_double_eq(stats->bounds_max[axis], 1);
    }
    ck_assert_uint_eq(found.rule_count, 5);
    CLOSE(rule_size(&found, "mean edge (Teschner"), sqrt(2));
    CLOSE(rule_size(&found, "2 mean edges"), 2 * sqrt(2));
    CLOSE(rule_size(&found, "512"), 1.0 / 8);
    CLOSE(rule_size(&found, "mean volume"), cbrt(1.0 / 3));
    CLOSE(rule_size(&found, "median box side"), 1);
    /* For regular tets the paper's model chooses a cell of about 1.45 edges. */
    ck_assert_double_eq_tol(found.cell_size / sqrt(2), 1 / 0.69, 0.01);
    CLOSE(found.cells_per_axis, 1 / found.cell_size);
}
END_TEST

/* Two tets share a facet: 9 edges, 7 facets, 6 of them on the boundary. */
START_TEST(shared_facets_count_once) {
    static const float positions[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
    static const uint32_t tets[8] = {0, 1, 2, 3, 3, 4, 2, 1};
    const vox_mesh_desc mesh = vox_mesh_desc_floats(positions, 5, tets, 2);
    const vox_geometry stats = geometry_of(&mesh, 1);
    const double half = 0.5, slanted = sqrt(3) / 2;
    ck_assert_uint_eq(stats.edges, 9);
    ck_assert_uint_eq(stats.facets, 7);
    ck_assert_uint_eq(stats.boundary_facets, 6);
    CLOSE(stats.mean_edge, (3 + 6 * sqrt(2)) / 9);
    CLOSE(stats.mean_facet_area, (3 * half + 4 * slanted) / 7);
    CLOSE(stats.mean_tet_facet_area, (3 * half + 5 * slanted) / 8);
    CLOSE(stats.mean_boundary_facet_area, (3 * half + 3 * slanted) / 6);
    CLOSE(stats.mean_volume, (1.0 / 6 + 1.0 / 3) / 2);
}
END_TEST

/* Euler's formula and the facet sum hold for a ball-like body of any resolution. */
START_TEST(box_counts) {
    const uint32_t n = (uint32_t)_i;
    body box = make_box(n, 0.5f, 0, 0, 0);
    const vox_mesh_desc mesh = body_desc(&box);
    const vox_geometry stats = geometry_of(&mesh, 1);
    const uint64_t tets = 5 * (uint64_t)n * n * n, boundary = 12 * (uint64_t)n * n;
    ck_assert_uint_eq(stats.tets, tets);
    ck_assert_uint_eq(stats.vertices, (uint64_t)(n + 1) * (n + 1) * (n + 1));
    ck_assert_uint_eq(stats.boundary_facets, boundary);
    ck_assert_uint_eq(2 * stats.facets, 4 * tets + boundary);
    ck_assert_uint_eq(stats.vertices + stats.facets, 1 + stats.edges + tets);
    CLOSE(stats.mean_boundary_facet_area, 0.125);
    CLOSE(stats.mean_box_side, 0.5);
    ck_assert_double_eq_tol(stats.mean_volume, 0.125 / 5, 1e-12);
    free_body(&box);
}
END_TEST

START_TEST(bodies_are_measured_together) {
    static const float big[12] = {0, 0, 0, 3, 3, 0, 3, 0, 3, 0, 3, 3};
    static const float points[6] = {-5, 0, 0, 0, 7, 0};
    vox_mesh_desc meshes[3];
    meshes[0] = vox_mesh_desc_floats(regular_positions, 4, unit_tet, 1);
    meshes[1] = vox_mesh_desc_floats(big, 4, unit_tet, 1);
    meshes[2] = vox_mesh_desc_floats(points, 2, NULL, 0);
    const vox_cell_size_result found = suggest_ok(NULL, meshes, 3);
    const vox_geometry stats = geometry_of(meshes, 3);
    ck_assert_uint_eq(stats.vertices, 10);
    ck_assert_uint_eq(stats.edges, 12);
    ck_assert_uint_eq(stats.boundary_facets, 8);
    CLOSE(stats.mean_edge, 2 * sqrt(2));
    CLOSE(stats.mean_facet_area, sqrt(3) / 2 * (1 + 9) / 2);
    CLOSE(stats.median_box_side, 2);                    /* the mean of the two middle ones */
    CLOSE(rule_size(&found, "512"), (1.0 + 3) / 2 / 8); /* the points' flat box has no 512 voxels */
    CLOSE(stats.bounds_min[0], -5);
    CLOSE(stats.bounds_max[1], 7);
    CLOSE(found.cells_per_axis * found.cell_size, 8);

    meshes[2] = meshes[1];
    const vox_geometry odd = geometry_of(meshes, 3);
    CLOSE(odd.median_box_side, 3);
    CLOSE(odd.mean_box_side, 7.0 / 3);

    /* No box with a volume: the rule of 512 voxels does not apply, and is in the array all the same. */
    static const float flat[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    meshes[0] = vox_mesh_desc_floats(flat, 4, unit_tet, 1);
    const vox_cell_size_result without = suggest_ok(NULL, meshes, 1);
    ck_assert_uint_eq(without.rule_count, found.rule_count);
    ck_assert_double_eq(rule_of(&without, "512").cell_size, 0);
    ck_assert_double_eq(rule_of(&without, "512").cost, 0);
}
END_TEST

START_TEST(unused_vertices_do_not_widen_the_bounds) {
    float positions[15] = {0, 0, 0, 1, 1, 0, 1, 0, 1, 0, 1, 1, 900, 900, 900};
    const vox_mesh_desc mesh = vox_mesh_desc_floats(positions, 5, unit_tet, 1);
    const vox_geometry stats = geometry_of(&mesh, 1);
    ck_assert_uint_eq(stats.vertices, 5);
    ck_assert_double_eq(stats.bounds_max[2], 1);
}
END_TEST

/* Zero volume is found exactly: a flat tet, one that names a vertex twice, and one flat but for the last bit.
 */
START_TEST(degenerate_tets_are_counted) {
    float positions[21] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0.3f, 0.3f, 0, 0, 0, 0, 0, 0, 0};
    static const uint32_t tets[16] = {0, 1, 2, 3, 0, 1, 2, 4, 0, 1, 2, 2, 0, 1, 2, 5};
    positions[15] = 0.25f;
    positions[16] = 0.25f;
    positions[17] = FLT_MIN * FLT_EPSILON; /* the smallest float above 0 */
    const vox_mesh_desc mesh = vox_mesh_desc_floats(positions, 7, tets, 4);
    const vox_geometry stats = geometry_of(&mesh, 1);
    ck_assert_uint_eq(stats.tets, 4);
    ck_assert_uint_eq(stats.degenerate_tets, 2);
    ck_assert_uint_eq(stats.facets, 10);         /* the tet with a vertex twice has none of its own */
    ck_assert_uint_eq(stats.boundary_facets, 9); /* facet 0 1 2 belongs to three tets */
    ck_assert_uint_eq(stats.edges, 12);
}
END_TEST

/* Any stride and any alignment; either winding. */
START_TEST(layout_and_winding_do_not_matter) {
    body box = make_uneven_box();
    vox_mesh_desc mesh = body_desc(&box);
    const vox_cell_size_result packed = suggest_ok(NULL, &mesh, 1);
    const vox_geometry as_packed = geometry_of(&mesh, 1);

    const size_t stride = 23;
    unsigned char* bytes = (unsigned char*)malloc(1 + stride * box.vertex_count);
    memset(bytes, 0xff, 1 + stride * box.vertex_count); /* what lies between is NaN */
    for (uint32_t v = 0; v < box.vertex_count; ++v)
        memcpy(bytes + 1 + stride * v, box.positions + 3 * v, 3 * sizeof(float));
    mesh.positions.data = bytes + 1;
    mesh.positions.byte_stride = stride;
    const vox_cell_size_result strided = suggest_ok(NULL, &mesh, 1);
    ck_assert_mem_eq(&strided, &packed, sizeof packed);
    const vox_geometry as_strided = geometry_of(&mesh, 1);
    ck_assert_mem_eq(&as_strided, &as_packed, sizeof as_packed);

    for (uint32_t t = 0; t < box.tet_count; ++t) {
        const uint32_t first = box.tets[4 * t];
        box.tets[4 * t] = box.tets[4 * t + 3];
        box.tets[4 * t + 3] = first;
    }
    ck_assert_double_eq(suggest_ok(NULL, &mesh, 1).cell_size, packed.cell_size);
    const vox_geometry flipped = geometry_of(&mesh, 1);
    CLOSE(flipped.mean_volume, as_packed.mean_volume);
    ck_assert_uint_eq(flipped.boundary_facets, as_packed.boundary_facets);
    free(bytes);
    free_body(&box);
}
END_TEST

/* ---- cost function ---------------------------------------------------------------------------- */

/* z as the paper has it (Eqs. 3 to 7), term by term. */
static double paper_z(double delta, double s, double area, double p_nc, double r) {
    const double v_o = pow(s / delta + 2, 3);
    const double p_v = 3 * (sqrt(3) / 2) * delta * delta / area;
    return p_nc * v_o + (1 - p_nc) * v_o * p_v * r;
}

/* The minimum of z by golden-section search over ln(delta). */
static double minimum_by_search(double s, double area, double p_nc, double r) {
    const double golden = (sqrt(5) - 1) / 2;
    double low = log(s) - 40, high = log(s) + 40;
    while (high - low > 1e-9) {
        const double left = high - golden * (high - low), right = low + golden * (high - low);
        if (paper_z(exp(left), s, area, p_nc, r) < paper_z(exp(right), s, area, p_nc, r))
            high = right;
        else
            low = left;
    }
    return exp((low + high) / 2);
}

static const struct {
    double p_nc, cost_ratio;
} parameters[] = {{0.99, 5}, {0.98, 5}, {0.99, 0.2}, {0.5, 1}, {1e-6, 100}, {0.999999, 1e-3}, {0.99, 1e12}};

START_TEST(cell_size_is_the_minimum_of_the_cost) {
    body box = make_uneven_box();
    const vox_mesh_desc mesh = body_desc(&box);
    const vox_geometry stats = geometry_of(&mesh, 1);
    const double s = stats.mean_edge, a = stats.mean_facet_area;
    const double p = parameters[_i].p_nc, r = parameters[_i].cost_ratio;
    vox_cell_size_desc desc = vox_default_cell_size_desc();
    desc.p_nc = p;
    desc.cost_ratio = r;
    const vox_cell_size_result found = suggest_ok(&desc, &mesh, 1);
    const double searched = minimum_by_search(s, a, p, r);
    ck_assert_double_eq_tol(found.cell_size, searched, 1e-6 * searched);
    const double K = (1 - p) * r * 3 * sqrt(3) / (2 * a), d = found.cell_size;
    ck_assert_double_eq_tol(4 * K * d * d * d - s * K * d * d, 3 * s * p,
                            1e-12 * (3 * s * p + s * K * d * d));
    ck_assert_double_eq_tol(found.cost, paper_z(d, s, a, p, r), 1e-12 * found.cost);
    const vox_cell_size_rule edge = rule_of(&found, "mean edge");
    ck_assert_double_eq_tol(edge.cost, paper_z(s, s, a, p, r), 1e-11 * edge.cost);

    ck_assert_uint_eq(found.curve_count, VOX_CURVE_CAPACITY);
    for (uint32_t i = 0; i < found.curve_count; ++i) {
        const double expected = d / 8 * pow(64, (double)i / (found.curve_count - 1));
        ck_assert_double_eq_tol(found.curve[i].cell_size, expected, 1e-12 * expected);
        const double z = paper_z(expected, s, a, p, r);
        ck_assert_double_eq_tol(found.curve[i].cost, z, 1e-11 * z);
        ck_assert_double_ge(found.curve[i].cost, found.cost);
    }
    free_body(&box);
}
END_TEST

START_TEST(zone_is_where_the_loss_is_small) {
    static const double losses[] = {1e-6, 0.01, 0.05, 0.5, 20, 1e6};
    body box = make_uneven_box();
    const vox_mesh_desc mesh = body_desc(&box);
    vox_cell_size_desc desc = vox_default_cell_size_desc();
    desc.p_nc = parameters[_i].p_nc;
    desc.cost_ratio = parameters[_i].cost_ratio;
    const vox_geometry stats = geometry_of(&mesh, 1);
    const double s = stats.mean_edge, a = stats.mean_facet_area;
    double last_min = HUGE_VAL, last_max = 0;
    for (size_t i = 0; i < sizeof losses / sizeof losses[0]; ++i) {
        desc.zone_loss = losses[i];
        const vox_cell_size_result found = suggest_ok(&desc, &mesh, 1);
        const double limit = (1 + losses[i]) * found.cost;
        ck_assert_double_lt(found.zone_min, found.cell_size);
        ck_assert_double_gt(found.zone_max, found.cell_size);
        ck_assert_double_eq_tol(paper_z(found.zone_min, s, a, desc.p_nc, desc.cost_ratio), limit,
                                1e-11 * limit);
        ck_assert_double_eq_tol(paper_z(found.zone_max, s, a, desc.p_nc, desc.cost_ratio), limit,
                                1e-11 * limit);
        ck_assert_double_lt(found.zone_min, last_min);
        ck_assert_double_gt(found.zone_max, last_max);
        last_min = found.zone_min;
        last_max = found.zone_max;
    }
    desc.zone_loss = 1e-300; /* 0 is the default */
    const vox_cell_size_result point = suggest_ok(&desc, &mesh, 1);
    ck_assert_double_eq(point.zone_min, point.cell_size);
    ck_assert_double_eq(point.zone_max, point.cell_size);
    vox_cell_size_desc usual = desc;
    desc.zone_loss = 0;
    usual.zone_loss = 0.05;
    ck_assert_double_eq(suggest_ok(&desc, &mesh, 1).zone_max, suggest_ok(&usual, &mesh, 1).zone_max);
    free_body(&box);
}
END_TEST

/* ---- units and extremes ----------------------------------------------------------------------- */

static void scale_body(const body* from, double factor, body* to) {
    for (uint32_t i = 0; i < 3 * from->vertex_count; ++i)
        to->positions[i] = (float)(factor * from->positions[i]);
}

START_TEST(any_unit_gives_the_same_answer) {
    static const double factors[] = {1e3, 1e-3, 1e6, 1e30, 1e-30, 0x1p100, 0x1p-100};
    const double factor = factors[_i];
    int exponent;
    const int exact = frexp(factor, &exponent) == 0.5; /* a power of two rounds nothing */
    body box = make_uneven_box(), scaled = make_uneven_box();
    scale_body(&box, factor, &scaled);
    const vox_mesh_desc mesh = body_desc(&box), scaled_mesh = body_desc(&scaled);
    const vox_cell_size_result one = suggest_ok(NULL, &mesh, 1), other = suggest_ok(NULL, &scaled_mesh, 1);
    const double pairs[][2] = {
        {other.cell_size, one.cell_size}, {other.zone_min, one.zone_min}, {other.zone_max, one.zone_max}};
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; ++i)
        ck_assert_double_eq_tol(pairs[i][0] / pairs[i][1] / factor, 1, exact ? 1e-15 : 1e-6);
    for (uint32_t i = 0; i < one.rule_count; ++i) {
        ck_assert_double_gt(one.rules[i].cell_size, 0);
        ck_assert_double_eq_tol(other.rules[i].cell_size / one.rules[i].cell_size / factor, 1,
                                exact ? 1e-15 : 1e-6);
    }
    ck_assert_double_eq_tol(other.cost / one.cost, 1, exact ? DBL_MIN : 1e-6);
    ck_assert_double_eq_tol(other.cells_per_axis / one.cells_per_axis, 1, exact ? DBL_MIN : 1e-6);
    ck_assert_uint_eq(geometry_of(&scaled_mesh, 1).edges, geometry_of(&mesh, 1).edges);
    free_body(&box);
    free_body(&scaled);
}
END_TEST

/* The largest and the smallest coordinates that a float has, and parameters at the edge of the model. */
START_TEST(extremes_stay_finite) {
    static const float sizes[] = {FLT_MAX, 1e30f, 1e-30f, FLT_MIN * FLT_EPSILON};
    static const double ratios[] = {5, 1e200, 1e-200};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i)
        for (size_t r = 0; r < sizeof ratios / sizeof ratios[0]; ++r) {
            float positions[12];
            for (int c = 0; c < 12; ++c) positions[c] = (regular_positions[c] > 0 ? 1.0f : -1.0f) * sizes[i];
            const vox_mesh_desc mesh = vox_mesh_desc_floats(positions, 4, unit_tet, 1);
            vox_cell_size_desc desc = vox_default_cell_size_desc();
            desc.cost_ratio = ratios[r];
            const vox_cell_size_result found = suggest_ok(&desc, &mesh, 1);
            const vox_geometry stats = geometry_of(&mesh, 1);
            CLOSE(stats.mean_edge, 2 * sqrt(2) * (double)sizes[i]);
            CLOSE(stats.mean_volume / sizes[i] / sizes[i], 8.0 / 3 * (double)sizes[i]);
            /* the limit for expensive particles */
            ck_assert_double_ge(found.cell_size, stats.mean_edge / 4);
            ck_assert_double_lt(found.zone_min, found.cell_size);
            ck_assert_double_gt(found.zone_max, found.cell_size);
            ck_assert_double_finite(found.zone_max);
            ck_assert_double_finite(found.cost);
            for (uint32_t k = 0; k < found.curve_count; ++k) {
                ck_assert_double_finite(found.curve[k].cost);
                ck_assert_double_ge(found.curve[k].cost, found.cost);
            }
        }
}
END_TEST

/* ---- distance from the zone ------------------------------------------------------------------- */

/* Eq. 9 as printed, with its two floors; they are both 1 at the optimum. */
static double epsilon_as_printed(double n, double n_min, double n_opt, double n_max) {
    const double a = floor(n_opt / n), b = floor(n / n_opt);
    return fabs(n_opt - n) * (a + b) / ((n_opt - n_min) * a + (n_max - n_opt) * b);
}

START_TEST(distance_from_the_zone) {
    for (double n = 1; n < 200; n += 0.7) /* from a 30th to 7 times the optimum */
        ck_assert_double_eq_tol(zone_distance(n, 20, 30, 50), epsilon_as_printed(n, 20, 30, 50), 1e-12);
    ck_assert_double_eq(zone_distance(30, 20, 30, 50), 0);
    ck_assert_double_eq(zone_distance(20, 20, 30, 50), 1);
    ck_assert_double_eq(zone_distance(50, 20, 30, 50), 1);
    ck_assert_double_infinite(zone_distance(40, 20, 30, 30));
    ck_assert_double_infinite(zone_distance(10, 30, 30, 40));
    ck_assert_double_eq(zone_distance(25, 20, 30, 30), 0.5);
    ck_assert_double_eq(zone_distance(30, 30, 30, 30), 0);
}
END_TEST

SUITE(cell_size) {
    TCase* tests = add_case(suite, "suggest");
    const int parameter_count = sizeof parameters / sizeof parameters[0];
    tcase_add_each(tests, one_regular_tet, shared_facets_count_once);
    tcase_add_loop_test(tests, box_counts, 1, 6);
    tcase_add_each(tests, bodies_are_measured_together, unused_vertices_do_not_widen_the_bounds,
                   degenerate_tets_are_counted, layout_and_winding_do_not_matter);
    tcase_add_loop_test(tests, cell_size_is_the_minimum_of_the_cost, 0, parameter_count);
    tcase_add_loop_test(tests, zone_is_where_the_loss_is_small, 0, parameter_count);
    tcase_add_loop_test(tests, any_unit_gives_the_same_answer, 0, 7);
    tcase_add_each(tests, extremes_stay_finite, distance_from_the_zone);
    add_argument_tests(suite);
}
