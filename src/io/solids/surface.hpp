// Inside and outside of a triangle surface, for the nodes and edges of a lattice.
#pragma once

#include "io/solids/lattice.hpp"
#include "io/solids/progress.hpp"

#include <vox/vox_io.h>

#include <cstdint>
#include <string>
#include <vector>

namespace vox::io {

// What is known of a surface before any lattice is laid through it.
struct SurfaceCheck {
    std::uint64_t triangles = 0;  // of three different vertices
    std::uint64_t edges = 0;      // unique
    std::uint64_t open_edges = 0; // of an odd number of triangles
    bool oriented = false;        // every edge is used as often in one direction as in the other
};

// All lines of one direction. A line is named by two coordinates (u, v) that are the same for all its points;
// its toggles are the places, ascending, where it enters or leaves the body.
struct LatticeLines {
    std::int32_t first_v = 0;
    std::vector<std::uint32_t> row_start; // of each v, in line_u
    std::vector<std::int32_t> line_u;
    std::vector<std::uint32_t> start; // of each line, in toggles
    std::vector<double> toggles;
};

// Corners in ascending order, so that no figure depends on the order they are given in.
struct OrderedTriangle {
    std::array<std::uint32_t, 3> corners;
    int turn; // -1 when the order is not the given one (nor a rotation of it)
};

// The lines along the lattice's seven edge directions and where they enter and leave the body.
//
// The surface is moved to a fine integer grid first, so that "does this line meet this triangle" is decided
// exactly, and lines are shifted by an infinitesimal amount, so that none meets an edge or a vertex
// (simulation of simplicity). Every line therefore meets a closed surface an even number of times, whatever
// its shape.
//
// Inside is where the winding number is not zero when the surface is oriented (overlapping parts join), and
// where it is odd when it is not.
class SurfaceLines {
public:
    // Welds vertices of equal position (on the integer grid), drops triangles that have collapsed, and casts
    // the lines that `inside` asks.
    SurfaceLines(const vox_io_mesh_view& surface, const Frame& frame);

    const SurfaceCheck& check() const { return check_; }

    // The nodes inside. For a closed surface all directions agree and one is asked; otherwise the three axes
    // vote, lines that end inside do not count, and `doubtful` is the share of the nodes (or lines) without
    // agreement.
    NodeSet inside(const Frame& frame, double& doubtful) const;

    // Casts the lines along the other directions, for `leaves`.
    void cast_rest(const Progress& progress);

    // Where the edge from `node`, inside, to its neighbour, outside, leaves the body: a fraction of the edge.
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
