// The motion that a surface is asked about.
#pragma once

#include "base/scene.hpp"

#include <cmath>
#include <limits>
#include <span>

namespace vox {

// Every vertex moves from one position to another along a straight line, at constant speed. Boxes reach
// further by `radius`, outward to the next number of the caller's format.
struct SurfaceMotion {
    std::span<const Vec3d> from, to; // the same span where everything stands still
    double radius = 0;
    bool doubles = false; // the caller's format; else every coordinate is a float
    bool cull = false;    // leave out pairs that stay further apart than 2 * radius

    bool moves() const noexcept { return from.data() != to.data(); }
};

// One side of the box of a vertex, as vox_motion.radius has it. `at` is the lower, or the higher, of the two
// coordinates.
inline double lower_side(double at, double radius, bool doubles) noexcept {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (doubles) return std::nextafter(at - radius, -infinity);
    return double{std::nextafter(static_cast<float>(at - radius), -static_cast<float>(infinity))};
}
inline double upper_side(double at, double radius, bool doubles) noexcept {
    return -lower_side(-at, radius, doubles);
}

} // namespace vox
