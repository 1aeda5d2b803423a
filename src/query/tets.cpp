#include "query/tets.hpp"

#include <cstddef>

namespace vox {

namespace {

std::uint8_t surface_facets(const std::array<std::uint32_t, 4>& across) noexcept {
    unsigned facets = 0;
    for (unsigned i = 0; i < 4; ++i)
        facets |= unsigned{across[i] != Topology::nothing && (across[i] & Topology::surface_bit) != 0} << i;
    return static_cast<std::uint8_t>(facets);
}

} // namespace

std::shared_ptr<const QueryTets> make_query_tets(const Tiles& tiles, const Topology& topology,
                                                 std::pmr::memory_resource* memory) {
    auto made = std::allocate_shared<QueryTets>(std::pmr::polymorphic_allocator<QueryTets>(memory), memory);
    const auto padded = [](const Tile& tile) { return (tile.vertex_count + 3u) & ~3u; };
    std::size_t count = 0, vertices = 0, used = 0;
    for (const Tile& tile : tiles.tiles) {
        if (tile.tet_count == 0) continue; // all its tetrahedra are off
        count += tile.tet_count;
        vertices += padded(tile);
        ++used;
    }
    Tiles& to = made->tiles;
    to.tiles.reserve(used);
    to.tets.reserve(count);
    to.corners.reserve(used * 4 * tile_size);
    to.vertices.reserve(vertices);
    made->facets.reserve(count);
    for (std::size_t t = 0; t < tiles.tiles.size(); ++t) {
        Tile tile = tiles.tiles[t];
        if (tile.tet_count == 0) continue;
        const std::uint32_t* const tets = tiles.tets.data() + tile.first_tet;
        const std::uint32_t* const vertices_of_tile = tiles.vertices.data() + tile.first_vertex;
        const std::uint8_t* const corners = tiles.corners_of(t);
        tile.first_tet = static_cast<std::uint32_t>(to.tets.size());
        tile.first_vertex = static_cast<std::uint32_t>(to.vertices.size());
        to.tiles.push_back(tile);
        to.tets.insert(to.tets.end(), tets, tets + tile.tet_count);
        to.corners.insert(to.corners.end(), corners, corners + 4 * tile_size);
        to.vertices.insert(to.vertices.end(), vertices_of_tile, vertices_of_tile + padded(tile));
        for (std::size_t i = 0; i < tile.tet_count; ++i)
            made->facets.push_back(surface_facets(topology.across[tets[i]]));
    }
    return made;
}

} // namespace vox
