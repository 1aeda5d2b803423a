#include "query/tets.hpp"

#include "mesh/facets.hpp"

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

// Links the tetrahedra across facets, and compares their orders.
void link(const Tiles& tiles, QueryTets::Links& links) {
    if (tiles.tiles.size() >= TetLink::no_tile) return;
    std::pmr::memory_resource* const memory = links.memory();
    Array<Tet> tets(memory);
    Array<TetLink> places(memory);
    tets.reserve(tiles.tets.size());
    places.reserve(tiles.tets.size());
    std::uint32_t vertices = 0;
    for (std::uint32_t t = 0; t < tiles.tiles.size(); ++t)
        for (std::uint32_t i = 0; i < tiles.tiles[t].tet_count; ++i) {
            Tet tet{};
            for (std::size_t c = 0; c < 4; ++c) {
                tet.v[c] =
                    tiles.vertices[tiles.tiles[t].first_vertex + tiles.corners_of(t)[c * tile_size + i]];
                vertices = std::max(vertices, tet.v[c] + 1);
            }
            tets.push_back(tet);
            places.push_back({t & TetLink::no_tile, i & 63u, 0, 0});
        }
    MatchedFacets matched(memory);
    match_facets(tets, vertices, matched);
    links.reserve(tets.size());
    for (std::uint32_t tet = 0; tet < tets.size(); ++tet) {
        std::array<TetLink, 4> of;
        for (std::uint32_t f = 0; f < 4; ++f) {
            const std::uint32_t other = matched.across(tet, f);
            if (other == MatchedFacets::nothing) return links.clear();
            of[f] = {TetLink::no_tile, 0, 0, 0};
            if (other & MatchedFacets::surface_bit) continue;
            const auto back = matched.across[other];
            const auto facet =
                static_cast<std::uint32_t>(std::find(back.begin(), back.end(), tet) - back.begin());
            if (facet == 4) return links.clear();
            of[f] = places[other];
            of[f].facet = facet & 3u;
            of[f].turned = sorted_facet(tets[tet], f).even == sorted_facet(tets[other], facet).even;
        }
        links.push_back(of);
    }
}

} // namespace

const QueryTets::Links& QueryTets::links() const {
    const std::scoped_lock lock(making_);
    if (!made_) link(tiles, links_);
    made_ = true;
    return links_;
}

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
