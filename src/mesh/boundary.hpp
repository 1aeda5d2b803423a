// The boundary of a mesh, prepared for winding.hpp: the facets that no two tetrahedra share.
#pragma once

#include "mesh/facets.hpp"
#include "mesh/tiles.hpp"

#include <array>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

struct Boundary {
    explicit Boundary(std::pmr::memory_resource* memory) noexcept
        : triangles(memory), mirrored(memory), ignored(memory), loose(memory) {}

    // The triangles are the boundary of all tets: their facets, where those on different sides cancel. So
    // they are when every facet belongs to one tet, or to two that lie on different sides of it, and in some
    // other cases. False: there is no use for the rest, which is empty then.
    bool is_closed = false;
    // Facets with a tet on one side that is not cancelled, counter-clockwise from outside when it is
    // positive.
    std::pmr::vector<std::array<std::uint32_t, 3>> triangles;
    // For each tile, tets to be taken with the last two corners swapped (negative when they were prepared),
    // and tets that name a corner twice and never hold anything.
    std::pmr::vector<std::uint64_t> mirrored, ignored;
    std::pmr::vector<std::uint32_t> loose; // vertices of no tet but ignored ones, ascending
};

// Self-collision is culled by winding numbers from this many tets, and this many tets a boundary triangle,
// on: a surface that is most of the body never pays.
constexpr bool boundary_pays(std::size_t triangles, std::size_t tets) noexcept {
    return tets >= 2000 && triangles * 8 <= tets;
}

// Whether a tet is prepared as mirrored.
bool is_negative(const Tet& tet, const Positions& positions) noexcept;

// Counter-clockwise from outside, when `even` means that low, middle, high are.
std::array<std::uint32_t, 3> triangle_of(const SortedFacet& facet) noexcept;

// `facets` are those of the mesh; null: they are matched here. Throws what the memory throws and leaves `out`
// unchanged then.
void make_boundary(std::span<const Tet> tets, std::uint32_t vertex_count, Positions positions,
                   const Tiles& tiles, Boundary& out, const MatchedFacets* facets = nullptr);

} // namespace vox
