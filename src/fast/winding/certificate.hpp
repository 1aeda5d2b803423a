// Which vertices of a body may be in its own tetrahedra, by winding numbers. In a compact body that does not
// touch itself there are none, and to find that out little more than its boundary is read.
#pragma once

#include "base/array.hpp"
#include "fast/winding/orientation.hpp"
#include "fast/window.hpp"
#include "mesh/boundary.hpp"

#include <cstdint>
#include <cstring>
#include <memory_resource>
#include <span>
#include <tuple>

namespace vox {
class Workers;
}

namespace vox::fast {

// Cells of a lattice around a body. In a certified cell, a point is covered by at most one tet.
struct CertifiedCells {
    explicit CertifiedCells(std::pmr::memory_resource* memory) noexcept : certified(memory) {}

    WindowLattice lattice;
    static constexpr std::uint32_t run = 8;
    Array<std::uint8_t> certified; // of each cell, 1 or 0; and `run` more, to read so many at once
    bool complete = false;         // whether all cells are certified

    // True if all cells that meet `box` are certified; false as well where they are too many to look at.
    bool holds(const Box& box) const noexcept {
        static constexpr std::uint8_t ones[2 * run] = {1, 1, 1, 1, 1, 1, 1, 1};
        constexpr std::uint32_t few = 16; // vertices of such a block are looked up one by one
        const WindowCell lo = lattice.cell(box.lo), hi = lattice.cell(box.hi);
        std::uint32_t more[3];
        for (int a = 0; a < 3; ++a) more[a] = hi.index[a] - lo.index[a];
        if (more[0] >= run || (std::size_t{more[1]} + 1) * (more[2] + 1) > few) return false;
        std::uint64_t wanted, found, missing = 0;
        std::memcpy(&wanted, ones + (run - 1 - more[0]), run);
        const std::uint8_t* plane = certified.data() + lattice.offset(lo);
        for (std::uint32_t z = 0; z <= more[2];
             ++z, plane += std::size_t{lattice.cells[0]} * lattice.cells[1])
            for (std::uint32_t y = 0; y <= more[1]; ++y) {
                std::memcpy(&found, plane + std::size_t{y} * lattice.cells[0], run);
                missing |= wanted & ~found;
            }
        return missing == 0;
    }
    bool holds(const float* p) const noexcept {
        const WindowCell c{{lattice.cell(p[0], 0), lattice.cell(p[1], 1), lattice.cell(p[2], 2), 0}};
        return certified[lattice.offset(c)] != 0;
    }
};

// The connected components of some cells of a lattice, where cells are connected through facets.
//
// Runs are maximal rows of such cells along x; there are two to three orders of magnitude fewer of them than
// of cells. Each run is joined with those next to it in the row before and in the layer before (A. Rosenfeld,
// J. L. Pfaltz, Sequential operations in digital picture processing, J. ACM 13, 1966; joined as in R. E.
// Tarjan, Efficiency of a good but not linear set union algorithm, J. ACM 22, 1975).
struct Components {
    explicit Components(std::pmr::memory_resource* memory) noexcept : runs(memory), rows(memory) {}

    struct Run {
        std::uint32_t first, end; // cells, x fastest
        std::uint32_t component;  // numbered in the order of their first cells
    };
    Array<Run> runs;           // in the order of their cells
    Array<std::uint32_t> rows; // of each row its first run, and the end
    std::uint32_t count = 0;

    // Finds the components of the cells with values[cell] == wanted.
    void find(const std::uint32_t* values, std::uint32_t wanted, const std::uint32_t (&cells)[3]);

private:
    std::uint32_t root(std::uint32_t run) noexcept;
    void join(std::uint32_t row, std::uint32_t other, std::uint32_t cells_between) noexcept;
};

// The cells, and what it takes to certify them.
struct Certificate : CertifiedCells {
    explicit Certificate(std::pmr::memory_resource* memory)
        : CertifiedCells(memory), directions(memory), touched(memory), bad(memory), components(memory) {}

    Array<std::uint32_t> directions, touched;
    Array<std::uint64_t> bad;
    Components components;

    auto buffers() { return std::tie(directions, touched, bad, components.runs, components.rows, certified); }
};

struct WindingBody : OrientedBody { // rounded: its positions are those in `exact` less `origin`
    Box box;
    double cell_size;              // of the lattice
    const Box* super_boxes;        // boxes that hold the super-tiles
    OrientationCache& orientation; // renewed where that pays
    Workers* workers;              // not null: share the pass over the tiles, as one task
    Vec3d origin{};
    Positions exact{};
};

// Fills `out` so that no vertex in a certified cell is in a tet that does not own it, and that no edge of the
// boundary meets a facet of it there with which it has no vertex in common. This does not cover
// vertices of no tet (Boundary::loose). Returns false when it would not pay or cannot be decided: then all
// vertices have to be used. `exact_tests` as in predicates.hpp.
bool certify(const WindingBody& body, Certificate& out, std::uint64_t& exact_tests);

} // namespace vox::fast
