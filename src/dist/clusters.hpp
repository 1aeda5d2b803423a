// Clusters along a curve of Morton's through the points.
#pragma once

#include "dist/part.hpp"

#include <algorithm>

namespace vox::dist {

// Three numbers of 10 bits, interleaved.
inline std::uint32_t interleaved(const std::uint32_t cell[3]) noexcept {
    std::uint32_t code = 0;
    for (std::uint32_t bit = 0; bit < 10; ++bit)
        for (std::uint32_t axis = 0; axis < 3; ++axis) code |= (cell[axis] >> bit & 1) << (3 * bit + axis);
    return code;
}

template <class Point>
void Clusters::make(std::uint32_t count, std::uint32_t size, Point&& point) {
    double low[3] = {}, high[3] = {};
    double at[3];
    for (std::uint32_t i = 0; i < count; ++i) {
        point(i, at);
        for (int axis = 0; axis < 3; ++axis) {
            if (i == 0 || at[axis] < low[axis]) low[axis] = at[axis];
            if (i == 0 || at[axis] > high[axis]) high[axis] = at[axis];
        }
    }
    Array<std::uint64_t> keys(order.memory());
    keys.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        point(i, at);
        std::uint32_t cell[3];
        for (int axis = 0; axis < 3; ++axis) {
            const double width = high[axis] - low[axis];
            cell[axis] = width > 0 ? static_cast<std::uint32_t>((at[axis] - low[axis]) / width * 1023) : 0;
        }
        keys[i] = std::uint64_t{interleaved(cell)} << 32 | i;
    }
    std::sort(keys.begin(), keys.end());
    order.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) order[i] = static_cast<std::uint32_t>(keys[i]);
    begins.clear();
    for (std::uint32_t i = 0; i < count; i += size) begins.push_back(i);
    boxes.assign(begins.size(), Box{});
    begins.push_back(count);
}

} // namespace vox::dist
