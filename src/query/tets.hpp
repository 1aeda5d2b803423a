// The tetrahedra of one mesh as queries need them: the part that does not change while the mesh only moves.
#pragma once

#include "base/array.hpp"
#include "mesh/tiles.hpp"
#include "mesh/topology.hpp"

#include <cstdint>
#include <memory>
#include <memory_resource>

namespace vox {

// Never changed once it is made, so that all that is prepared of the same tetrahedra shares it.
struct QueryTets {
    explicit QueryTets(std::pmr::memory_resource* memory) noexcept : tiles(memory), facets(memory) {}

    Tiles tiles; // those that hold tetrahedra: tiles, corners, tets and vertices
    // Of each of tiles.tets: a bit for each facet (facet_corners) on the surface.
    Array<std::uint8_t> facets;
};

// Throws what the memory throws.
std::shared_ptr<const QueryTets> make_query_tets(const Tiles& tiles, const Topology& topology,
                                                 std::pmr::memory_resource* memory);

} // namespace vox
