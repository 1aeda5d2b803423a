// Doubles rounded to floats on a known side.
#pragma once

#include "base/scene.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

namespace vox {

// The largest float that is not above x, and no more than the largest finite one.
inline float rounded_down(double x) noexcept {
    const float f = std::min(static_cast<float>(x), std::numeric_limits<float>::max()); // to nearest
    // Where that is above x, the float before it. Without a branch, which would mispredict for half of all
    // numbers.
    const std::uint32_t bits = f == 0 ? 0x80000000u : std::bit_cast<std::uint32_t>(f);
    const std::uint32_t is_above = double{f} > x, is_negative = bits >> 31;
    return std::bit_cast<float>(bits + is_above * (2 * is_negative - 1));
}

// The smallest float that is not below x.
inline float rounded_up(double x) noexcept { return -rounded_down(-x); }

// The smallest box of floats around a point.
inline Box3f rounded_box(const Vec3d& p) noexcept {
    return {{rounded_down(p.x), rounded_down(p.y), rounded_down(p.z)},
            {rounded_up(p.x), rounded_up(p.y), rounded_up(p.z)}};
}

} // namespace vox
