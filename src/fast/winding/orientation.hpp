// Which tets of a body may have turned over since they were last found positive. While super-tiles deform
// nearly affinely these are few, and only they have to be oriented again.
//
// The width of a tet is the smallest distance of two parallel planes that have it between them. An affine map
// of a super-tile takes the width of no tet below its smallest singular value times what it was. When what is
// then left of the displacements is in a box, the extent of a tet in any direction, and so its width, changes
// by the diagonal of the box at most. If that is less than the width, the corners are never in one plane on a
// straight way from where the affine map takes them to where they are. So a tet that was positive still is if
// its width was above that diagonal, divided by the singular value, and the map has a positive determinant.
#pragma once

#include "base/boxes.hpp"
#include "fast/step.hpp"
#include "mesh/boundary.hpp"
#include "mesh/tiles.hpp"

#include <cstdint>
#include <memory_resource>
#include <vector>

namespace vox {
class Workers;
}

namespace vox::fast {

// Some vertices of a super-tile and where they were in its reference step, as points of a cubic lattice. Its
// points are the unit of length of all that follows from them.
struct ShapePoints {
    static constexpr std::uint32_t size = 16;
    alignas(32) std::int16_t place[3][size];
    std::uint32_t vertex[size];
};

// A super-tile as it was in its reference step, the last one in which the widths of its tets were measured.
struct Shape {
    static constexpr std::uint32_t samples = 8;
    // The columns of an affine map from the lattice that fits the super-tile in a step are these sums over
    // its first vertices. The last column is where the map takes the middle of the lattice.
    float weight[4][samples];
    std::uint32_t first = 0, count = 0;      // of OrientationCache::points; no count: vertices are not listed
    float least_slack = 0, most_slack = 0;   // of its tiles
    std::uint32_t measured = 0, resumes = 0; // when; when it may next be measured; OrientationCache::step
    std::uint32_t failed_at_first = 0; // tiles that could not be followed in the step after the reference
    bool is_known = false;             // whether there was a reference step
    bool is_due = false;               // whether this is a reference step
    bool holds_last_vertex = false;    // of the mesh
};

// What is kept of a body from step to step.
struct OrientationCache {
    explicit OrientationCache(std::pmr::memory_resource* memory) noexcept
        : points(memory), shapes(memory), slack(memory) {}

    std::pmr::vector<ShapePoints> points;
    std::pmr::vector<Shape> shapes; // of super-tiles
    // Of each tile, a lower bound on the widths of its tets in the reference step. Where it is not above 0,
    // nothing is known, or some of them were not positive.
    std::pmr::vector<float> slack;
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

// The same for all bodies that moved and that winding numbers may be of use for (StepBody::boundary).
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

// Of one tile: its box, that set, and a lower bound on the widths of its tets, of their rounded positions; 0
// when a tet is in the set.
float measure_tile(const Tiles& tiles, const Boundary& boundary, const float* positions, bool rounded,
                   std::uint32_t tile, Box& box, std::uint64_t& bad);

// Whether to measure a super-tile anew, of whose tiles so many could not be followed; `flat` are those that
// hardly can be, as they were too flat in the reference step. Called once in each step in which not all tiles
// are positive.
bool wants_reference(Shape& shape, std::uint32_t failed, std::uint32_t flat, std::uint32_t tiles,
                     std::uint32_t step) noexcept;

} // namespace vox::fast
