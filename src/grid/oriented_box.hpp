// Boxes along axes of their own, for tiles whose features are long and thin: these fill little of a box along
// the coordinate axes, but much of a box along their length.
#pragma once

#include "base/boxes.hpp"
#include "base/vectors.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

namespace vox {

struct OrientedBox {
    Vec3d middle, axis[3]; // of length 1, at right angles to each other
    double half[3];        // sides
};

inline Vec3d longest_edge(const Vec3d& a, const Vec3d& b, const Vec3d& c) noexcept {
    const Vec3d u = b - a, v = c - b, w = a - c;
    const double uu = dot(u, u), vv = dot(v, v), ww = dot(w, w);
    return uu >= std::max(vv, ww) ? u : vv >= ww ? v : w;
}

// Around all of the points, of which there is one at least: along a direction, which may be zero, and
// across it to where most room is.
OrientedBox oriented_box(std::span<const Vec3d> points, const Vec3d& along) noexcept;
// Around at most so many.
inline constexpr std::size_t most_oriented = 32;
OrientedBox oriented_box(std::span<const OrientedBox> boxes) noexcept;
inline OrientedBox oriented_box(const Box& box) noexcept {
    const Vec3d lo{box.lo[0], box.lo[1], box.lo[2]}, hi{box.hi[0], box.hi[1], box.hi[2]};
    const Vec3d half = 0.5 * hi - 0.5 * lo;
    return {0.5 * lo + 0.5 * hi, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {half.x, half.y, half.z}};
}

// Whether two are certainly further apart than `reach`, which is more than 2^-22 times the largest
// coordinate. The first asks the axes of `a` alone, which is enough where `b` is small.
bool apart_along_axes(const OrientedBox& a, const OrientedBox& b, double reach) noexcept;
bool stay_apart(const OrientedBox& a, const OrientedBox& b, double reach) noexcept;
// Likewise for points, along one axis.
bool apart_along(const Vec3d& axis, std::span<const Vec3d> a, std::span<const Vec3d> b,
                 double reach) noexcept;

} // namespace vox
