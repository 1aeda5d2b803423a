// When a point that moves meets a convex set.
#pragma once

#include "base/vectors.hpp"
#include "shape/shape.hpp"

#include <algorithm>

namespace vox {

// RigidShape::meeting() of a convex set, of which look(p, out) says how far p is away, and which way. The set
// lies behind the plane through its closest point, so p cannot meet it before that plane: Newton's method,
// from outside.
template <class Look>
double convex_meeting(const Vec3d& from, const Vec3d& to, const Look& look, ShapePoint& at) noexcept {
    constexpr int most_planes = 64; // a way that grazes takes so many, and counts as meeting
    constexpr double shorter = 1 - 0x1p-48;
    const Vec3d way = to - from;
    const double close = 0x1p-46 * std::max(largest_coordinate(from), largest_coordinate(to));
    double time = 0;
    for (int plane = 0; plane < most_planes; ++plane) {
        ShapePoint seen;
        look(from + time * way, seen);
        if (plane == 0 || seen.distance > close) at = seen; // else rounding turns the normal
        const double speed = -dot(at.normal, way);
        if (!(seen.distance > close)) return plane > 0 || speed > 0 ? time : no_meeting;
        if (!(speed > 0 && time + seen.distance / speed * shorter <= 1)) return no_meeting;
        time += seen.distance / speed * shorter;
    }
    return time;
}

} // namespace vox
