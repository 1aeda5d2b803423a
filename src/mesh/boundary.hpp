// The boundary of a mesh, for winding numbers: the facets that no two tetrahedra share.
#pragma once

#include "base/array.hpp"
#include "mesh/facets.hpp"
#include "mesh/tiles.hpp"

#include <array>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

struct Boundary {
    explicit Boundary(std::pmr::memory_resource* memory) noexcept
        : triangles(memory), mirrored(memory), ignored(memory), loose(memory) {}

    // True if the triangles are the boundary of all tets: the facets left after opposite ones cancel, using
    // each tet's intended orientation. This holds if every facet belongs to one tet, or to two on different
    // sides of it, and in some other cases. Otherwise the members below are empty.
    bool is_closed = false;
    // Facets of a tet that no opposite facet cancels; counter-clockwise from outside if that tet is positive.
    Array<std::array<std::uint32_t, 3>> triangles;
    // For each tile a bit for each tet. `mirrored` tets are meant to be negative: their last two corners are
    // to be swapped. They were negative when they were prepared, if neighbours then were on different sides
    // of their facets; otherwise some tets had turned over, and their neighbours decide. `ignored` tets name
    // a corner twice and contain nothing.
    Array<std::uint64_t> mirrored, ignored;
    Array<std::uint32_t> loose; // vertices that are in no tet, ignored ones aside; ascending
};

// True if culling self-collision by winding numbers pays: not for small bodies, nor for bodies that are
// mostly boundary.
constexpr bool boundary_pays(std::size_t triangles, std::size_t tets) noexcept {
    return tets >= 2000 && triangles * 8 <= tets;
}

// True if a tet is negative.
bool is_negative(const Tet& tet, const Positions& positions) noexcept;

// The facet's vertices: low, middle, high if it is even, else in the opposite order.
std::array<std::uint32_t, 3> triangle_of(const SortedFacet& facet) noexcept;

// `facets` are those of the mesh; if null, they are matched here. If it throws what the memory throws, `out`
// is unchanged.
void make_boundary(std::span<const Tet> tets, std::uint32_t vertex_count, Positions positions,
                   const Tiles& tiles, Boundary& out, const MatchedFacets* facets = nullptr);

} // namespace vox
