// Walks along segments that begin inside a mesh, to where they leave the mesh.
#pragma once

#include "base/scene.hpp"
#include "mesh/topology.hpp"

#include <cstdint>
#include <span>

namespace vox::depth {

// A mesh that others penetrate.
struct Solid {
    const Topology* topology;
    std::span<const Tet> tets;
    Positions positions;

    Vec3d at(std::uint32_t vertex) const noexcept { return positions.exact(vertex); }
};

inline bool has_corner(const Triangle& triangle, std::uint32_t vertex) noexcept {
    return triangle.v[0] == vertex || triangle.v[1] == vertex || triangle.v[2] == vertex;
}

// A point of a triangle of a surface.
struct SurfacePoint {
    std::uint32_t triangle;
    double weight[3]; // of the corners; their sum is 1 to rounding
    Vec3d point;
};

struct Walk {
    // The segment, and the closed tetrahedron in which it begins.
    Vec3d p, q;
    std::uint32_t tet;
    // True if the segment leaves the mesh between p and q, and not by a facet where three or more tetrahedra
    // meet; how many tetrahedra are on its way; and where it leaves, if it does.
    bool leaves;
    std::uint64_t visited;
    SurfacePoint exit;
};

// Walks from tetrahedron to tetrahedron. Sets `leaves`, `visited` and `exit` of all walks.
void walk_out(const Solid& solid, std::span<Walk> walks);

// One such walk. Returns whether the segment leaves the mesh, and adds to `visited`.
bool walk_out(const Solid& solid, std::uint32_t tet, const Vec3d& p, const Vec3d& q, SurfacePoint& out,
              std::uint64_t& visited);

} // namespace vox::depth
