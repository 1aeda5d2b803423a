// The walk along a segment that begins inside a mesh, to where it leaves the mesh.
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

// A point of a triangle of a surface.
struct SurfacePoint {
    std::uint32_t triangle;
    double weight[3]; // of the corners; their sum is 1 to rounding
    Vec3d point;
};

// Walks along the segment from p, in the closed tetrahedron `tet`, to q, from tetrahedron to tetrahedron.
// Returns true and sets `out` when the segment leaves the mesh between the two. Returns false when it does
// not, or meets a facet where three or more tetrahedra meet. Adds the number of tetrahedra on its way to
// `visited`.
bool walk_out(const Solid& solid, std::uint32_t tet, const Vec3d& p, const Vec3d& q, SurfacePoint& out,
              std::uint64_t& visited);

} // namespace vox::depth
