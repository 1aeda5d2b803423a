// The stencils of isosurface stuffing: the part of a lattice tetrahedron that remains when the boundary cuts
// it.
#pragma once

#include <array>
#include <cstdint>

namespace vox::io {

// Where a corner is. `on` means that it was moved onto the boundary.
enum class Side : std::uint8_t { outside = 0, inside = 1, on = 2 };

// Corners 0 and 1 are the ends of one long edge, 2 and 3 those of the other, the lower end of each first.
// A vertex of a piece is a corner (0 to 3) or the cut point of an edge (4 to 9, edge tet_edges[v - 4]).
struct Stencil {
    std::uint8_t count = 0;
    std::array<std::array<std::uint8_t, 4>, 3> tets{}; // with the orientation of tetrahedron (0, 1, 2, 3)

    void add(const std::array<std::uint8_t, 4>& tet) { tets[count++] = tet; }
};

inline constexpr std::array<std::array<std::uint8_t, 2>, 6> tet_edges = {
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

// The pieces inside. `first_above` says that the long edge 0-1 is above 2-3 on the axis that neither is
// parallel to. For p inside and m outside, `stumps[p][m]` is the fraction of edge p-m from p to its cut
// point.
Stencil make_stencil(const std::array<Side, 4>& sides, bool first_above,
                     const std::array<std::array<double, 4>, 4>& stumps);

} // namespace vox::io
