// Boxes along axes of their own, for tiles whose features are long and thin: these fill little of a box along
// the coordinate axes, but much of a box along their length.
#pragma once

#include "base/boxes.hpp"
#include "base/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace vox {

struct OrientedBox {
    Vec3d middle, axis[3]; // of length 1, at right angles to each other
    double half[3];        // sides
};

// The box around at least one point. Its first side is along a direction, which may be zero; its second
// points from the first point to the point furthest from the line along it.
OrientedBox oriented_box(std::span<const Vec3d> points, const Vec3d& along) noexcept;
inline OrientedBox oriented_box(const Box& box) noexcept {
    const Vec3d lo{box.lo[0], box.lo[1], box.lo[2]}, hi{box.hi[0], box.hi[1], box.hi[2]};
    const Vec3d half = 0.5 * hi - 0.5 * lo;
    return {0.5 * lo + 0.5 * hi, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {half.x, half.y, half.z}};
}

// Half of what a box spans along an axis.
inline double extent(const OrientedBox& box, const Vec3d& w) noexcept {
    return box.half[0] * std::abs(dot(w, box.axis[0])) + box.half[1] * std::abs(dot(w, box.axis[1])) +
           box.half[2] * std::abs(dot(w, box.axis[2]));
}

// Whether two are certainly further apart than `reach`, which is more than 2^-22 times the largest
// coordinate. The first asks the axes of `a` alone, which is enough where `b` is small.
bool apart_along_axes(const OrientedBox& a, const OrientedBox& b, double reach) noexcept;
bool stay_apart(const OrientedBox& a, const OrientedBox& b, double reach) noexcept;

inline Vec3d longest_edge(const Vec3d& a, const Vec3d& b, const Vec3d& c) noexcept {
    const auto by_length = [](const Vec3d& u, const Vec3d& v) { return dot(u, u) < dot(v, v); };
    return std::max({b - a, c - b, a - c}, by_length);
}

} // namespace vox
