// Which tets of a body may have turned over since they were last found positive. While super-tiles deform
// nearly affinely these are few, and only they have to be oriented again (proof: shape.hpp).
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "fast/step.hpp"
#include "fast/winding/shape.hpp"
#include "mesh/boundary.hpp"
#include "mesh/tiles.hpp"

#include <cstdint>
#include <memory_resource>

namespace vox {
class Workers;
}

namespace vox::fast {

// Kept of a body from step to step.
struct OrientationCache {
    explicit OrientationCache(std::pmr::memory_resource* memory) noexcept
        : points(memory), shapes(memory), slack(memory) {}

    Array<ShapePoints> points;
    Array<Shape> shapes; // of super-tiles
    // Of each tile, a lower bound on the widths of its tets in the reference step. Where it is not above 0,
    // nothing is known, or some of them were not positive.
    Array<float> slack;
    bool is_used = false;      // whether the last step needed to know which tets are positive
    std::uint32_t step = 0;    // counts those in which it did
    std::size_t abandoned = 0; // points

    // Makes room for the tiles of a body. Nothing is known of those that came with an edit.
    void prepare(const Tiles& tiles);
    // A super-tile has got new tets: nothing is known of it.
    void forget(std::uint32_t super_tile) noexcept;
};

// What rounding positions in `box` takes from widths, once in the reference step, and again when they are
// compared with it.
float slack_of_rounding(const Box& box) noexcept;

// Makes boxes that hold the super-tiles [first, last) of a body. `blocks` are those of all its blocks;
// `rounding` is slack_of_rounding(), or 0 where positions are not rounded. `change` gets what slack a tile
// must have had to be certainly positive; infinite where nothing is known. `positive` gets whether that holds
// for all tiles of the super-tile.
void track_orientation(const Tiles& tiles, const OrientationCache& cache, const float* positions,
                       const Box* blocks, float rounding, std::uint32_t first, std::uint32_t last,
                       Box* super_boxes, float* change, std::uint8_t* positive);

// Tracks all bodies that moved and that winding numbers may be of use for (StepBody::boundary).
void track_orientation(Step& step, StepBoxes& boxes);

// A body whose tets are to be oriented.
struct OrientedBody {
    const Tiles& tiles;
    const Boundary& boundary;
    const float* positions; // packed
    std::uint32_t vertex_count;
    bool rounded;        // whether the positions are
    float rounding;      // as in track_orientation()
    const float* change; // from there
    const std::uint8_t* positive;
    Box* tile_boxes; // boxes that are needed are made
    std::uint8_t* tile_known;
};

// For each tile of super-tiles that are not all positive, finds the set of tets that are neither known to be
// positive nor found so by the float filter (narrow-inl.hpp). Measures super-tiles anew where that pays.
void orient(const OrientedBody& body, OrientationCache& cache, std::uint64_t* bad, Workers* workers);

// Makes the box of a tile and that set. Returns a lower bound on the widths of its tets, of their rounded
// positions; 0 when a tet is in the set.
float measure_tile(const Tiles& tiles, const Boundary& boundary, const float* positions, bool rounded,
                   std::uint32_t tile, Box& box, std::uint64_t& bad);

// True if to measure a super-tile anew, of whose tiles so many could not be followed; `flat` are those that
// hardly can be, as they were too flat in the reference step. Called once in each step in which not all tiles
// are positive.
bool wants_reference(Shape& shape, std::uint32_t failed, std::uint32_t flat, std::uint32_t tiles,
                     std::uint32_t step) noexcept;

} // namespace vox::fast
