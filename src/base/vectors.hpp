// Vectors of doubles, each operation in one fixed order.
#pragma once

#include "base/device.hpp"
#include "base/scene.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

VOX_HD Vec3f nearest_floats(const Vec3d& p) noexcept {
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}
VOX_HD Vec3d vector_of(const double (&from)[3]) noexcept { return {from[0], from[1], from[2]}; }
VOX_HD Vec3d operator+(const Vec3d& a, const Vec3d& b) noexcept { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
VOX_HD Vec3d operator-(const Vec3d& a, const Vec3d& b) noexcept { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
VOX_HD Vec3d operator*(double s, const Vec3d& a) noexcept { return {s * a.x, s * a.y, s * a.z}; }
VOX_HD double dot(const Vec3d& a, const Vec3d& b) noexcept { return a.x * b.x + a.y * b.y + a.z * b.z; }
VOX_HD Vec3d cross(const Vec3d& a, const Vec3d& b) noexcept {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
VOX_HD Vec3d min(const Vec3d& a, const Vec3d& b) noexcept {
    return {b.x < a.x ? b.x : a.x, b.y < a.y ? b.y : a.y, b.z < a.z ? b.z : a.z};
}
VOX_HD Vec3d max(const Vec3d& a, const Vec3d& b) noexcept {
    return {b.x > a.x ? b.x : a.x, b.y > a.y ? b.y : a.y, b.z > a.z ? b.z : a.z};
}
// The middle of a box, in coordinates where it is more than `far` sides of the box away from zero; else zero.
VOX_HD Vec3d far_middle(const Vec3d& lo, const Vec3d& hi, double far) noexcept {
    const auto middle = [far](double low, double high) {
        const double at = 0.5 * low + 0.5 * high;
        return std::abs(at) > far * (high - low) ? at : 0;
    };
    return {middle(lo.x, hi.x), middle(lo.y, hi.y), middle(lo.z, hi.z)};
}
VOX_HD double largest_coordinate(const Vec3d& v) noexcept {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}
VOX_HD Vec3d times_power(const Vec3d& v, int powers) noexcept { // of two
    return {std::ldexp(v.x, powers), std::ldexp(v.y, powers), std::ldexp(v.z, powers)};
}
// The determinant of the matrix with these rows: six times the signed volume of the tetrahedron that they
// span.
VOX_HD double determinant(const Vec3d& a, const Vec3d& b, const Vec3d& c) noexcept {
    return dot(a, cross(b, c));
}
VOX_HD double length(const Vec3d& a) noexcept { return std::sqrt(dot(a, a)); }

// `a` scaled to length 1, to rounding. Zero when `a` is zero, or so short that its square loses digits.
VOX_HD Vec3d normalised(const Vec3d& a) noexcept {
    const double squared = dot(a, a);
    if (!(squared > 1e-290)) return {0, 0, 0};
    const double l = std::sqrt(squared);
    return {a.x / l, a.y / l, a.z / l};
}

} // namespace vox
