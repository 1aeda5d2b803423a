// Doubles rounded to floats on a known side.
#pragma once

#include "base/scene.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace vox {

// The number before x, in the order of floats or doubles: that of std::nextafter(x, -infinity), but without a
// call or a branch. x is a number.
template <class Number>
Number number_before(Number x) noexcept {
    using Bits = std::conditional_t<sizeof(Number) == 4, std::uint32_t, std::uint64_t>;
    constexpr Bits sign = Bits{1} << (8 * sizeof(Number) - 1);
    constexpr auto lowest = std::bit_cast<Bits>(-std::numeric_limits<Number>::infinity());
    const Bits bits = x == 0 ? sign : std::bit_cast<Bits>(x);
    const Bits is_negative = bits >> (8 * sizeof(Number) - 1), is_lowest = bits == lowest;
    return std::bit_cast<Number>(bits + (2 * is_negative - 1) * (1 - is_lowest));
}

// The largest float that is not above x, and no more than the largest finite one.
inline float rounded_down(double x) noexcept {
    const float f = std::min(static_cast<float>(x), std::numeric_limits<float>::max()); // to nearest
    const auto before = std::bit_cast<std::uint32_t>(number_before(f));
    return std::bit_cast<float>(double{f} > x ? before : std::bit_cast<std::uint32_t>(f));
}

// The smallest float that is not below x.
inline float rounded_up(double x) noexcept { return -rounded_down(-x); }

// The smallest box of floats around a point.
inline Box3f rounded_box(const Vec3d& p) noexcept {
    return {{rounded_down(p.x), rounded_down(p.y), rounded_down(p.z)},
            {rounded_up(p.x), rounded_up(p.y), rounded_up(p.z)}};
}

} // namespace vox
