// Finds which nodes of a lattice are inside a triangle surface, and where lattice edges leave it.
#pragma once

#include "io/progress.hpp"
#include "io/solids/lattice.hpp"

#include <vox/vox_io.h>

#include <cstdint>
#include <string>
#include <vector>

namespace vox::io {

// The result of checking a surface before it is intersected with lattice lines.
struct SurfaceCheck {
    std::uint64_t edges = 0;      // unique edges
    std::uint64_t open_edges = 0; // edges of an odd number of triangles
    bool oriented = false;        // whether every edge is used equally often in both directions
};

// All lines of one direction. A line is identified by two coordinates (u, v) that are the same for all its
// points. Its toggles are the positions, ascending, where it enters or leaves the body.
struct LatticeLines {
    std::int32_t first_v = 0;
    std::vector<std::uint32_t> row_start; // where the lines of each v start in line_u
    std::vector<std::int32_t> line_u;
    std::vector<std::uint32_t> start; // where those of each line start in toggles
    std::vector<double> toggles;
};

// Corners in ascending order, so that no rounding depends on the order they are given in.
struct OrderedTriangle {
    std::array<std::uint32_t, 3> corners;
    int turn; // -1 if sorting reversed the orientation, else 1
};

// The lines along the lattice's seven edge directions and where they enter and leave the body.
//
// First the vertices are rounded to a fine integer grid, so that it is decided exactly whether a line crosses
// a triangle. Lines are shifted by an infinitesimal amount, so that none meets an edge or a vertex
// (simulation of simplicity). Therefore every line crosses a closed surface an even number of times, whatever
// its shape.
//
// For an oriented surface, inside is where the winding number is not zero, so that overlapping parts are
// joined. Otherwise it is where the number of crossings is odd.
class SurfaceLines {
public:
    // Merges vertices of equal position on the integer grid, removes triangles that have collapsed, and casts
    // the lines that `inside` needs.
    SurfaceLines(const vox_io_mesh_view& surface, const Frame& frame);

    const SurfaceCheck& check() const { return check_; }

    // The nodes inside. For a closed surface all directions agree, and one is used. Otherwise the three axes
    // vote (lines that end inside are ignored), and `doubtful` is the share of nodes without agreement or of
    // lines that end inside, whichever is greater.
    NodeSet inside(const Frame& frame, double& doubtful) const;

    // Casts the lines along the other directions, for `leaves`.
    void cast_rest(const Progress& progress);

    // Where the edge from `node`, which is inside, to its neighbour, which is outside, leaves the body, as a
    // fraction of the edge.
    double leaves(const Node& node, unsigned neighbour) const;

private:
    struct Line {
        const double* begin;
        const double* end;
    };

    Line find(unsigned direction, const Node& node) const;
    std::vector<Run> runs_along(unsigned axis) const;

    void cast_up_to(unsigned directions);

    std::vector<std::array<std::int32_t, 3>> points_;
    std::vector<OrderedTriangle> triangles_;
    int shift_ = 0; // a lattice unit, half a cell, is 2^shift_
    unsigned cast_ = 0;
    SurfaceCheck check_;
    std::array<LatticeLines, 7> lines_;
};

} // namespace vox::io
