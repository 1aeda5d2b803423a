// Where tetrahedra are of very unlike sizes, no one cell size is near the best for all of them. A level is a
// grid for some of the tetrahedra, with the cell size that is best for these.
#pragma once

#include "cell_size/reference_model.hpp"
#include "reference/levels.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace vox {

inline constexpr std::size_t most_levels = 4;

struct Levels {
    double cost = 0; // of a step
    std::array<CellLevel, most_levels> level{};
    std::uint32_t count = 0; // 0: there are no tetrahedra of any size

    std::span<const CellLevel> list() const noexcept { return {level.data(), count}; }
};

// The best way to distribute the size classes of the tetrahedra, in order of size, over up to
// most_levels levels with cell sizes in the range. Every vertex is in each of the grids. A
// further level is only used where it pays.
Levels choose_levels(const ReferenceModel& cost, const CellSizeRange& range);

// The level for the boxes of a class, by the smallest of them.
const CellLevel& level_of(const ReferenceModel::SizeClass& c, std::span<const CellLevel> levels);
// The cost of a step with these levels, of which there is at least one.
double cost_of_levels(const ReferenceModel& cost, std::span<const CellLevel> levels);

} // namespace vox
