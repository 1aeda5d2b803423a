// Near the sphere |p| and the radius cancel. So the distance is computed as (|p|^2 - radius^2) / (|p| +
// radius), with a numerator that is exact until it is rounded to two doubles: the squares are sums of two
// doubles each, and their sum is exact in eight (J. R. Shewchuk, Adaptive precision floating-point arithmetic
// and fast robust geometric predicates, Discrete & Computational Geometry 18, 1997, Sect. 2).
#include "exact/sphere.hpp"

#include "base/vectors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace vox {

namespace {

struct Pair { // an unevaluated sum; |low| is at most half a unit in the last place of `high`
    double high, low;
};

Pair exact_sum(double a, double b) noexcept {
    const double sum = a + b, part = sum - a;
    return {sum, (a - (sum - part)) + (b - part)};
}

Pair exact_product(double a, double b) noexcept {
    constexpr double splitter = 134217729.0; // 2^27 + 1
    const double product = a * b, of_a = splitter * a, of_b = splitter * b;
    const double a1 = of_a - (of_a - a), a2 = a - a1, b1 = of_b - (of_b - b), b2 = b - b1;
    return {product, ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2};
}

// Doubles that do not overlap, ascending in magnitude, with an exact sum.
class Expansion {
public:
    void add(double x) noexcept {
        for (std::size_t i = 0; i < size_; ++i) {
            const Pair sum = exact_sum(x, part_[i]);
            part_[i] = sum.low;
            x = sum.high;
        }
        part_[size_++] = x;
    }
    void add(const Pair& x) noexcept {
        add(x.low);
        add(x.high);
    }
    Pair rounded() const noexcept {
        Expansion rest = *this;
        rest.add(-sum());
        return {sum(), rest.sum()};
    }

private:
    double sum() const noexcept { // within a unit in the last place
        double sum = 0;
        for (std::size_t i = 0; i < size_; ++i) sum += part_[i];
        return sum;
    }

    std::array<double, 10> part_{};
    std::size_t size_ = 0;
};

Pair root(const Pair& squared) noexcept {
    const double root = std::sqrt(squared.high);
    const Pair square = exact_product(root, root);
    return {root, (((squared.high - square.high) - square.low) + squared.low) / (2 * root)};
}

constexpr double too_small = 0x1p-300; // squares of smaller numbers would lose digits
constexpr int upwards = 700;           // powers of two

} // namespace

double distance_to_sphere(const Vec3d& p, double radius) noexcept {
    const double largest = std::max(largest_coordinate(p), radius);
    if (largest == 0) return 0;
    if (largest < too_small)
        return std::ldexp(distance_to_sphere(times_power(p, upwards), std::ldexp(radius, upwards)), -upwards);
    Expansion sum;
    for (const double x : {p.x, p.y, p.z}) sum.add(exact_product(x, x));
    const Pair squared = sum.rounded();
    if (squared.high == 0) return -radius;
    const Pair length = root(squared), limit = exact_product(radius, radius);
    Pair under = exact_sum(length.high, radius);
    under.low += length.low;
    sum.add({-limit.high, -limit.low});
    const Pair over = sum.rounded();
    const double quotient = over.high / under.high;
    const Pair product = exact_product(quotient, under.high);
    const double rest = ((over.high - product.high) - product.low) + (over.low - quotient * under.low);
    return quotient + rest / under.high;
}

double distance_to_box(const Vec3d& p, const Vec3d& half_size) noexcept {
    const double at[3] = {p.x, p.y, p.z}, half[3] = {half_size.x, half_size.y, half_size.z};
    Pair beyond[3];
    double largest = 0;
    for (int i = 0; i < 3; ++i) {
        beyond[i] = exact_sum(std::abs(at[i]), -half[i]);
        largest = std::max(largest, beyond[i].high);
    }
    if (largest == 0) return 0;
    const int powers = largest < too_small ? upwards : 0;
    Expansion sum;
    for (const auto& [high, low] : beyond) {
        if (!(high > 0)) continue;
        const double x = std::ldexp(high, powers);
        sum.add(exact_product(x, x));
        sum.add(2 * x * std::ldexp(low, powers)); // what that leaves out is below its last place
    }
    const Pair length = root(sum.rounded());
    return std::ldexp(length.high + length.low, -powers);
}

} // namespace vox
