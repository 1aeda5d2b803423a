// Boxes in 8 bytes: 10 bits for each of the six sides, relative to a frame around all of them.
#pragma once

#include "dist/messages.hpp"

#include <cmath>

namespace vox::dist {

class Frame {
public:
    explicit Frame(const Box& box) noexcept : box_(box) {}

    // A box inside the frame, or one a little larger: never smaller.
    std::uint64_t pack(const Box& box) const noexcept {
        std::uint64_t packed = 0;
        for (int axis = 0; axis < 3; ++axis) {
            std::uint32_t min = near(axis, box.min[axis]), max = near(axis, box.max[axis]);
            while (side(axis, min) > box.min[axis]) --min;
            while (side(axis, max) < box.max[axis]) ++max;
            packed = packed << 2 * bits | min << bits | max;
        }
        return packed;
    }
    Box unpack(std::uint64_t packed) const noexcept {
        Box box;
        for (int axis = 2; axis >= 0; --axis, packed >>= 2 * bits) {
            box.min[axis] = side(axis, packed >> bits & last);
            box.max[axis] = side(axis, packed & last);
        }
        return box;
    }

private:
    static constexpr int bits = 10;
    static constexpr std::uint32_t last = (1u << bits) - 1;

    // The same on both sides of a message. It never falls as `at` rises; the ends are those of the frame.
    float side(int axis, std::uint64_t at) const noexcept {
        if (at == last) return box_.max[axis];
        const double min = box_.min[axis], width = box_.max[axis] - min;
        return static_cast<float>(min + static_cast<double>(at) * (width / last));
    }
    std::uint32_t near(int axis, float value) const noexcept {
        const double min = box_.min[axis], width = box_.max[axis] - min;
        return width > 0 ? static_cast<std::uint32_t>(std::lround((value - min) / width * last)) : 0;
    }

    Box box_;
};

} // namespace vox::dist
