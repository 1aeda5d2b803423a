// Items in groups of near ones, each with a box.
#pragma once

#include "base/array.hpp"
#include "base/bits.hpp"
#include "base/boxes.hpp"
#include "base/rounding.hpp"
#include "base/scene.hpp"
#include "base/vectors.hpp"

#include <algorithm>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox::dist {

// `order` lists the items of the first cluster, then of the next.
class Clusters {
public:
    explicit Clusters(std::pmr::memory_resource* memory) : order(memory), begins(memory), boxes(memory) {}

    // Clusters of `size` items that follow each other on a Z-shaped curve through point(0), ...,
    // point(count - 1). Their boxes are empty.
    template <class Point>
    void make(std::uint32_t count, std::uint32_t size, Point&& point) {
        Vec3d low{}, high{};
        for (std::uint32_t i = 0; i < count; ++i) {
            const Vec3d p = point(i);
            low = i == 0 ? p : min(low, p);
            high = i == 0 ? p : max(high, p);
        }
        const auto cell = [](double x, double least, double most) {
            return most > least ? static_cast<std::uint32_t>((x - least) / (most - least) * 1023) : 0u;
        };
        Array<std::uint64_t> keys(order.memory());
        keys.reserve(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            const Vec3d p = point(i);
            const std::uint32_t code =
                morton_code(cell(p.x, low.x, high.x), cell(p.y, low.y, high.y), cell(p.z, low.z, high.z));
            keys.push_back(std::uint64_t{code} << 32 | i);
        }
        std::ranges::sort(keys);
        order.resize(count);
        for (std::uint32_t i = 0; i < count; ++i) order[i] = static_cast<std::uint32_t>(keys[i]);
        begins.clear();
        for (std::uint32_t i = 0; i < count; i += size) begins.push_back(i);
        boxes.assign(begins.size(), empty_box3f());
        begins.push_back(count);
    }

    // Computes the boxes of items that are points. Returns a box around all.
    Box3f update_boxes(const Positions& positions) {
        Box3f all = empty_box3f();
        for (std::uint32_t c = 0; c < size(); ++c) {
            boxes[c] = empty_box3f();
            for (const std::uint32_t item : of(c)) extend(boxes[c], rounded_box(positions.exact(item)));
            extend(all, boxes[c]);
        }
        return all;
    }

    std::uint32_t size() const noexcept { return static_cast<std::uint32_t>(boxes.size()); }
    std::span<const std::uint32_t> of(std::uint32_t cluster) const noexcept {
        return {order.data() + begins[cluster], order.data() + begins[cluster + 1]};
    }

    Array<std::uint32_t> order;
    Array<std::uint64_t> begins;
    Array<Box3f> boxes;
};

} // namespace vox::dist
