// Which vertices of a body may be in its own tetrahedra, by winding numbers. In a compact body that does not
// touch itself there are none, and to find that out little more than its boundary is read.
#pragma once

#include "fast/winding/components.hpp"
#include "fast/winding/orientation.hpp"
#include "fast/window.hpp"
#include "mesh/boundary.hpp"

#include <cstdint>
#include <memory_resource>
#include <span>
#include <tuple>
#include <vector>

namespace vox {
class Workers;
}

namespace vox::fast {

// Cells of a lattice around a body. In a certified cell, a point is covered by at most one tet.
struct Certificate {
    explicit Certificate(std::pmr::memory_resource* memory)
        : directions(memory), touched(memory), bad(memory), components(memory), certified(memory),
          with_next(memory) {}

    // Buffers.
    std::pmr::vector<std::uint32_t> directions, touched;
    std::pmr::vector<std::uint64_t> bad;
    Components components;

    WindowLattice lattice;
    std::pmr::vector<std::uint8_t> certified; // of each cell
    std::pmr::vector<std::uint8_t> with_next; // of each cell together with its next ones, up along any axes
    bool complete = false;                    // whether all cells are certified

    auto buffers() {
        return std::tie(directions, touched, bad, components.runs, components.rows, certified, with_next);
    }

    // Whether all cells that meet `box` are certified; false as well where they are too many to look at.
    bool holds(const Box& box) const noexcept {
        const WindowCell lo = lattice.cell(box.lo), hi = lattice.cell(box.hi);
        std::uint64_t cells = 1;
        bool is_small = true;
        for (int a = 0; a < 3; ++a) {
            cells *= hi.index[a] - lo.index[a] + 1;
            is_small &= hi.index[a] - lo.index[a] <= 1;
        }
        if (is_small && with_next[lattice.offset(lo)]) return true;
        constexpr std::uint32_t few =
            16; // a block has at most half as many vertices, which are looked up one by one then
        if (cells > few) return false;
        for (WindowCell c = lo; c.index[2] <= hi.index[2]; ++c.index[2])
            for (c.index[1] = lo.index[1]; c.index[1] <= hi.index[1]; ++c.index[1])
                for (c.index[0] = lo.index[0]; c.index[0] <= hi.index[0]; ++c.index[0])
                    if (!certified[lattice.offset(c)]) return false;
        return true;
    }
    bool holds(const float* p) const noexcept {
        const WindowCell c{{lattice.cell(p[0], 0), lattice.cell(p[1], 1), lattice.cell(p[2], 2), 0}};
        return certified[lattice.offset(c)] != 0;
    }
};

struct WindingBody {
    const Tiles& tiles;
    const Boundary& boundary;
    const float* positions; // packed
    std::uint32_t vertex_count;
    Box box;
    double cell_size;                   // of the lattice
    const Box* super_boxes;             // boxes that hold the super-tiles
    const float* super_change;          // see track_orientation()
    const std::uint8_t* super_positive; // whether all tets of a super-tile are known to be positive
    Box* tile_boxes;                    // boxes that are needed are made
    std::uint8_t* tile_known;
    OrientationCache& orientation; // renewed where that pays
    Workers* workers;              // not null: share the pass over the tiles, as one task
    // Whether the packed positions are those in `exact` less `origin`, rounded to floats; else they are
    // exact.
    bool rounded = false;
    Vec3d origin{};
    Positions exact{};
};

// Fills `out` so that no vertex in a certified cell is in a tet that does not own it. This does not cover
// vertices of no tet (Boundary::loose). Returns false when it would not pay or cannot be decided: then all
// vertices have to be used. `exact_tests` as in predicates.hpp.
bool certify(const WindingBody& body, Certificate& out, std::uint64_t& exact_tests);

} // namespace vox::fast
