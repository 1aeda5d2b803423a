// Normals of single triangles, of any size and shape.
#pragma once

#include "base/vectors.hpp"
#include "exact/predicates.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace vox {

// `v` divided by its largest coordinate, so that products neither vanish nor overflow.
inline Vec3d scaled(const Vec3d& v) noexcept {
    const double largest = largest_coordinate(v);
    return largest > 0 ? Vec3d{v.x / largest, v.y / largest, v.z / largest} : v;
}

// The length of a vector of any size, and its direction; both zero for zero.
struct Stretch {
    explicit Stretch(const Vec3d& v) noexcept : length(vox::length(v)), direction(normalised(v)) {
        if (length > 1e-140) return;
        direction = normalised(scaled(v));
        length = largest_coordinate(v) * vox::length(scaled(v));
    }

    double length;
    Vec3d direction;
};

// The unit normal of triangle abc, to the side from which it is counter-clockwise; zero if it has no area.
// Off by less than 2^-28: rounding adds less than 2^-49 to each coordinate of the product.
inline Vec3d triangle_normal(const Vec3d& a, const Vec3d& b, const Vec3d& c) noexcept {
    const Vec3d across = cross(scaled(b - a), scaled(c - a));
    return normalised(length(across) > 0x1p-20 ? across : exact_normal(a, b, c));
}

// The unit normal of triangle abc out of the tetrahedron abcd. If that is flat, the normal points away from
// p; if p is in the plane of the triangle, too, to the side from which abc is counter-clockwise. If the
// triangle has no area, the normal is along `way`, or (0, 0, 1) if that is zero.
inline Vec3d facet_normal(Vec3d a, Vec3d b, Vec3d c, const Vec3d& d, const Vec3d& p, const Vec3d& way) {
    std::uint64_t exact_tests = 0;
    int side = orientation(a, b, c, d, exact_tests);
    if (side == 0) side = orientation(a, b, c, p, exact_tests);
    if (side > 0) std::swap(b, c);
    Vec3d normal = triangle_normal(a, b, c);
    if (!(length(normal) > 0)) normal = normalised(scaled(way));
    if (!(length(normal) > 0)) normal = {0, 0, 1};
    return normal;
}

} // namespace vox
