// The tetrahedra of one mesh as queries need them: the part that does not change while the mesh only moves.
#pragma once

#include "mesh/tiles.hpp"
#include "mesh/topology.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <memory_resource>
#include <vector>

namespace vox {

// Never changed once it is made, so that all that is prepared of the same tetrahedra shares it.
struct QueryTets {
    explicit QueryTets(std::pmr::memory_resource* memory) noexcept
        : tiles(memory), tets(memory), corners(memory), facets(memory), vertices(memory) {}

    std::pmr::vector<Tile> tiles;         // those that hold tetrahedra
    std::pmr::vector<std::uint32_t> tets; // the caller's tet index, tile after tile
    // Of each of `tets`: its corners, in the vertices of its tile, and a bit for each facet (facet_corners)
    // on the surface.
    std::pmr::vector<std::array<std::uint8_t, 4>> corners;
    std::pmr::vector<std::uint8_t> facets;
    std::pmr::vector<std::uint32_t> vertices; // the caller's vertex index, tile after tile
};

// Throws what the memory throws.
std::shared_ptr<const QueryTets> make_query_tets(const Tiles& tiles, const Topology& topology,
                                                 std::pmr::memory_resource* memory);

} // namespace vox
