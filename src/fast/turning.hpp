// Which tets of a body may have turned over since they were last found positive: few, as a rule, where bodies
// deform a little from step to step, so that few have to be looked at.
//
// The width of a tet is the least distance of two parallel planes that have it between them. While it is
// above zero the corners are not in one plane, and the tet does not turn over. When all displacements of its
// corners lie in a box with diagonal d, its extent in any direction changes by d at most; so does its width,
// and what is left of it stays above zero as long as the diagonals of all steps sum up to less.
#pragma once

#include "box.hpp"
#include "surface.hpp"
#include "tiles.hpp"

#include <cstdint>
#include <memory_resource>
#include <vector>

namespace vox::fast {

// Kept of a body from step to step.
struct Turning {
    explicit Turning(std::pmr::memory_resource* memory) noexcept : slack(memory) {}

    // Of each super-tile: its tets are positive, and stay so while the diagonals of the boxes around the
    // displacements of its vertices sum up to less. Zero: nothing is known.
    std::pmr::vector<float> slack;
    bool is_current = false; // slack is that of the positions in Rest
    bool is_wanted = false;  // the last step had to know which tets are positive
};

// What is left of `slack` after displacements within `moves`, which are differences of floats, rounded.
float spend(float slack, const Box& moves) noexcept;

// Makes the boxes of the tiles [first, last) and, for each, the set of tets that the float filter (query.cpp)
// does not find positive. Returns a lower bound on the widths of their tets: zero where one is in a set, or
// where positions are rounded.
float orient(const Tiles& tiles, const Surface& surface, const float* positions, bool rounded,
             std::uint32_t first, std::uint32_t last, Box* boxes, std::uint8_t* known, std::uint64_t* bad);

} // namespace vox::fast
