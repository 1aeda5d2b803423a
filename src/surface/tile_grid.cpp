#include "surface/tile_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vox {

namespace {

constexpr double most_cells_a_box = 64;      // on average
constexpr double most_cells_of_a_box = 4096; // one that would be in more is looked at from everywhere
constexpr std::size_t few_large = 16;        // so many of them are no reason for larger cells
constexpr double most_buckets = 0x1p30;      // more cells than that share some
constexpr double outermost = 0x1p52;         // cells from the origin; what is further out shares these

std::int64_t clamped_cell(double at) noexcept {
    return static_cast<std::int64_t>(std::floor(std::clamp(at, -outermost, outermost)));
}

} // namespace

double TileGrid::Range::cells() const noexcept {
    double product = 1;
    for (int a = 0; a < 3; ++a) product *= static_cast<double>(hi[a] - lo[a]) + 1;
    return product;
}

TileGrid::Range TileGrid::range_of(const Box& box) const noexcept {
    Range range;
    for (int a = 0; a < 3; ++a) {
        range.lo[a] = clamped_cell(double{box.lo[a]} * per_length_);
        range.hi[a] = clamped_cell(double{box.hi[a]} * per_length_);
    }
    return range;
}

std::uint32_t TileGrid::bucket_of(std::int64_t x, std::int64_t y, std::int64_t z) const noexcept {
    const std::uint64_t mixed = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u ^
                                std::rotl(static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fu, 21) ^
                                std::rotl(static_cast<std::uint64_t>(z) * 0x165667b19e3779f9u, 42);
    return static_cast<std::uint32_t>((mixed * 0x9e3779b97f4a7c15u) >> shift_);
}

void TileGrid::fill(std::span<const Box> boxes, double cell_size) {
    box_count_ = static_cast<std::uint32_t>(boxes.size());
    const double most = most_cells_a_box * static_cast<double>(boxes.size()) + 1024;
    double in_all;
    for (;; cell_size *= 2) {
        per_length_ = std::min(1 / cell_size, 0x1p1000);
        in_all = 0;
        large_.clear();
        std::size_t endless = 0;
        for (std::uint32_t i = 0; i < box_count_; ++i) {
            if (is_empty(boxes[i])) continue;
            const double cells = range_of(boxes[i]).cells();
            if (cells <= most_cells_of_a_box) {
                in_all += cells;
            } else {
                large_.push_back(i);
                endless += !has_ends(boxes[i]);
            }
        }
        if ((in_all <= most && large_.size() - endless <= few_large) || cell_size > 1e300) break;
    }
    const std::uint32_t buckets =
        std::bit_ceil(static_cast<std::uint32_t>(std::clamp(2 * in_all, 2.0, most_buckets)));
    shift_ = 64u - static_cast<unsigned>(std::countr_zero(buckets));
    first_.assign(std::size_t{buckets} + 1, 0u);
    cells_.clear();
    const auto for_each_cell = [&](auto&& visit) {
        for (std::uint32_t i = 0; i < box_count_; ++i) {
            if (is_empty(boxes[i])) continue;
            const Range range = range_of(boxes[i]);
            if (range.cells() <= most_cells_of_a_box)
                range.for_each([&](std::int64_t x, std::int64_t y, std::int64_t z) { visit(i, x, y, z); });
        }
    };
    for_each_cell([&](std::uint32_t, std::int64_t x, std::int64_t y, std::int64_t z) {
        cells_.push_back(bucket_of(x, y, z));
        ++first_[cells_.back() + 1];
    });
    occupied_ = 0;
    for (std::uint32_t b = 1; b <= buckets; ++b) {
        occupied_ += first_[b] != 0;
        first_[b] += first_[b - 1];
    }
    entries_.resize(cells_.size());
    // first_[b + 1] is where the next one of bucket b goes, and its end at last.
    for (std::uint32_t b = buckets; b > 0; --b) first_[b] = first_[b - 1];
    std::size_t next = 0;
    for_each_cell([&](std::uint32_t i, std::int64_t, std::int64_t, std::int64_t) {
        entries_[first_[cells_[next++] + 1]++] = i;
    });
}

} // namespace vox
