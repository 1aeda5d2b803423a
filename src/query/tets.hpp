// The tetrahedra of one mesh, for queries: the part that does not change while the mesh only moves.
#pragma once

#include "base/array.hpp"
#include "mesh/tiles.hpp"
#include "mesh/topology.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <memory_resource>
#include <mutex>

namespace vox {

// The tetrahedron across a facet.
struct TetLink {
    std::uint32_t tile : 23, place : 6; // in the tile
    std::uint32_t facet : 2;            // the same facet, as that tetrahedron's
    std::uint32_t turned : 1;           // its corners are in the other order: volumes of one sign overlap
    static constexpr std::uint32_t no_tile = 0x7fffff;
};

// Never changed but for what is made late, so that all locators of the same tetrahedra share it.
struct QueryTets {
    explicit QueryTets(std::pmr::memory_resource* memory) noexcept : tiles(memory), facets(memory) {}

    Tiles tiles;                // those that hold tetrahedra: tiles, corners, tets and vertices
    Array<std::uint8_t> facets; // for each of tiles.tets, a bit for each facet (facet_corners) on the surface

    using Links = Array<std::array<TetLink, 4>>;
    // For each facet of each of tiles.tets what is across it; made by the first call, in memory of the heap.
    // Empty if some facets have more than two tetrahedra, a tetrahedron is there twice, or there are too
    // many. Throws what the heap throws.
    const Links& links() const;

private:
    mutable std::mutex making_;
    mutable bool made_ = false; // set with making_ locked
    mutable Links links_{std::pmr::new_delete_resource()};
};

// Throws what the memory throws.
std::shared_ptr<const QueryTets> make_query_tets(const Tiles& tiles, const Topology& topology,
                                                 std::pmr::memory_resource* memory);

} // namespace vox
