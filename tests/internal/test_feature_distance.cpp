// Distances of features against a slow oracle in long doubles, degenerate ones and any numbers included.
#include "base/vectors.hpp"
#include "exact/closest_point.hpp"
#include "internal/distance_oracle.hpp"
#include "internal/random.hpp"
#include "surface/distance.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <vector>

#include "support/suite.h" // last: it defines macros with common names

using namespace vox;

namespace {

using test::Random;

// Where a formula that subtracts squared lengths has few digits.
START_TEST(edges_that_cross_at_any_angle) {
    test::Random random{5};
    const auto uniform = [&] {
        const double x = 2 * random.unit() - 1, y = 2 * random.unit() - 1;
        return Vec3d{x, y, 2 * random.unit() - 1};
    };
    double worst = 0;
    for (int digits = 0; digits <= 12; ++digits)
        for (int n = 0; n < 2000; ++n) {
            const Vec3d along = uniform(), other = along + std::pow(10, -digits) * uniform(),
                        middle = uniform();
            const Vec3d a[2] = {middle - along, middle + along}, b[2] = {middle - other, middle + other};
            worst = std::max(worst, closest_features(a, b).distance); // 0 but for the rounding of the corners
        }
    ck_assert_msg(worst < 1e-14, "edges that cross are %g apart", worst);
}
END_TEST

// Corners on a small raster, so that features are often degenerate, parallel, or touch; now and then a bit
// off it.
std::vector<Vec3d> random_corners(Random& random, std::size_t count, double scale, double off) {
    std::vector<Vec3d> corners(count);
    for (Vec3d& v : corners)
        for (double* x : {&v.x, &v.y, &v.z}) {
            *x = double(random.below(5)) - 2;
            if (random.below(3) == 0) *x += off * random.unit();
            *x = double{float(*x * scale)};
        }
    if (count > 1 && random.below(6) == 0) corners[1] = corners[0];
    return corners;
}

std::vector<Long3> all_longer(const std::vector<Vec3d>& corners) {
    std::vector<Long3> out;
    for (const Vec3d& v : corners) out.push_back(longer(v));
    return out;
}

double size_of(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
    double size = 0;
    for (const auto* corners : {&a, &b})
        for (const Vec3d& v : *corners)
            size = std::max(size, largest_coordinate({v.x - b[0].x, v.y - b[0].y, v.z - b[0].z}));
    return size;
}

Long3 weighted(const std::vector<Vec3d>& corners, const double* weights) {
    Long3 sum{0, 0, 0};
    for (std::size_t i = 0; i < corners.size(); ++i) sum = sum + longer(corners[i]) * weights[i];
    return sum;
}

constexpr std::size_t kinds[][2] = {{3, 1}, {1, 3}, {2, 2}, {2, 1}, {1, 2}, {1, 1}};

START_TEST(distances_are_right) {
    Random random{11};
    std::uint64_t degenerate = 0;
    for (int n = 0; n < 100000; ++n) {
        const auto& [of_a, of_b] = kinds[random.below(6)];
        const double scales[] = {1, 1, 1e-30, 1e30, double{FLT_TRUE_MIN} * 4, double{FLT_MAX} / 4};
        const double scale = scales[random.below(6)], offs[] = {1, 1e-3, 1e-6};
        const double off = offs[random.below(3)];
        const auto a = random_corners(random, of_a, scale, off), b = random_corners(random, of_b, scale, off);
        const double size = size_of(a, b);
        const CloseFeatures found = closest_features(a, b);
        const long double exact = oracle_distance(all_longer(a), all_longer(b));
        ck_assert_msg(std::abs(found.distance - exact) <= 1e-14L * size,
                      "%d: %zu and %zu: %.17g, expected %.17Lg (size %g)", n, of_a, of_b, found.distance,
                      exact, size);
        // The points that the weights give are that far apart.
        const long double apart = norm(weighted(a, found.weights_a) - weighted(b, found.weights_b));
        ck_assert(std::abs(apart - found.distance) <= 4e-15L * size + 1e-15L * scale);
        for (int i = 0; i < 3; ++i) {
            ck_assert(found.weights_a[i] >= 0 && found.weights_a[i] <= 1);
            ck_assert(found.weights_b[i] >= 0 && found.weights_b[i] <= 1);
        }
        degenerate += exact == 0;
        if (of_a < of_b || of_a + of_b < 4) continue;
        const double least = distance_at_least(a, b);
        ck_assert_msg(least <= exact, "%d: at least %.17g, exact %.17Lg", n, least, exact);
        // Of edges nearly parallel and close together, rounding costs more of it.
        const long double lost = 1e-13L * size + (exact > 0 ? 2e-14L * size * size / exact : 0);
        ck_assert_msg(least >= 0.99L * exact - lost,
                      "%d: %zu and %zu: at least %.17g, exact %.17Lg (size %g)", n, of_a, of_b, least, exact,
                      size);
    }
    ck_assert_uint_gt(degenerate, 100);
}
END_TEST

// Where a corner of one edge is closest to a corner of the other, and just beside it: the bound is the
// distance, not how far apart the lines are.
START_TEST(bounds_beside_corners) {
    const Vec3d a[2] = {{2, 1, 0x1.7ffffep+1}, {0x1p-149, 0, 0x1.000002p0}},
                b[2] = {{0, -0x1p-149, 1}, {0x1.800002p+1, 2, 0x1.000002p0}};
    for (const double least : {distance_at_least(a, b), distance_at_least(b, a)})
        ck_assert_double_gt(least, 0.99 * closest_features(a, b).distance);
    Random random{14};
    const auto vector = [&] {
        const double x = random.unit() - .5, y = random.unit() - .5;
        return Vec3d{x, y, random.unit() - .5};
    };
    for (int n = 0; n < 20000; ++n) { // edges that begin close together
        const Vec3d p = 4 * vector(),
                    q = p + std::ldexp(1, -10 - static_cast<int>(random.below(20))) * vector();
        const Vec3d c[2] = {p, p + vector()}, d[2] = {q, q + vector()};
        const double distance = closest_features(c, d).distance, least = distance_at_least(c, d);
        ck_assert_double_gt(least, 0.98 * distance - 1e-13);
    }
}
END_TEST

// However thin a face is, and wherever above it the vertex, the distance is off by no more than rounding.
START_TEST(slivers) {
    Random random{13};
    for (int n = 0; n < 50000; ++n) {
        const auto number = [&] { return 4 * random.unit() - 2; };
        const auto vector = [&] {
            const double x = number(), y = number();
            return Vec3d{x, y, number()};
        };
        const Vec3d p = vector(), q = vector(), middle = p + random.unit() * (q - p);
        const double thickness = std::ldexp(1, -static_cast<int>(random.below(56))),
                     height = std::ldexp(random.unit(), -static_cast<int>(random.below(56)));
        std::vector<Vec3d> a{p, q, middle + thickness * vector()};
        std::rotate(a.begin(), a.begin() + random.below(3), a.end());
        double weights[3] = {random.unit(), random.unit(), random.unit()};
        const double sum = weights[0] + weights[1] + weights[2];
        const Vec3d over = (weights[0] / sum) * a[0] + (weights[1] / sum) * a[1] + (weights[2] / sum) * a[2];
        const std::vector<Vec3d> b{over + height * vector()};
        const long double exact = oracle_distance(all_longer(a), all_longer(b));
        const double found = closest_features(a, b).distance,
                     seen = length(closest_seen_from(b[0], a[0], a[1], a[2]).way),
                     squared = closest_seen_from(b[0], a[0], a[1], a[2]).at.squared_distance;
        for (const double distance : {found, seen, std::sqrt(squared)})
            ck_assert_msg(std::abs(distance - exact) <= 5e-14L, "%d: %.17g, expected %.17Lg (thickness %g)",
                          n, distance, exact, thickness);
        ck_assert(distance_at_least(a, b) <= exact);
    }
}
END_TEST

// Down to the denormals of double, and of any exponents: bounds hold.
START_TEST(bounds_hold_for_any_numbers) {
    Random random{12};
    for (int n = 0; n < 100000; ++n) {
        const bool faces = random.below(2) == 0;
        std::vector<Vec3d> a(faces ? 3 : 2), b(faces ? 1 : 2);
        const double tiny = random.below(3) == 0 ? 0x1p-900 : 1;
        for (auto* corners : {&a, &b})
            for (Vec3d& v : *corners)
                v = {random.any_finite() * tiny, random.any_finite() * tiny, random.any_finite() * tiny};
        const long double exact = oracle_distance(all_longer(a), all_longer(b));
        const double least = distance_at_least(a, b);
        ck_assert(least <= exact * (1 + 1e-17L) && least >= 0);
        const CloseFeatures found =
            closest_features(a, b); // of points of the features, though perhaps not the closest
        const long double apart = norm(weighted(a, found.weights_a) - weighted(b, found.weights_b));
        ck_assert(std::abs(apart - found.distance) <= 1e-14L * size_of(a, b));
        ck_assert(found.distance >= least);
    }
}
END_TEST

} // namespace

SUITE(feature_distance) {
    TCase* tests = add_case(suite, "feature_distance");
    tcase_add_each(tests, edges_that_cross_at_any_angle, distances_are_right, bounds_beside_corners, slivers,
                   bounds_hold_for_any_numbers);
}
