// Which tets of a body may have turned over since they were last found positive. Where bodies deform a little
// these are few, and only they have to be oriented again.
//
// The width of a tet is the smallest distance of two parallel planes that have it between them. When the
// displacements of its corners are in a box, its extent in any direction, and so its width, changes by the
// diagonal of the box at most. If that is less than the width, the corners are never in one plane on a
// straight way from the old positions to the new ones, and the tet does not turn over.
#pragma once

#include "base/boxes.hpp"
#include "fast/step.hpp"
#include "mesh/boundary.hpp"
#include "mesh/tiles.hpp"

#include <cstdint>
#include <memory_resource>
#include <vector>

namespace vox::fast {

// What is kept of a body from step to step: its positions in an earlier step, and what was found then.
struct OrientationCache {
    explicit OrientationCache(std::pmr::memory_resource* memory) noexcept
        : reference(memory), slack(memory), boxes(memory) {}

    std::pmr::vector<float> reference; // the positions, packed
    // Of each super-tile, a lower bound on the widths of its tets then, less slack_of_rounding() where the
    // positions were rounded. Where it is not above 0, nothing is known, or some of them were not positive.
    std::pmr::vector<float> slack;
    std::pmr::vector<Box> boxes; // around the vertices of super-tiles that have slack
    bool is_known = false;       // whether all these are valid
    std::uint32_t age = 0;       // steps since then
    std::uint32_t wait = 0;      // steps before a new reference may be taken
};

// What rounding positions in `box` takes from the slack, once when they become the reference, and again when
// they are compared with it.
float slack_of_rounding(const Box& box) noexcept;

// Makes boxes that hold the super-tiles [first, last) of a body, and finds out which of them hold no tet that
// may have turned over. `blocks` are the boxes of all its blocks; `moves`, those around their displacements
// from the reference, or null; `rounding` is slack_of_rounding(), or 0 where positions are not rounded.
void track_orientation(const Tiles& tiles, const OrientationCache& cache, const Box* blocks, const Box* moves,
                       float rounding, std::uint32_t first, std::uint32_t last, Box* super_boxes,
                       std::uint8_t* positive);

// The same for all bodies that moved and that winding numbers may be of use for (StepBody::boundary).
void track_orientation(Step& step, StepBoxes& boxes);

// Whether to take a new reference, when `doubtful` of all super-tiles may hold a tet that turned over. Called
// once in a step.
bool wants_reference(OrientationCache& cache, std::uint32_t doubtful, std::uint32_t super_tiles) noexcept;

// Makes the boxes of the tiles [first, last) and, for each, the set of tets that the float filter
// (narrow-inl.hpp) does not find positive. With `measure`, returns a lower bound on the widths of the tets,
// of their rounded positions; 0 when a tet is in a set.
float orient(const Tiles& tiles, const Boundary& boundary, const float* positions, bool rounded,
             std::uint32_t first, std::uint32_t last, Box* boxes, std::uint8_t* known, std::uint64_t* bad,
             bool measure);

} // namespace vox::fast
