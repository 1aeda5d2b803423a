// The exact part of predicates.hpp, which computes determinants as integers.
//
// A finite double is an integer times a power of two. So the coordinates of a few points are integers in
// units of the largest power of two that divides all of them; for the points of one scene these have two or
// three words. Differences, products and sums take as many words as they need, so that nothing is ever
// rounded.
#include "exact/predicates.hpp"

#include "exact/fixed_point.hpp"
#include "exact/integer.hpp"

#include <algorithm>
#include <bit>
#include <cfloat>

#if defined(FLT_EVAL_METHOD)
static_assert(FLT_EVAL_METHOD == 0 || FLT_EVAL_METHOD == 1, "doubles must be rounded to double");
#endif

namespace vox {
namespace {

using Integer = IntegerIn<VolumeWords>;

// A point in units of the largest power of two that divides all coordinates of a few points.
struct IntegerPoint {
    Integer x, y, z;
};

template <std::size_t Count>
std::array<IntegerPoint, Count> in_units(const std::array<Vec3d, Count>& points) {
    int unit = 1024;
    for (const Vec3d& p : points)
        for (const double value : {p.x, p.y, p.z})
            if (const Parts from = parts(value); from.mantissa != 0) unit = std::min(unit, from.exponent);
    std::array<IntegerPoint, Count> result;
    for (std::size_t i = 0; i < Count; ++i)
        result[i] = {integer_of<VolumeWords>(points[i].x, unit), integer_of<VolumeWords>(points[i].y, unit),
                     integer_of<VolumeWords>(points[i].z, unit)};
    return result;
}

// det[b-a, c-a, d-a]
Integer exact_volume(const IntegerPoint& a, const IntegerPoint& b, const IntegerPoint& c,
                     const IntegerPoint& d) {
    const Integer ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
    const Integer vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    const Integer wx = d.x - a.x, wy = d.y - a.y, wz = d.z - a.z;
    return (vx * wy - wx * vy) * uz + (wx * uy - ux * wy) * vz + (ux * vy - vx * uy) * wz;
}

// i / 2^bits, rounded to nearest once: rounds the top 64 bits, the last of which is set if any lower bit is.
double scaled(const Integer& i, int bits) {
    if (i.size == 0) return 0;
    const auto word = [&i](int index) { return index >= 0 ? std::uint64_t{i.word()[index]} : 0; };
    const int zeros = std::countl_zero(i.word()[i.size - 1]);
    const std::uint64_t high = word(i.size - 1) << 32 | word(i.size - 2);
    const std::uint64_t low = word(i.size - 3) << 32;
    std::uint64_t top = zeros == 0 ? high : high << zeros | low >> (64 - zeros);
    const bool rest = (low << zeros) != 0 || std::any_of(i.word(), i.word() + std::max(i.size - 3, 0),
                                                         [](std::uint32_t w) { return w != 0; });
    top |= std::uint64_t{rest};
    const double value = std::ldexp(static_cast<double>(top), i.bits() - 64 - bits);
    return i.negative ? -value : value;
}

// over / under, rounded to nearest once, for `under` other than 0: its 60 highest bits by long division, the
// last of which is set if any lower bit is.
double rounded_quotient(const Integer& over, const Integer& under) {
    if (over.size == 0) return 0;
    const int bits = over.bits() - under.bits();
    Integer rest = shifted_left(over, std::max(-bits, 0));
    const Integer by = shifted_left(under, std::max(bits, 0));
    const bool negative = over.negative != under.negative;
    std::uint64_t quotient = 0;
    for (int i = 0; i < 60; ++i) {
        quotient <<= 1;
        if (!smaller_magnitude(rest, by)) {
            subtract_magnitudes(rest, by, rest);
            quotient |= 1;
        }
        rest = shifted_left(rest, 1);
    }
    const double value = std::ldexp(static_cast<double>(quotient | std::uint64_t{rest.size != 0}), bits - 59);
    return negative ? -value : value;
}

// Coordinates that are 0 or at least 2^-240 are multiples of 2^-292. So the product of three differences of
// them is 0 or at least 2^-876.
bool products_may_underflow(const std::array<Vec3d, 4>& points) {
    constexpr std::uint64_t least = std::bit_cast<std::uint64_t>(0x1p-240);
    bool any = false;
    for (const Vec3d& p : points)
        for (const double value : {p.x, p.y, p.z}) // all of them, which is quicker than a branch for each
            any |= (std::bit_cast<std::uint64_t>(value) & ~std::uint64_t{0} >> 1) - 1 < least - 1;
    return any;
}

} // namespace

int side_of_sphere(const Vec3d& p, const Vec3d& q, double radius) {
    // Seven roundings of numbers that are not negative, and the underflow of four squares.
    constexpr double bound = 8 * 0x1p-53, lost = 0x1p-1000;
    const Vec3d way = p - q;
    const double squared = dot(way, way), limit = radius * radius, error = bound * (squared + limit) + lost;
    if (squared - limit > error) return 1;
    if (limit - squared > error) return -1;
    const auto at = in_units(std::array{p, q, Vec3d{radius, 0, 0}});
    const Integer x = at[0].x - at[1].x, y = at[0].y - at[1].y, z = at[0].z - at[1].z;
    return (x * x + y * y + z * z - at[2].x * at[2].x).sign();
}

int exact_orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
#if defined(VOX_FIXED_POINT)
    FixedPoints<4> fixed;
    if (fixed.read({&a, &b, &c, &d})) return fixed.volume(0, 1, 2, 3).sign();
#endif
    const auto p = in_units(std::array{a, b, c, d});
    return exact_volume(p[0], p[1], p[2], p[3]).sign();
}

int uncertain_orientation(const BoundedVolume& volume, const Vec3d& a, const Vec3d& b, const Vec3d& c,
                          const Vec3d& d, std::uint64_t& exact_tests) {
    // The products add up to less than 2^-900. So each has a factor that is exactly zero, unless a product
    // underflowed.
    if (volume.error == underflow_error && !products_may_underflow(std::array{a, b, c, d})) return 0;
    ++exact_tests;
    return exact_orientation(a, b, c, d);
}

void scaled_volumes(const VolumePoints& points, std::span<const VolumeCorners> of,
                    std::span<double> volumes) {
    const auto p = in_units(points);
    int bits = 0; // of the largest volume
    for (const auto& [a, b, c, d] : of) bits = std::max(bits, exact_volume(p[a], p[b], p[c], p[d]).bits());
    for (std::size_t i = 0; i < of.size(); ++i) {
        const auto& [a, b, c, d] = of[i];
        volumes[i] = scaled(exact_volume(p[a], p[b], p[c], p[d]), bits);
    }
}

Vec3d exact_normal(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const auto p = in_units(std::array{a, b, c});
    const Integer ux = p[1].x - p[0].x, uy = p[1].y - p[0].y, uz = p[1].z - p[0].z;
    const Integer vx = p[2].x - p[0].x, vy = p[2].y - p[0].y, vz = p[2].z - p[0].z;
    const Integer x = uy * vz - vy * uz, y = uz * vx - vz * ux, z = ux * vy - vx * uy;
    const int bits = std::max({x.bits(), y.bits(), z.bits()});
    return {scaled(x, bits), scaled(y, bits), scaled(z, bits)};
}

std::array<double, 4> exact_weights(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c,
                                    const Vec3d& d) {
    const auto q = in_units(std::array{a, b, c, d, p});
    const Integer total = exact_volume(q[0], q[1], q[2], q[3]);
    return {rounded_quotient(exact_volume(q[4], q[1], q[2], q[3]), total),
            rounded_quotient(exact_volume(q[0], q[4], q[2], q[3]), total),
            rounded_quotient(exact_volume(q[0], q[1], q[4], q[3]), total),
            rounded_quotient(exact_volume(q[0], q[1], q[2], q[4]), total)};
}

double exact_crossing(const Vec3d& from, const Vec3d& to, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const auto q = in_units(std::array{a, b, c, from, to});
    const Integer before = exact_volume(q[0], q[1], q[2], q[3]);
    return rounded_quotient(before, before - exact_volume(q[0], q[1], q[2], q[4]));
}

} // namespace vox
