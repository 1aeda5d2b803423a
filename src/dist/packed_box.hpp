// Boxes in 8 bytes: 10 bits for each of the six sides, relative to a frame around all of them.
#pragma once

#include "base/boxes.hpp"

#include <cmath>
#include <cstdint>

namespace vox::dist {

class BoxPacking {
public:
    explicit BoxPacking(const Box3f& frame) noexcept : frame_(frame) {}

    // `box` is inside the frame. Unpacked, it is at least as large.
    std::uint64_t pack(const Box3f& box) const noexcept {
        std::uint64_t packed = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const float least = (&box.min.x)[axis], most = (&box.max.x)[axis];
            std::uint32_t low = nearest(axis, least), high = nearest(axis, most);
            while (side(axis, low) > least) --low;
            while (side(axis, high) < most) ++high;
            packed = packed << 2 * bits | low << bits | high;
        }
        return packed;
    }
    Box3f unpack(std::uint64_t packed) const noexcept {
        Box3f box;
        for (int axis = 2; axis >= 0; --axis, packed >>= 2 * bits) {
            (&box.min.x)[axis] = side(axis, packed >> bits & last);
            (&box.max.x)[axis] = side(axis, packed & last);
        }
        return box;
    }

private:
    static constexpr int bits = 10;
    static constexpr std::uint32_t last = (1u << bits) - 1;

    // Sender and receiver compute the same. It never falls as `at` rises; the ends are those of the frame.
    float side(int axis, std::uint64_t at) const noexcept {
        const double min = (&frame_.min.x)[axis], width = (&frame_.max.x)[axis] - min;
        if (at == last) return (&frame_.max.x)[axis];
        return static_cast<float>(min + static_cast<double>(at) * (width / last));
    }
    std::uint32_t nearest(int axis, float value) const noexcept {
        const double min = (&frame_.min.x)[axis], width = (&frame_.max.x)[axis] - min;
        return width > 0 ? static_cast<std::uint32_t>(std::lround((value - min) / width * last)) : 0;
    }

    Box3f frame_;
};

} // namespace vox::dist
