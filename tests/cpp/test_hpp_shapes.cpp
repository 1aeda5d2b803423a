// Rigid shapes by vox.hpp: each kind, what its constraints say, where it is and was.
#include <vox/vox.hpp>

#include <cmath>

#include "cpp/throws.hpp"

namespace {

using triple = std::array<double, 3>;
using triangle = std::array<std::uint32_t, 3>;

const std::vector<triple> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::vector<triangle> sides = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

// What a point at p has to do with a shape: its constraints.
struct Touching {
    vox::grid grid;
    triple p;
    vox_body point, shape;
    Touching(const vox_shape_desc& desc, const triple& at) : p(at) {
        grid.set_flags(VOX_GRID_CONSTRAINTS);
        point = grid.insert(vox_positions{p.data(), 1, VOX_FORMAT_DOUBLE, 0, 0, 0});
        shape = grid.insert(desc);
        grid.step();
    }
};

void touches(const vox_shape_desc& desc, const triple& p, double gap, const triple& normal) {
    const Touching with(desc, p);
    ck_assert_uint_eq(with.grid.info(with.shape).shape, desc.kind);
    ck_assert_uint_eq(with.grid.constraints().size(), 1);
    const vox_constraint& c = with.grid.constraints()[0];
    ck_assert(c.body_a == with.point && c.body_b == with.shape && c.count == 1 && c.vertices[0] == 0);
    ck_assert_double_eq_tol(c.gap, gap, 1e-12);
    for (std::size_t k = 0; k < 3; ++k) ck_assert_double_eq_tol(c.normal[k], normal[k], 1e-12);
    ck_assert_double_eq_tol(vox::constraint_gap(c, with.p, {}), gap, 1e-12);
    const Touching far(desc, {2, 3, 4});
    ck_assert_uint_eq(far.grid.constraints().size(), 0);
}

START_TEST(each_kind) {
    touches(vox::half_space(), {3, 4, -0.25}, -0.25, {0, 0, 1});
    touches(vox::sphere(1), {0.5, 0, 0}, -0.5, {1, 0, 0});
    touches(vox::capsule(0.5, 1), {0.25, 0, 1}, -0.25, {1, 0, 0});
    touches(vox::cylinder(0.5, 1), {0, 0.25, 0.5}, -0.25, {0, 1, 0});
    touches(vox::box(1, 0.5, 2), {0, -0.25, 0}, -0.25, {0, -1, 0});
    const std::vector<double> heights(6, -0.5);
    touches(vox::heightfield(heights, 3, 1, 2), {1, 1, -0.75}, -0.25, {0, 0, 1});
    touches(vox::solid(corners, sides), {0.25, 0.25, 0.125}, -0.125, {0, 0, -1});
    touches(vox::sheet(corners, sides, 0.25), {0.25, 0.25, -0.125}, -0.125, {0, 0, -1});
    const auto line = vox::polyline(2);
    ck_assert_uint_eq(line.size(), 1);
    touches(vox::sheet(corners, line, 0.25), {0.5, 0, -0.125}, -0.125, {0, 0, -1});
}
END_TEST

START_TEST(fields) {
    double radius = 1;
    const auto ball = [&radius](vox::span<const triple> points, vox::span<double> distances,
                                vox::span<triple> gradients) noexcept {
        for (std::size_t i = 0; i < points.size(); ++i) {
            distances[i] = std::hypot(points[i][0], points[i][1], points[i][2]) - radius;
            gradients[i] = points[i];
        }
    };
    touches(vox::field(ball, 1, 1, 1), {0, 0.75, 0}, -0.25, {0, 1, 0});
    // A function that may throw is none, as nothing may cross the library.
    const auto throwing = [](vox::span<const triple>, vox::span<double>, vox::span<triple>) {};
    static_assert(!std::is_nothrow_invocable_v<decltype(throwing)&, vox::span<const triple>,
                                               vox::span<double>, vox::span<triple>>);
}
END_TEST

START_TEST(user_data_and_filters) {
    vox_shape_desc desc = vox::half_space();
    desc.user_data = 77;
    Touching with(desc, {0, 0, -1});
    ck_assert_uint_eq(with.grid.constraints()[0].user_data_b, 77);
    desc.filter.category = 2;
    desc.filter.flags = VOX_FILTER_SENSOR;
    const Touching sensor(desc, {0, 0, -1});
    ck_assert_uint_eq(sensor.grid.constraints().size(), 0);
    ck_assert_uint_eq(sensor.grid.pairs().size(), 1);
    ck_assert_uint_eq(sensor.grid.info(sensor.shape).filter.category, 2);
}
END_TEST

// A ball that passes a point within one step.
START_TEST(shapes_move) {
    Touching with(vox::sphere(0.25), {0, 0, 3});
    const std::array<double, 12> before = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    with.grid.set_transform(with.shape, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 6});
    with.grid.step();
    ck_assert_uint_eq(with.grid.constraints().size(), 0);
    const auto check = [&](std::size_t count) {
        with.grid.step();
        ck_assert_uint_eq(with.grid.constraints().size(), count);
        for (const vox_constraint& c : with.grid.constraints()) {
            ck_assert_int_eq(c.kind, VOX_CONSTRAINT_IMPACT);
            ck_assert_double_eq_tol(c.time, 2.75 / 6, 1e-9);
        }
    };
    with.grid.set_previous_transform(with.shape, before);
    check(1);
    with.grid.end_previous_transform(with.shape);
    check(0);
    with.grid.set_previous_transform(with.shape, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
    check(1);
    with.grid.set_previous_transform(
        with.shape, [](int row, int column) { return row == column && row < 3 ? 1.0f : 0.0f; });
    check(1);
    throws([&] { with.grid.set_previous_transform(with.point, before); }, VOX_ERROR_INVALID_ARGUMENT, "");
    with.grid.remove(with.shape);
    throws([&] { with.grid.end_previous_transform(with.shape); }, VOX_ERROR_INVALID_HANDLE, "");
}
END_TEST

START_TEST(what_is_refused) {
    const std::vector<std::uint32_t> four = {0, 1, 2, 3};
    const std::vector<std::array<std::uint32_t, 2>> pairs = {{0, 1}, {1, 2}, {2, 3}};
    const std::vector<double> heights(5);
    vox::grid grid;
    throws([&] { (void)vox::solid(corners, four); }, VOX_ERROR_INVALID_ARGUMENT, "4 indices, 1 in each");
    throws([&] { (void)vox::sheet(corners, pairs); }, VOX_ERROR_INVALID_ARGUMENT, "6 indices, 2 in each");
    throws([&] { (void)vox::heightfield(heights, 2, 1, 1); }, VOX_ERROR_INVALID_ARGUMENT,
           "5 heights in rows of 2");
    throws([&] { (void)vox::heightfield(heights, 0, 1, 1); }, VOX_ERROR_INVALID_ARGUMENT, "rows of 0");
    throws([&] { grid.insert(vox::sphere(-1)); }, VOX_ERROR_INVALID_ARGUMENT, "-1");
    throws([&] { grid.insert(vox::box(1, NAN, 1)); }, VOX_ERROR_INVALID_ARGUMENT, "nan");
    ck_assert(vox::polyline(0).empty() && vox::polyline(1).empty());
}
END_TEST

} // namespace

SUITE(hpp_shapes) {
    TCase* tests = add_case(suite, "shapes");
    tcase_add_each(tests, each_kind, fields, user_data_and_filters, shapes_move, what_is_refused);
}
