// Compares every sign, containment and weight of the predicates with those that GMP gives, on points of many
// kinds, floats and doubles.
#include "base/simd.hpp"
#include "exact/accurate.hpp"
#include "exact/fixed_point.hpp"
#include "exact/point_location.hpp"
#include "exact/predicates.hpp"
#include "internal/random.hpp"
#include "support/float_modes.h"
#include "support/oracle.h"
#include "support/suite.h"

#include <algorithm>
#include <cfloat>

using namespace vox;

namespace {

using Point = std::array<double, 3>;

Vec3d vec(const Point& p) { return {p[0], p[1], p[2]}; }

template <class Float>
Float nudge(Float value, int steps) {
    for (; steps > 0; --steps) value = std::nextafter(value, Float(FLT_MAX));
    for (; steps < 0; ++steps) value = std::nextafter(value, Float(-FLT_MAX));
    return value;
}

// ---- kinds of points ------------------------------------------------------------------------------

struct Case {
    Point p, corner[4];
};

double unit_range(Random& r) { return r.uniform(-1, 1); }
double small_grid(Random& r) { return r.below(4); } // most determinants are 0
double fine_grid(Random& r) { return r.below(257) / 64.0 - 2.0; }
double far_away(Random& r) {
    return 1e6f + r.uniform(-1, 1);
} // few bits are left, so all is nearly degenerate
double huge(Random& r) { return r.uniform(-1e30, 1e30); }
double largest(Random& r) { return r.below(2) ? FLT_MAX : r.below(2) ? -FLT_MAX : r.uniform(-1, 1); }
double denormal(Random& r) { return r.below(9) * double{FLT_TRUE_MIN}; }
double tiny(Random& r) { return r.uniform(-1e-38, 1e-38); }
double one_huge_among_small(Random& r) { return r.below(8) == 0 ? 1e30f : r.uniform(-1, 1); }
double exponents_apart(Random& r) {
    return std::ldexp(r.uniform(-1, 1), static_cast<int>(r.below(250)) - 125);
}
double any_bits(Random& r) { return r.any_finite(); }
double few_ulps(Random& r) { return nudge(0.5f, static_cast<int>(r.below(5))); } // 0.5 and its neighbours

double between(Random& r, double min, double max) { return min + r.unit() * (max - min); }
double unit_range_d(Random& r) { return between(r, -1, 1); }
double far_away_d(Random& r) { return 1e15 + between(r, -4, 4); }
double denormal_d(Random& r) { return r.below(9) * DBL_TRUE_MIN; }
double one_huge_among_tiny_d(Random& r) { return r.below(8) == 0 ? 3e38 : between(r, -1e-300, 1e-300); }
double exponents_apart_d(Random& r) {
    return std::ldexp(between(r, -1, 1), static_cast<int>(r.below(1200)) - 1074);
}
// Products of three differences are near the smallest doubles, around where they start to underflow.
double vanishing_d(Random& r) { return std::ldexp(between(r, -1, 1), -358 + static_cast<int>(r.below(20))); }
double near_bound_d(Random& r) {
    return std::ldexp(static_cast<double>(r.below(5)), -242 - static_cast<int>(r.below(60)));
}
// As far apart as volumes of three words can be, and a little farther.
double words_apart(Random& r) { return r.uniform(-1, 1) * std::ldexp(1.0f, -static_cast<int>(r.below(39))); }
double words_apart_d(Random& r) { return std::ldexp(between(r, -1, 1), -static_cast<int>(r.below(9))); }
// The largest of these volumes.
double full_words_d(Random& r) {
    return (r.below(2) ? 1 : -1) * nudge(2.0, -1 - static_cast<int>(r.below(3)));
}
double few_ulps_d(Random& r) { return nudge(0.5, static_cast<int>(r.below(5))); }

struct Coordinate {
    double (*make)(Random&);
    bool floats;

    double operator()(Random& r) const { return make(r); }
    double rounded(double value) const { return floats ? double{static_cast<float>(value)} : value; }
    double next(double value) const {
        return floats ? double{nudge(static_cast<float>(value), 1)} : nudge(value, 1);
    }
};

constexpr Coordinate coordinates[] = {{unit_range, true},
                                      {small_grid, true},
                                      {fine_grid, true},
                                      {far_away, true},
                                      {huge, true},
                                      {largest, true},
                                      {denormal, true},
                                      {tiny, true},
                                      {any_bits, true},
                                      {few_ulps, true},
                                      {exponents_apart, true},
                                      {one_huge_among_small, true},
                                      {words_apart, true},
                                      {words_apart_d, false},
                                      {full_words_d, false},
                                      {unit_range_d, false},
                                      {far_away_d, false},
                                      {denormal_d, false},
                                      {one_huge_among_tiny_d, false},
                                      {exponents_apart_d, false},
                                      {vanishing_d, false},
                                      {near_bound_d, false},
                                      {few_ulps_d, false}};

Case independent_points(Random& r, Coordinate coordinate) {
    Case c;
    for (double& x : c.p) x = coordinate(r);
    for (Point& corner : c.corner)
        for (double& x : corner) x = coordinate(r);
    return c;
}

// A point rounded from a combination of some of the corners. It is in or on the tetrahedron or one of its
// parts, or off by an ulp.
Case point_on_part(Random& r, Coordinate coordinate) {
    Case c = independent_points(r, coordinate);
    const std::uint32_t parts = 1 + r.below(4);
    double weight[4] = {}, total = 0;
    for (std::uint32_t i = 0; i < parts; ++i) total += weight[i] = r.below(2) ? 1 : r.unit() + 1e-9;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double sum = 0;
        for (std::size_t i = 0; i < 4; ++i) sum += weight[i] / total * c.corner[i][axis];
        c.p[axis] = coordinate.rounded(std::clamp(sum, -double(FLT_MAX), double(FLT_MAX)));
        if (r.below(4) == 0) c.p[axis] = coordinate.next(c.p[axis]);
    }
    return c;
}

// The fourth corner is rounded from the plane of the others, so the tetrahedron is flat, or a sliver of a few
// ulps.
Case flattened(Random& r, Coordinate coordinate) {
    Case c = point_on_part(r, coordinate);
    const double s = r.unit(), t = r.unit() * (1 - s);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double a = c.corner[0][axis], b = c.corner[1][axis], d = c.corner[2][axis];
        c.corner[3][axis] = coordinate.rounded((1 - s - t) * a + s * b + t * d);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double sum = 0;
        for (const Point& corner : c.corner) sum += corner[axis] / 4;
        c.p[axis] = coordinate.rounded(sum);
    }
    return c;
}

using Kind = Case (*)(Random&, Coordinate);
constexpr Kind kinds[] = {independent_points, point_on_part, flattened};
constexpr int cases_per_kind = 1500;

template <class Function>
void for_each_case(Function&& function) {
    Random random{1};
    for (const Kind kind : kinds)
        for (const Coordinate coordinate : coordinates)
            for (int i = 0; i < cases_per_kind; ++i) function(kind(random, coordinate));
}

oracle_containment oracle(const Case& c) {
    const double* const corners[4] = {c.corner[0].data(), c.corner[1].data(), c.corner[2].data(),
                                      c.corner[3].data()};
    return oracle_locate_d(c.p.data(), corners);
}

Containment containment(oracle_containment where) {
    switch (where) {
    case ORACLE_BOUNDARY:
        return Containment::boundary;
    case ORACLE_INTERIOR:
        return Containment::interior;
    case ORACLE_DEGENERATE:
        return Containment::degenerate;
    default:
        return Containment::outside;
    }
}

// ---- tests ----------------------------------------------------------------------------------------

START_TEST(orientation_has_the_exact_sign) {
    std::uint64_t exact_tests = 0;
    int seen[3] = {};
    for_each_case([&](const Case& c) {
        const int expected = oracle_orientation_d(c.corner[0].data(), c.corner[1].data(), c.corner[2].data(),
                                                  c.corner[3].data());
        ck_assert_int_eq(
            orientation(vec(c.corner[0]), vec(c.corner[1]), vec(c.corner[2]), vec(c.corner[3]), exact_tests),
            expected);
        ck_assert_int_eq(
            orientation(vec(c.corner[1]), vec(c.corner[0]), vec(c.corner[2]), vec(c.corner[3]), exact_tests),
            -expected);
        ck_assert_int_eq(
            exact_orientation(vec(c.corner[0]), vec(c.corner[1]), vec(c.corner[2]), vec(c.corner[3])),
            expected);
        ++seen[expected + 1];
    });
    for (const int count : seen) ck_assert_int_gt(count, cases_per_kind * 5 / 2); // the cases have every sign
    ck_assert_uint_gt(exact_tests, cases_per_kind / 4); // and the exact path was taken
}
END_TEST

#if defined(VOX_FIXED_POINT)
START_TEST(volumes_of_three_words_have_the_exact_sign) {
    int seen[3] = {}, apart = 0;
    for_each_case([&](const Case& c) {
        const Vec3d q[5] = {vec(c.corner[0]), vec(c.corner[1]), vec(c.corner[2]), vec(c.corner[3]), vec(c.p)};
        FixedPoints<5> points;
        if (!points.read({&q[0], &q[1], &q[2], &q[3], &q[4]})) {
            ++apart;
            return;
        }
        const int expected = oracle_orientation_d(c.corner[0].data(), c.corner[1].data(), c.corner[2].data(),
                                                  c.corner[3].data());
        ck_assert_int_eq(points.volume(0, 1, 2, 3).sign(), expected);
        ck_assert_int_eq(points.volume(3, 1, 2, 0).sign(), -expected);
        ck_assert_int_eq(
            points.volume(4, 1, 2, 3).sign(),
            oracle_orientation_d(c.p.data(), c.corner[1].data(), c.corner[2].data(), c.corner[3].data()));
        ++seen[expected + 1];
    });
    for (const int count : seen) ck_assert_int_gt(count, cases_per_kind * 5 / 2);
    ck_assert_int_gt(apart, cases_per_kind * 5 / 2);
}
END_TEST

START_TEST(three_words_take_what_they_say) {
    const auto read = [](double x, double y) {
        const Vec3d a{x, 0, 1}, b{y, 0, 1};
        return FixedPoints<2>().read({&a, &b});
    };
    const double least_float = double{std::nextafter(1.0f, 2.0f)}, least_double = std::nextafter(1.0, 2.0);
    for (const double size : {1.0, 0x1p127, 0x1p-900}) { // exponents as such are of no account
        ck_assert(read(size, 0x1p-36 * least_float * size));
        ck_assert(!read(size, 0x1p-37 * least_float * size));
        ck_assert(read(size, -0x1p-7 * least_double * size));
        ck_assert(!read(size, -0x1p-8 * least_double * size));
    }
    ck_assert(read(DBL_TRUE_MIN, 3 * DBL_TRUE_MIN) && read(DBL_MIN, DBL_TRUE_MIN) && read(0, -0.0));
    ck_assert(!read(1, DBL_TRUE_MIN) && read(0x1p-1000, 0));
}
END_TEST
#endif

// What a block says of its points is right at every level of SIMD, and its volumes have the bits of
// corner_volumes().
START_TEST(blocks_are_located_exactly) {
    static PointBlock block;
    static VolumeBlock volumes;
    static Case cases[point_block];
    std::size_t filled = 0;
    int outside = 0, interior = 0, boundary = 0;
    for_each_case([&](const Case& c) {
        for (std::size_t a = 0; a < 3; ++a) {
            block.point[a][filled] = c.p[a];
            for (std::size_t n = 0; n < 4; ++n) block.corner[n][a][filled] = c.corner[n][a];
        }
        cases[filled++] = c;
        if (filled < point_block) return;
        filled = 0;
        Containment where[point_block];
        for (std::size_t i = 0; i < point_block; ++i) where[i] = containment(oracle(cases[i]));
        for (int level = 0; level <= int(simd::best_level()); ++level) {
            if (simd::force_level(simd::Level(level)) != simd::Level(level)) continue;
            const CertainLocations certain = locate(block, point_block, volumes);
            for (std::size_t i = 0; i < point_block; ++i) {
                const Case& at = cases[i];
                const auto expected = corner_volumes(vec(at.p), vec(at.corner[0]), vec(at.corner[1]),
                                                     vec(at.corner[2]), vec(at.corner[3]));
                const auto found = volumes.of(i);
                for (std::size_t n = 0; n < 4; ++n) {
                    ck_assert(found[n].volume == expected[n].volume);
                    ck_assert(found[n].error == expected[n].error);
                }
                if (certain.interior >> i & 1) ck_assert(where[i] == Containment::interior);
                if (certain.boundary >> i & 1) ck_assert(where[i] == Containment::boundary);
                if (certain.outside >> i & 1)
                    ck_assert(where[i] == Containment::outside || where[i] == Containment::degenerate);
                outside += certain.outside >> i & 1;
                interior += certain.interior >> i & 1;
                boundary += certain.boundary >> i & 1;
            }
        }
        simd::force_level(simd::best_level());
    });
    ck_assert_int_gt(outside, 2000);
    ck_assert_int_gt(interior, 2000);
    ck_assert_int_gt(boundary, 2000);
}
END_TEST

START_TEST(orientation_sign_follows_its_definition) {
    std::uint64_t exact_tests = 0;
    const Vec3d a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0}; // counter-clockwise seen from +z
    ck_assert_int_eq(orientation(a, b, c, {0, 0, 1}, exact_tests), 1);
    ck_assert_int_eq(orientation(a, b, c, {0, 0, -1}, exact_tests), -1);
    ck_assert_int_eq(orientation(a, b, c, {5, 7, 0}, exact_tests), 0);
    ck_assert_int_eq(orientation(a, b, c, {0, 0, DBL_TRUE_MIN}, exact_tests), 1);
}
END_TEST

START_TEST(filter_decides_clear_cases_alone) {
    Random random{3};
    std::uint64_t exact_tests = 0;
    const Vec3d a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0}, d{0, 0, 1};
    for (int i = 0; i < 1000; ++i) {
        const Vec3d p{random.uniform(0.01, 0.3), random.uniform(0.01, 0.3), random.uniform(0.01, 0.3)};
        ck_assert(locate(p, a, b, c, d, exact_tests) == Containment::interior);
        ck_assert(locate({p.x + 1, p.y, p.z}, a, b, c, d, exact_tests) == Containment::outside);
    }
    ck_assert_uint_eq(exact_tests, 0);
}
END_TEST

START_TEST(locate_is_exact) {
    std::uint64_t exact_tests = 0;
    int seen[4] = {};
    for_each_case([&](const Case& c) {
        const Containment expected = containment(oracle(c));
        const Vec3d p = vec(c.p),
                    q[4] = {vec(c.corner[0]), vec(c.corner[1]), vec(c.corner[2]), vec(c.corner[3])};
        ck_assert(locate(p, q[0], q[1], q[2], q[3], exact_tests) == expected);
        ck_assert(locate(p, q[0], q[1], q[3], q[2], exact_tests) == expected); // the other winding
        if (expected != Containment::degenerate)
            ck_assert(locate_in_solid(p, q[0], q[1], q[2], q[3], exact_tests) == expected);
        ++seen[static_cast<int>(expected)];
    });
    for (const int count : seen) ck_assert_int_gt(count, cases_per_kind / 2);
    ck_assert_uint_gt(exact_tests, cases_per_kind / 4);
}
END_TEST

std::array<double, 4> accurate_weights(const Vec3d& p, const Vec3d (&corner)[4]) {
    PointBlock block;
    AccurateWeights weights;
    set(block.point, 0, p);
    for (std::size_t c = 0; c < 4; ++c) set(block.corner[c], 0, corner[c]);
    fill_last_register(block, 1);
    weigh_accurately(block, 1, true, weights);
    return {weights.weight[0][0], weights.weight[1][0], weights.weight[2][0], weights.weight[3][0]};
}

START_TEST(weights_are_the_true_ones_rounded) {
    int tested = 0;
    for_each_case([&](const Case& c) {
        const oracle_containment where = oracle(c);
        if (where != ORACLE_INTERIOR && where != ORACLE_BOUNDARY) return;
        const double* const corners[4] = {c.corner[0].data(), c.corner[1].data(), c.corner[2].data(),
                                          c.corner[3].data()};
        double expected[4];
        oracle_barycentric_d(c.p.data(), corners, expected);
        const std::array<double, 4> weights = accurate_weights(
            vec(c.p), {vec(c.corner[0]), vec(c.corner[1]), vec(c.corner[2]), vec(c.corner[3])});
        for (std::size_t i = 0; i < 4; ++i) {
            ck_assert_double_le(std::abs(weights[i] - expected[i]), 0x1p-52 * expected[i] + 0x1p-57);
            ck_assert(weights[i] >= 0 && weights[i] <= 1 && !std::signbit(weights[i]));
        }
        ++tested;
    });
    ck_assert_int_gt(tested, 20000);
}
END_TEST

START_TEST(weights_of_corners_are_one) {
    const Vec3d q[4] = {{1e30, 0, 0}, {0, 1, 0}, {0, 0, 1e-30}, {DBL_TRUE_MIN, 0, 0}};
    for (std::size_t i = 0; i < 4; ++i) {
        const std::array<double, 4> weights = accurate_weights(q[i], q);
        for (std::size_t j = 0; j < 4; ++j) ck_assert_double_eq(weights[j], i == j ? 1.0 : 0.0);
    }
}
END_TEST

// Integers decide, so that no environment of the caller's changes the sign, and denormals corrupt no memory.
START_TEST(exact_sign_in_any_float_environment) {
    constexpr double denormal = DBL_TRUE_MIN;
    const Vec3d a{0, 0, denormal}, b{1, 0, 64 * denormal}, c{0, 1, 4 * denormal};
    for (const float_mode& mode : float_modes)
        for (const double z : {-DBL_MAX, -denormal, denormal, 0.0, DBL_MAX}) {
            set_float_mode(&mode);
            const int sign = exact_orientation(a, b, c, {0, 0, z});
            set_float_mode(&float_modes[0]);
            ck_assert_int_eq(sign, z == denormal ? 0 : z > denormal ? 1 : -1);
        }
}
END_TEST

} // namespace

SUITE(predicates) {
    TCase* tests = add_case(suite, "exactness");
    tcase_add_each(tests, orientation_has_the_exact_sign, orientation_sign_follows_its_definition,
                   filter_decides_clear_cases_alone, locate_is_exact, weights_are_the_true_ones_rounded,
                   weights_of_corners_are_one, exact_sign_in_any_float_environment,
                   blocks_are_located_exactly);
#if defined(VOX_FIXED_POINT)
    tcase_add_each(tests, volumes_of_three_words_have_the_exact_sign, three_words_take_what_they_say);
#endif
}
