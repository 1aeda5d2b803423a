// A uniform grid of tiles: every cell lists the tiles whose boxes meet it. Space is not bounded: cells are
// hashed (Teschner et al. 2003, Sect. 4.1).
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"

#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

class TileGrid {
public:
    explicit TileGrid(std::pmr::memory_resource* memory) noexcept
        : first_(memory), entries_(memory), cells_(memory), large_(memory) {}

    // Puts the boxes in. The cell size is raised where the boxes would be in more than some 64 cells each.
    // Throws what the memory throws.
    void fill(std::span<const Box> boxes, double cell_size);

    std::uint64_t occupied() const noexcept { return occupied_; } // cells that hold something

    // Calls visit(i) for every box that may overlap `box`, some of them more than once, and for others too.
    template <class Visit>
    void around(const Box& box, Visit&& visit) const {
        const Range range = range_of(box);
        if (range.cells() > static_cast<double>(box_count_)) { // cheaper than so many cells
            for (std::uint32_t i = 0; i < box_count_; ++i) visit(i);
            return;
        }
        for (const std::uint32_t i : large_) visit(i);
        range.for_each([&](std::int64_t x, std::int64_t y, std::int64_t z) {
            const std::uint32_t bucket = bucket_of(x, y, z);
            for (std::uint32_t e = first_[bucket]; e < first_[bucket + 1]; ++e) visit(entries_[e]);
        });
    }

private:
    struct Range {
        std::int64_t lo[3], hi[3];

        double cells() const noexcept;
        template <class Visit>
        void for_each(Visit&& visit) const {
            for (std::int64_t z = lo[2]; z <= hi[2]; ++z)
                for (std::int64_t y = lo[1]; y <= hi[1]; ++y)
                    for (std::int64_t x = lo[0]; x <= hi[0]; ++x) visit(x, y, z);
        }
    };

    Range range_of(const Box& box) const noexcept;
    std::uint32_t bucket_of(std::int64_t x, std::int64_t y, std::int64_t z) const noexcept;

    double per_length_ = 0;
    std::uint32_t box_count_ = 0;
    std::uint64_t occupied_ = 0;
    unsigned shift_ = 63; // of a hash to a bucket
    Array<std::uint32_t> first_, entries_;
    Array<std::uint32_t> cells_; // the bucket of each entry, in the order of boxes
    Array<std::uint32_t> large_; // boxes that are in no cell, and visited from everywhere
};

} // namespace vox
