#include "cell_size/branch_misses.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

namespace {

// The smallest cell size, as a part of the longest side of the smallest box.
constexpr double smallest = 0.5;
// Cells along an axis. The longest side is below four of the smallest cells, so a box meets at most five; one
// more for rounding, and one on either side for points that are in none of them.
constexpr std::uint32_t row = 8;

} // namespace

double BranchMisses::cell_size(std::size_t i) const noexcept {
    const double within = 1 + static_cast<double>(i % per_octave) / per_octave;
    return smallest * scale_ * within * static_cast<double>(std::uint32_t{1} << (i / per_octave));
}

std::size_t BranchMisses::first_above(double distance) noexcept {
    return class_of_ratio(distance / smallest, bits_per_octave);
}

void BranchMisses::add(const double (&lo)[3], const double (&hi)[3], std::span<const Point> points,
                       double known) {
    ++boxes_;
    // Points sorted by the first size whose cells they can be in (counting sort).
    std::array<std::uint16_t, sizes + 1> end{}, next{};
    for (const Point& p : points) ++end[std::min(first_above(double{p.distance}), sizes)];
    std::uint16_t sum = 0;
    for (std::size_t i = 0; i <= sizes; ++i) {
        next[i] = sum;
        end[i] = sum = static_cast<std::uint16_t>(sum + end[i]);
    }
    std::array<float, most_points> x, y, z;
    for (const Point& p : points) {
        const std::size_t n = next[std::min(first_above(double{p.distance}), sizes)]++;
        x[n] = p.at[0];
        y[n] = p.at[1];
        z[n] = p.at[2];
    }

    std::array<std::uint32_t, most_points> cell_of;
    std::array<std::uint16_t, row * row * row> length;
    for (std::size_t i = 0; i < sizes; ++i) {
        const double size = cell_size(i), per_size = 1 / size;
        if (size > known) return;
        float before[3]; // from the corner of the cell before the first one to the box's, in cells
        std::uint32_t cells[3];
        for (std::size_t a = 0; a < 3; ++a) {
            const double at = lo[a] * per_size, within = at - std::floor(at);
            before[a] = static_cast<float>(1 + within);
            cells[a] = std::min(static_cast<std::uint32_t>((hi[a] - lo[a]) * per_size + within) + 1, row - 2);
        }
        const auto in_cells = static_cast<float>(scale_ * per_size);
        const std::size_t near = end[i];
        for (std::size_t n = 0; n < near; ++n) {
            const auto cx = static_cast<std::int32_t>(x[n] * in_cells + before[0]),
                       cy = static_cast<std::int32_t>(y[n] * in_cells + before[1]),
                       cz = static_cast<std::int32_t>(z[n] * in_cells + before[2]);
            cell_of[n] = static_cast<std::uint32_t>((cz * std::int32_t{row} + cy) * std::int32_t{row} + cx) %
                         length.size();
        }
        length.fill(0);
        for (std::size_t n = 0; n < near; ++n) ++length[cell_of[n]];
        // The cell visited before the first one is not known; the last one stands for it.
        std::uint16_t previous = length[(cells[2] * row + cells[1]) * row + cells[0]];
        std::uint32_t changes = 0;
        for (std::uint32_t cz = 1; cz <= cells[2]; ++cz)
            for (std::uint32_t cy = 1; cy <= cells[1]; ++cy)
                for (std::uint32_t cx = 1; cx <= cells[0]; ++cx) {
                    const std::uint16_t here = length[(cz * row + cy) * row + cx];
                    changes += here != previous;
                    previous = here;
                }
        ++known_boxes_[i];
        visited_[i] += cells[0] * cells[1] * cells[2];
        changed_[i] += changes;
    }
}

void BranchMisses::finish() noexcept {
    // Sizes that were only counted around boxes with few points nearby would misrepresent the others.
    while (known_ < sizes && 4 * known_boxes_[known_] > 3 * boxes_) ++known_;
    const auto at = [&](std::size_t i) {
        return static_cast<float>(changed_[i]) / static_cast<float>(visited_[i]);
    };
    for (std::size_t i = 0; i < known_; ++i)
        share_[i] = (at(i > 0 ? i - 1 : i) + 2 * at(i) + at(std::min(i + 1, known_ - 1))) / 4;
}

double BranchMisses::nearest(double size) const noexcept {
    return known_ == 0 ? 0 : std::clamp(size, cell_size(0), cell_size(known_ - 1));
}

double BranchMisses::share(double size) const noexcept {
    const std::size_t above = std::clamp<std::size_t>(first_above(size / scale_), 1, known_), i = above - 1;
    if (above == known_) return double{share_[i]};
    const double below = cell_size(i), part = (size - below) / (cell_size(above) - below);
    return double{share_[i]} + std::max(part, 0.0) * (double{share_[above]} - double{share_[i]});
}

} // namespace vox
