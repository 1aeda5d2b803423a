// How a super-tile moved since its reference step: an affine map, and a bound on what that leaves.
//
// The width of a tet is the smallest distance of two parallel planes that have it between them. An affine map
// of a super-tile takes the width of no tet below its smallest singular value times what it was. When what is
// then left of the displacements is in a box, the extent of a tet in any direction, and so its width, changes
// by the diagonal of the box at most. If that is less than the width, the corners are never in one plane on a
// straight way from where the affine map takes them to where they are. So a tet that was positive still is if
// its width was above that diagonal, divided by the singular value, and the map has a positive determinant.
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "mesh/tiles.hpp"

#include <cstdint>
#include <memory_resource>

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

inline constexpr float nothing_known = float_infinity; // of a change

// Follows a super-tile to where it is, and makes its box. Returns its change: a bound on what slack tets must
// have had to be certainly positive. Below `enough` it need not be sharp. `rounding` is what rounding may
// have done to widths.
float follow(const float* positions, const Shape& shape, const ShapePoints* points, float rounding,
             float enough, Box& box) noexcept;

// Makes this the reference step. Returns how many points of the lattice a unit of length is; 0 where the
// super-tile is too small or too large for a lattice.
float place(const float* positions, Shape& shape, ShapePoints* points) noexcept;

// Lists the vertices of super-tiles, each once.
class ShapeLister {
public:
    ShapeLister(const Tiles& tiles, const float* positions, std::uint32_t vertex_count,
                std::pmr::memory_resource* memory)
        : tiles_(tiles), positions_(positions), vertex_count_(vertex_count), seen_(memory), list_(memory) {}

    // Appends those of one to `points`.
    void list(std::uint32_t super_tile, Shape& shape, Array<ShapePoints>& points);

private:
    void find_vertices(std::uint32_t super_tile);
    void put_samples_first();

    const Tiles& tiles_;
    const float* positions_;
    std::uint32_t vertex_count_;
    Array<std::uint32_t> seen_, list_;
};

} // namespace vox::fast
