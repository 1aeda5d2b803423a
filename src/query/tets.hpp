// The tetrahedra of one mesh, for queries: the part that does not change while the mesh only moves.
#pragma once

#include "base/array.hpp"
#include "mesh/tiles.hpp"
#include "mesh/topology.hpp"

#include <cstdint>
#include <memory>
#include <memory_resource>

namespace vox {

// Never changed, so that all locators of the same tetrahedra share it.
struct QueryTets {
    explicit QueryTets(std::pmr::memory_resource* memory) noexcept : tiles(memory), facets(memory) {}

    Tiles tiles;                // those that hold tetrahedra: tiles, corners, tets and vertices
    Array<std::uint8_t> facets; // for each of tiles.tets, a bit for each facet (facet_corners) on the surface
};

// Throws what the memory throws.
std::shared_ptr<const QueryTets> make_query_tets(const Tiles& tiles, const Topology& topology,
                                                 std::pmr::memory_resource* memory);

} // namespace vox
