// Stage 6: which vertices of a body can lie in its own tetrahedra at all, by winding numbers. In a compact
// body that does not touch itself: none, and next to nothing but its surface was looked at to know.
#pragma once

#include "surface.hpp"
#include "turning.hpp"
#include "window.hpp"

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox {
class Workers;
}

namespace vox::fast {

// Cells of a lattice around a body, and in which of them a point is covered by at most one tet.
struct Certificate {
    explicit Certificate(std::pmr::memory_resource* memory)
        : directions(memory), queue(memory), touched(memory), bad(memory), certified(memory) {}

    // Buffers.
    std::pmr::vector<std::uint32_t> directions, queue, touched;
    std::pmr::vector<std::uint64_t> bad;

    Lattice lattice;
    std::pmr::vector<std::uint8_t> certified;  // per cell
    std::uint32_t first[3] = {}, last[3] = {}; // range of the cells that are not
    bool complete = false;                     // there are none

    // All cells from `lo` to `hi`, as far as a look at them is cheap, are certified.
    bool holds(const std::uint32_t* lo, const std::uint32_t* hi) const noexcept {
        constexpr std::uint32_t few = 16;
        if (std::uint64_t{hi[0] - lo[0] + 1} * (hi[1] - lo[1] + 1) * (hi[2] - lo[2] + 1) > few) return false;
        for (std::uint32_t z = lo[2]; z <= hi[2]; ++z)
            for (std::uint32_t y = lo[1]; y <= hi[1]; ++y)
                for (std::uint32_t x = lo[0]; x <= hi[0]; ++x)
                    if (!certified[(std::size_t{z} * lattice.cells[1] + y) * lattice.cells[0] + x])
                        return false;
        return true;
    }
    bool holds(const float* p) const noexcept {
        return certified[(std::size_t{lattice.cell(p[2], 2)} * lattice.cells[1] + lattice.cell(p[1], 1)) *
                             lattice.cells[0] +
                         lattice.cell(p[0], 0)] != 0;
    }
};

struct WindingBody {
    const Tiles& tiles;
    const Surface& surface;
    const float* positions; // packed
    std::uint32_t vertex_count;
    Box box;
    double cell_size;                  // of the lattice
    const Box* super_boxes;            // boxes that hold the super-tiles
    const std::uint8_t* super_upright; // super-tiles whose tets are known to be positive
    Box* tile_boxes;                   // those that were looked at are known afterwards
    std::uint8_t* tile_known;
    Turning& turning; // renewed where that pays
    Workers* workers; // not null: share the pass over the tiles, as one task
    // The packed positions are those in `exact` less `origin`, rounded to floats.
    bool rounded = false;
    Vec3d origin{};
    Positions exact{};
};

// Fills `out` so that no vertex in a certified cell lies in a tet that does not own it, vertices of no tet
// (see Surface::loose) excepted. False: it would not pay, or cannot be told; use all vertices. `exact_tests`
// as in predicates.hpp.
bool certify(const WindingBody& body, Certificate& out, std::uint64_t& exact_tests);

} // namespace vox::fast
