// Where tetrahedra are of very unlike sizes, no one cell size is near the best for all of them: several grids
// side by side, each with the cell size that is best for the tetrahedra that look into it.
#pragma once

#include "cell_size/reference_model.hpp"
#include "reference/levels.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace vox {

struct Levels {
    double cost = 0; // of a step
    std::array<CellLevel, VOX_CELL_SIZE_LEVEL_CAPACITY> level{};
    std::uint32_t count = 0; // 0: there are no tetrahedra of any size

    std::span<const CellLevel> list() const noexcept { return {level.data(), count}; }
};

// The best way to share the size classes of the tetrahedra, in order, among at most that many grids, with
// cell sizes in the range. Every vertex is in each of them. One level where more do not pay.
Levels choose_levels(const ReferenceModel& cost, const CellSizeRange& range);

// The level that the boxes of a class look into: that of the smallest of them.
const CellLevel& level_of(const SizeClass& c, std::span<const CellLevel> levels);
// A step with these levels, one at least.
double cost_of_levels(const ReferenceModel& cost, std::span<const CellLevel> levels);

} // namespace vox
