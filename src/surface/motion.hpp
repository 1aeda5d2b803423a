// The motion that a surface is asked about.
#pragma once

#include "base/rounding.hpp"
#include "base/scene.hpp"
#include "base/vectors.hpp"

#include <cstdint>
#include <span>

namespace vox {

// Every vertex moves from one position to another along a straight line, at constant speed. Boxes reach
// further by `radius`, outward to the next number of the caller's format.
struct SurfaceMotion {
    std::span<const Vec3d> from, to; // the same span where everything stands still
    double radius = 0;
    bool doubles = false; // the caller's format; else every coordinate is a float
    bool cull = false;    // leave out pairs that stay further apart than 2 * radius
    // Far from zero, floats are far apart. There they are made of what is left of doubles without this point
    // in the middle of all.
    Vec3d origin{};
};

// One side of the box of a vertex, as vox_motion.radius has it. `at` is the lower, or the higher, of the two
// coordinates.
inline double lower_side(double at, double radius, bool doubles) noexcept {
    return doubles ? number_before(at - radius) : double{number_before(static_cast<float>(at - radius))};
}
inline double upper_side(double at, double radius, bool doubles) noexcept {
    return -lower_side(-at, radius, doubles);
}

// The box of a feature in motion, as vox_motion.radius has it.
struct ExactBox {
    ExactBox() noexcept = default;
    ExactBox(const SurfaceMotion& motion, std::span<const std::uint32_t> corners) noexcept
        : lo(motion.from[corners[0]]), hi(lo) {
        for (const std::uint32_t v : corners) {
            lo = min(lo, min(motion.from[v], motion.to[v]));
            hi = max(hi, max(motion.from[v], motion.to[v]));
        }
        const double r = motion.radius;
        const bool d = motion.doubles;
        lo = {lower_side(lo.x, r, d), lower_side(lo.y, r, d), lower_side(lo.z, r, d)};
        hi = {upper_side(hi.x, r, d), upper_side(hi.y, r, d), upper_side(hi.z, r, d)};
    }
    bool overlaps(const ExactBox& other) const noexcept {
        return lo.x <= other.hi.x && lo.y <= other.hi.y && lo.z <= other.hi.z && other.lo.x <= hi.x &&
               other.lo.y <= hi.y && other.lo.z <= hi.z;
    }

    Vec3d lo, hi;
};

} // namespace vox
