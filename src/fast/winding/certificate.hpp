// Stage 6: which vertices of a body can lie in its own tetrahedra at all, by winding numbers. In a compact
// body that does not touch itself: none, and next to nothing but its surface was looked at to know.
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

// Cells of a lattice around a body, and in which of them a point is covered by at most one tet.
struct Certificate {
    explicit Certificate(std::pmr::memory_resource* memory)
        : directions(memory), touched(memory), bad(memory), components(memory), certified(memory),
          with_next(memory) {}

    // Buffers.
    std::pmr::vector<std::uint32_t> directions, touched;
    std::pmr::vector<std::uint64_t> bad;
    Components components;

    WindowLattice lattice;
    std::pmr::vector<std::uint8_t> certified; // per cell
    std::pmr::vector<std::uint8_t> with_next; // it and those that are next to it, up along any axes
    bool complete = false;                    // all are

    auto buffers() {
        return std::tie(directions, touched, bad, components.runs, components.rows, certified, with_next);
    }

    // All cells that meet `box`, as far as a look at them is cheap, are certified.
    bool holds(const Box& box) const noexcept {
        const WindowCell lo = lattice.cell(box.lo), hi = lattice.cell(box.hi);
        std::uint64_t cells = 1;
        bool is_small = true;
        for (int a = 0; a < 3; ++a) {
            cells *= hi.index[a] - lo.index[a] + 1;
            is_small &= hi.index[a] - lo.index[a] <= 1;
        }
        if (is_small && with_next[lattice.offset(lo)]) return true;
        constexpr std::uint32_t few = 16;
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
    const Boundary& surface;
    const float* positions; // packed
    std::uint32_t vertex_count;
    Box box;
    double cell_size;                  // of the lattice
    const Box* super_boxes;            // boxes that hold the super-tiles
    const std::uint8_t* super_upright; // super-tiles whose tets are known to be positive
    Box* tile_boxes;                   // those that were looked at are known afterwards
    std::uint8_t* tile_known;
    OrientationCache& turning; // renewed where that pays
    Workers* workers; // not null: share the pass over the tiles, as one task
    // The packed positions are those in `exact` less `origin`, rounded to floats.
    bool rounded = false;
    Vec3d origin{};
    Positions exact{};
};

// Fills `out` so that no vertex in a certified cell lies in a tet that does not own it, vertices of no tet
// (see Boundary::loose) excepted. False: it would not pay, or cannot be told; use all vertices. `exact_tests`
// as in predicates.hpp.
bool certify(const WindingBody& body, Certificate& out, std::uint64_t& exact_tests);

} // namespace vox::fast
