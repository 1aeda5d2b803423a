// What several grids side by side would cost, each with the cell size that is best for the tetrahedra that
// look into it: the measure of what one cell size for all of them loses.
#pragma once

#include "reference_cost.hpp"

#include <array>
#include <cstdint>

namespace vox {

struct Levels {
    double cost = 0;                                              // of a step, at the sizes below
    std::array<double, VOX_CELL_SIZE_LEVEL_CAPACITY> cell_size{}; // for the smallest tets first
    std::uint32_t count = 0;
};

// The best way to share the size classes of the tetrahedra, in order, among at most that many grids. Every
// vertex is in each of them. One level where more do not pay.
Levels choose_levels(const ReferenceCost& cost);

} // namespace vox
