#include "query/tets.hpp"

#include <algorithm>
#include <cstddef>

namespace vox {

namespace {

std::uint8_t surface_facets(const std::array<std::uint32_t, 4>& across) noexcept {
    unsigned facets = 0;
    for (unsigned i = 0; i < 4; ++i)
        facets |= unsigned{across[i] != Topology::nothing && (across[i] & Topology::surface_bit) != 0} << i;
    return static_cast<std::uint8_t>(facets);
}

// Is the triangle in an odd order?
bool is_odd(std::uint32_t a, std::uint32_t b, std::uint32_t c) noexcept {
    return (a > b) ^ (b > c) ^ (a > c);
}

// Links the tetrahedra across facets, and compares their orders.
void link(const Topology& topology, QueryTets& made) {
    const Tiles& tiles = made.tiles;
    if (tiles.tiles.size() >= TetLink::no_tile) return;
    Array<TetLink> places(topology.across.size(), TetLink{TetLink::no_tile, 0, 0, 0}, made.links.memory());
    for (std::uint32_t t = 0; t < tiles.tiles.size(); ++t)
        for (std::uint32_t i = 0; i < tiles.tiles[t].tet_count; ++i)
            places[tiles.tets[tiles.tiles[t].first_tet + i]] = {t & TetLink::no_tile, i & 63u, 0, 0};
    const auto is_odd_facet = [&](const TetLink& tet, std::size_t facet) {
        const auto vertex = [&](std::size_t c) {
            return tiles
                .vertices[tiles.tiles[tet.tile].first_vertex +
                          tiles.corners_of(tet.tile)[facet_corners[facet][c] * tile_size + tet.place]];
        };
        return is_odd(vertex(0), vertex(1), vertex(2));
    };
    made.links.reserve(tiles.tets.size());
    for (const std::uint32_t tet : tiles.tets) {
        std::array<TetLink, 4> links;
        for (std::size_t f = 0; f < 4; ++f) {
            const std::uint32_t other = topology.across(tet, static_cast<std::uint32_t>(f));
            if (other == Topology::nothing) return made.links.clear();
            links[f] = {TetLink::no_tile, 0, 0, 0};
            if (other & Topology::surface_bit) continue;
            const auto back = topology.across[other];
            const std::size_t facet = std::size_t(std::ranges::find(back, tet) - back.begin());
            if (facet == 4 || places[other].tile == TetLink::no_tile) return made.links.clear();
            links[f] = places[other];
            links[f].facet = static_cast<std::uint32_t>(facet) & 3u;
            links[f].turned = is_odd_facet(places[tet], f) == is_odd_facet(places[other], facet);
        }
        made.links.push_back(links);
    }
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
    link(topology, *made);
    return made;
}

} // namespace vox
