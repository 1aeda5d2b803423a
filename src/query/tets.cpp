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
    constexpr std::uint32_t no_link = QueryTets::no_link;
    const Tiles& tiles = made.tiles;
    if (tiles.tiles.size() >= no_link / tile_size) return;
    Array<std::uint32_t> place_of(topology.across.size(), no_link, made.links.memory());
    for (std::uint32_t t = 0; t < tiles.tiles.size(); ++t)
        for (std::uint32_t i = 0; i < tiles.tiles[t].tet_count; ++i)
            place_of[tiles.tets[tiles.tiles[t].first_tet + i]] = tile_size * t + i;
    made.links.reserve(tiles.tets.size());
    for (const std::uint32_t tet : tiles.tets) {
        std::array<std::uint32_t, 4> links = topology.across[tet];
        for (std::uint32_t& link : links) {
            const std::uint32_t other = link;
            link = other & Topology::surface_bit ? no_link : place_of[other];
            const auto back = link == no_link ? std::array<std::uint32_t, 4>{} : topology.across[other];
            if (other == Topology::nothing || (link != no_link && std::ranges::find(back, tet) == back.end()))
                return made.links.clear();
        }
        made.links.push_back(links);
    }
    const auto odd_facet = [&](std::uint32_t place, std::size_t facet) {
        const Tile& tile = tiles.tiles[place / tile_size];
        const auto vertex = [&](std::size_t c) {
            const std::size_t corner = facet_corners[facet][c];
            return tiles
                .vertices[tile.first_vertex +
                          tiles.corners_of(place / tile_size)[corner * tile_size + place % tile_size]];
        };
        return is_odd(vertex(0), vertex(1), vertex(2));
    };
    for (std::size_t t = 0; t < tiles.tets.size(); ++t)
        for (std::size_t f = 0; f < 4; ++f) {
            const std::uint32_t here = place_of[tiles.tets[t]], there = made.links[t][f];
            if (there == no_link) continue;
            const auto& back = made.links[made.place(there)];
            const auto facet = static_cast<std::size_t>(std::ranges::find(back, here) - back.begin());
            made.facets[t] |=
                static_cast<std::uint8_t>((odd_facet(here, f) == odd_facet(there, facet)) << (4 + f));
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
