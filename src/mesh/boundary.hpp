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

    // Whether the triangles are the boundary of all tets: their facets, where those on different sides
    // cancel, with each tet as it is meant to be. This holds when every facet belongs to one tet, or to two
    // on different sides of it, and in some other cases. Else all that follows is empty.
    bool is_closed = false;
    // Facets whose tet is not cancelled by another one; counter-clockwise from outside when that tet is
    // positive.
    Array<std::array<std::uint32_t, 3>> triangles;
    // For each tile a bit for each tet: those that are meant to be negative, whose last two corners are to be
    // swapped, and those that name a corner twice and never hold a vertex. The former are those that were
    // negative when they were prepared, if so neighbours were on different sides of their facets; else some
    // tets had turned over, and their neighbours say what was meant.
    Array<std::uint64_t> mirrored, ignored;
    Array<std::uint32_t> loose; // vertices that are in no tet, ignored ones aside; ascending
};

// Whether culling self-collision by winding numbers pays: not for small bodies, nor where most of the body is
// boundary.
constexpr bool boundary_pays(std::size_t triangles, std::size_t tets) noexcept {
    return tets >= 2000 && triangles * 8 <= tets;
}

// Whether a tet is negative, and so is prepared as mirrored.
bool is_negative(const Tet& tet, const Positions& positions) noexcept;

// Counter-clockwise from outside, when `even` means that low, middle, high are.
std::array<std::uint32_t, 3> triangle_of(const SortedFacet& facet) noexcept;

// `facets` are those of the mesh; null: they are matched here. Throws what the memory throws and leaves `out`
// unchanged then.
void make_boundary(std::span<const Tet> tets, std::uint32_t vertex_count, Positions positions,
                   const Tiles& tiles, Boundary& out, const MatchedFacets* facets = nullptr);

} // namespace vox
