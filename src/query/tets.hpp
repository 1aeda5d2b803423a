// The tetrahedra of one mesh, for queries: the part that does not change while the mesh only moves.
#pragma once

#include "base/array.hpp"
#include "mesh/tiles.hpp"
#include "mesh/topology.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <memory_resource>

namespace vox {

// Never changed, so that all locators of the same tetrahedra share it.
struct QueryTets {
    explicit QueryTets(std::pmr::memory_resource* memory) noexcept
        : tiles(memory), facets(memory), links(memory) {}

    Tiles tiles; // those that hold tetrahedra: tiles, corners, tets and vertices
    // For each of tiles.tets: bit f if facet f (facet_corners) is on the surface; bit 4 + f if the
    // tetrahedron across it has its corners in the other order, so that volumes of one sign overlap.
    Array<std::uint8_t> facets;
    // For each facet of each of tiles.tets the tetrahedron across it, as 64 * tile + place in the tile; or
    // no_link. Empty if some facets have more than two tetrahedra, or a tetrahedron is there twice.
    Array<std::array<std::uint32_t, 4>> links;
    static constexpr std::uint32_t no_link = ~0u;
    // The place of what is linked in tiles.tets, in `facets` and in `links`.
    std::size_t place(std::uint32_t link) const noexcept {
        return std::size_t{tiles.tiles[link / tile_size].first_tet} + link % tile_size;
    }
};

// Throws what the memory throws.
std::shared_ptr<const QueryTets> make_query_tets(const Tiles& tiles, const Topology& topology,
                                                 std::pmr::memory_resource* memory);

} // namespace vox
