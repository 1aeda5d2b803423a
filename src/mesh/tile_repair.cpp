// The boundary is that of the chain of all tets: a facet is in it when the tets on one side outnumber those
// on the other, and faces away from them. It is there once, however many more they are: the winding number
// falls across it, and by how much does not matter to the certificate. So where a tet changes, the tets
// around each of its facets are counted again.
#include "mesh/tet_changes.hpp"
#include "mesh/tiled_mesh.hpp"

#include <algorithm>

namespace vox {

namespace {

constexpr std::uint64_t bit(std::uint32_t i) { return std::uint64_t{1} << i; }

class TileRepair {
public:
    TileRepair(TiledMesh& mesh, const Body& body, const IndexLists& tets_of)
        : tiles_(mesh.tiles), boundary_(mesh.boundary), places_(mesh.places), body_(body), tets_of_(tets_of) {
    }

    void run(std::span<const TetChange> changes) {
        if (places_.room.empty()) find_places();
        places_.of_tet.resize(std::max(places_.of_tet.size(), body_.tets.size()), TilePlaces::none);
        places_.changes += changes.size();
        for (const TetChange& change : changes) {
            if (change.was_on) take_out(change.tet);
            if (change.is_on) put_in(change.tet, change.after);
        }
        if (!boundary_.is_closed) return;
        std::pmr::memory_resource* memory = places_.triangles.memory();
        Array<FacetKey> keys(memory);
        list_changed_facets(changes, keys);
        for (const FacetKey& key : keys) count_facet(key);
        Array<std::uint32_t> vertices(memory);
        list_changed_vertices(changes, vertices);
        for (const std::uint32_t v : vertices) update_loose(v);
        if (!boundary_pays(boundary_.triangles.size(), body_.tets.size() - body_.off_count))
            boundary_ = Boundary(memory);
    }

private:
    std::uint8_t* corners_of(std::uint32_t tile) {
        return tiles_.corners.data() + std::size_t{tile} * 4 * tile_size;
    }

    void find_places() {
        places_.of_tet.assign(body_.tets.size(), TilePlaces::none);
        places_.room.reserve(tiles_.tiles.size() + 16);
        for (std::uint32_t t = 0; t < tiles_.tiles.size(); ++t) {
            const Tile& tile = tiles_.tiles[t];
            for (std::uint32_t i = 0; i < tile.tet_count; ++i)
                places_.of_tet[tiles_.tets[tile.first_tet + i]] = t * tile_size + i;
            places_.room.push_back({tile.tet_count, static_cast<std::uint8_t>((tile.vertex_count + 3) & ~3)});
        }
        places_.changed_at.assign(tiles_.super_tile_count(), 0);
        if (!boundary_.is_closed) return;
        const Array<std::array<std::uint32_t, 3>>& triangles = boundary_.triangles;
        places_.triangles.list_by_vertex(static_cast<std::uint32_t>(triangles.size()), body_.vertex_count,
                                         [&](std::uint32_t t) { return std::span(triangles[t]).first(1); });
    }

    void take_out(std::uint32_t tet) noexcept {
        const std::uint32_t t = places_.tile_of(tet), place = places_.of_tet[tet] % tile_size;
        Tile& tile = tiles_.tiles[t];
        std::uint8_t* corners = corners_of(t);
        std::uint64_t* own = keeps_own_ ? tiles_.own.data() + tile.first_vertex : nullptr;
        std::uint32_t* tets = tiles_.tets.data() + tile.first_tet;
        const std::uint32_t last = --tile.tet_count;
        for (std::uint32_t c = 0; own && c < 4; ++c) own[corners[c * tile_size + place]] &= ~bit(place);
        places_.of_tet[tet] = TilePlaces::none;
        if (place != last) {
            for (std::uint32_t c = 0; c < 4; ++c) {
                const std::uint8_t local = corners[c * tile_size + last];
                if (own) own[local] = (own[local] & ~bit(last)) | bit(place);
                corners[c * tile_size + place] = local;
            }
            tets[place] = tets[last];
            places_.of_tet[tets[place]] = t * tile_size + place;
        }
        if (!boundary_.is_closed) return;
        for (std::uint64_t* set : {&boundary_.mirrored[t], &boundary_.ignored[t]})
            *set = ((*set & ~bit(place)) | (*set >> last & 1) << place) & tile.all_tets();
    }

    void put_in(std::uint32_t tet, const Tet& corners) {
        const std::uint32_t t = choose_tile(corners);
        make_room(t, missing_in(tiles_.tiles[t], corners));
        Tile& tile = tiles_.tiles[t];
        const std::uint32_t place = tile.tet_count++;
        for (std::uint32_t c = 0; c < 4; ++c) {
            const std::uint32_t local = local_index(t, corners.v[c]);
            corners_of(t)[c * tile_size + place] = static_cast<std::uint8_t>(local);
            if (keeps_own_) tiles_.own[tile.first_vertex + local] |= bit(place);
        }
        for (std::uint32_t i = tile.vertex_count; i % 4; ++i) // the list is padded with its last vertex
            tiles_.vertices[tile.first_vertex + i] =
                tiles_.vertices[tile.first_vertex + tile.vertex_count - 1];
        tiles_.tets[tile.first_tet + place] = tet;
        places_.of_tet[tet] = t * tile_size + place;
        places_.changed_at[tiles_.super_tile_of(t)] = places_.changes;
        if (!boundary_.is_closed) return;
        if (names_a_vertex_twice(corners))
            boundary_.ignored[t] |= bit(place);
        else if (is_negative(corners, body_.positions))
            boundary_.mirrored[t] |= bit(place);
    }

    std::uint32_t missing_in(const Tile& tile, const Tet& corners) const noexcept {
        const auto first = tiles_.vertices.begin() + tile.first_vertex, last = first + tile.vertex_count;
        std::uint32_t missing = 0;
        for_corners(corners, [&](std::uint32_t v) { missing += std::find(first, last, v) == last; });
        return missing;
    }

    // The tile that has room and holds the most corners already, among those of the first few tets around
    // each corner.
    std::uint32_t choose_tile(const Tet& corners) {
        constexpr std::size_t most_tets = 16, most_tiles = 8;
        std::uint32_t seen[most_tiles], best = TilePlaces::none, fewest_missing = 4;
        std::size_t count = 0;
        const auto look_at = [&](std::uint32_t t) {
            if (count == most_tiles || std::find(seen, seen + count, t) != seen + count) return;
            seen[count++] = t;
            const Tile& tile = tiles_.tiles[t];
            if (tile.tet_count == tile_size) return;
            const std::uint32_t missing = missing_in(tile, corners);
            if (missing >= fewest_missing || tile.vertex_count + missing > tile_size) return;
            fewest_missing = missing;
            best = t;
        };
        for (const std::uint32_t v : corners.v) {
            const std::span<const std::uint32_t> around = tets_of_[v];
            for (std::size_t i = 0; i < std::min(around.size(), most_tets); ++i)
                if (places_.of_tet[around[i]] != TilePlaces::none) look_at(places_.tile_of(around[i]));
        }
        if (best != TilePlaces::none) return best;
        // A few tets that lie apart share a tile.
        constexpr std::uint32_t few_tets = 8;
        const auto last = static_cast<std::uint32_t>(tiles_.tiles.size() - 1);
        if (tiles_.super_tile_count() > places_.first_young_super &&
            tiles_.tiles[last].tet_count < few_tets && tiles_.tiles[last].vertex_count + 4u <= tile_size)
            return last;
        return new_tile();
    }

    std::uint32_t new_tile() {
        const auto t = static_cast<std::uint32_t>(tiles_.tiles.size());
        Tile tile{};
        tile.first_tet = static_cast<std::uint32_t>(tiles_.tets.size());
        tile.first_vertex = static_cast<std::uint32_t>(tiles_.vertices.size());
        tiles_.tets.resize(tiles_.tets.size() + tile_size);
        tiles_.vertices.resize(tiles_.vertices.size() + tile_size);
        if (keeps_own_) tiles_.own.resize(tiles_.vertices.size());
        tiles_.corners.resize(tiles_.corners.size() + 4 * tile_size, 0);
        tiles_.tiles.push_back(tile);
        places_.room.push_back({tile_size, tile_size});
        if (boundary_.is_closed) {
            boundary_.mirrored.push_back(0);
            boundary_.ignored.push_back(0);
        }
        Array<std::uint32_t>& super_first = tiles_.super_first;
        const std::uint32_t supers = tiles_.super_tile_count();
        if (supers > places_.first_young_super && t - super_first[supers - 1] < super_tile_size)
            super_first.back() = t + 1;
        else
            super_first.push_back(t + 1);
        tiles_.blocks.resize(tiles_.super_tile_count());
        places_.changed_at.resize(tiles_.super_tile_count());
        return t;
    }

    // Makes room for one more tet and so many more vertices. The lists of a tile that has none move to the
    // end, once.
    void make_room(std::uint32_t t, std::uint32_t vertices) {
        Tile& tile = tiles_.tiles[t];
        TilePlaces::Room& room = places_.room[t];
        const auto move_to_end = [](auto& list, std::uint32_t first, std::uint32_t count) {
            const std::size_t end = list.size();
            list.resize(end + tile_size);
            std::copy_n(list.begin() + first, count, list.begin() + static_cast<std::ptrdiff_t>(end));
            return static_cast<std::uint32_t>(end);
        };
        if (tile.tet_count == room.tets) {
            tile.first_tet = move_to_end(tiles_.tets, tile.first_tet, tile.tet_count);
            room.tets = tile_size;
        }
        if (tile.vertex_count + vertices > room.vertices) {
            if (keeps_own_) (void)move_to_end(tiles_.own, tile.first_vertex, tile.vertex_count);
            tile.first_vertex = move_to_end(tiles_.vertices, tile.first_vertex, tile.vertex_count);
            room.vertices = tile_size;
        }
    }

    // The local index of a vertex, which is added to the tile if it is new there.
    std::uint32_t local_index(std::uint32_t t, std::uint32_t vertex) {
        Tile& tile = tiles_.tiles[t];
        const auto first = tiles_.vertices.begin() + tile.first_vertex, last = first + tile.vertex_count;
        const auto found = std::find(first, last, vertex);
        if (found != last) return static_cast<std::uint32_t>(found - first);
        *last = vertex;
        if (keeps_own_) tiles_.own[tile.first_vertex + tile.vertex_count] = 0;
        tile.holds_last_vertex |= vertex == body_.vertex_count - 1;
        const std::uint32_t block = tiles_.block_of(vertex), super = tiles_.super_tile_of(t);
        const std::span<const std::uint32_t> listed = tiles_.blocks[super];
        const auto place = std::lower_bound(listed.begin(), listed.end(), block);
        if (place == listed.end() || *place != block)
            tiles_.blocks.insert(super, static_cast<std::size_t>(place - listed.begin()), block);
        return tile.vertex_count++;
    }

    // ---- the boundary ----

    void count_facet(const FacetKey& key) {
        int net = 0;
        for_tets_at(key, body_.tets, tets_of_, [&](std::uint32_t tet, std::uint32_t i) {
            const bool even = sorted_facet(body_.tets[tet], i).even;
            const std::uint32_t place = places_.of_tet[tet];
            const bool mirrored = boundary_.mirrored[place / tile_size] >> place % tile_size & 1;
            net += even != mirrored ? 1 : -1;
        });
        Array<std::array<std::uint32_t, 3>>& triangles = boundary_.triangles;
        const std::span<const std::uint32_t> at_low = places_.triangles[key.low];
        const auto found = std::find_if(at_low.begin(), at_low.end(), [&](std::uint32_t t) {
            return sorted_facet(triangles[t][0], triangles[t][1], triangles[t][2]).key == key;
        });
        if (net == 0) {
            if (found != at_low.end()) drop_triangle(key.low, *found);
        } else if (found != at_low.end()) {
            triangles[*found] = triangle_of({key, net > 0});
        } else {
            places_.triangles.add(key.low, static_cast<std::uint32_t>(triangles.size()));
            triangles.push_back(triangle_of({key, net > 0}));
        }
    }

    // The last one takes its place.
    void drop_triangle(std::uint32_t low, std::uint32_t hole) noexcept {
        Array<std::array<std::uint32_t, 3>>& triangles = boundary_.triangles;
        const auto last = static_cast<std::uint32_t>(triangles.size() - 1);
        places_.triangles.remove(low, hole);
        if (hole != last) {
            const std::uint32_t moved = *std::min_element(triangles[last].begin(), triangles[last].end());
            for (std::uint32_t& t : places_.triangles[moved])
                if (t == last) t = hole;
            triangles[hole] = triangles[last];
        }
        triangles.pop_back();
    }

    void update_loose(std::uint32_t vertex) {
        const std::span<const std::uint32_t> around = tets_of_[vertex];
        const bool is_loose = std::all_of(around.begin(), around.end(), [&](std::uint32_t tet) {
            return names_a_vertex_twice(body_.tets[tet]);
        });
        Array<std::uint32_t>& loose = boundary_.loose;
        const auto place = std::lower_bound(loose.begin(), loose.end(), vertex);
        const bool was_loose = place != loose.end() && *place == vertex;
        if (is_loose && !was_loose) loose.insert(place, vertex);
        if (!is_loose && was_loose) loose.erase(place);
    }

    Tiles& tiles_;
    Boundary& boundary_;
    TilePlaces& places_;
    const Body& body_;
    const IndexLists& tets_of_;
    const bool keeps_own_ = !tiles_.own.empty() || (body_.self_collision && tiles_.vertices.empty());
};

} // namespace

bool repair(TiledMesh& mesh, const Body& body, std::span<const TetChange> changes,
            const IndexLists& tets_of) {
    // The share of the tets that may change before tiles are made anew, which takes about as long as their
    // repair did by then.
    if (mesh.places.changes + changes.size() > body.tets.size() / 4 + tile_size) return false;
    TileRepair(mesh, body, tets_of).run(changes);
    return true;
}

bool add_vertices(TiledMesh& mesh, std::uint32_t count_before, std::uint32_t count_after) {
    if (count_before == 0) return false;
    Array<std::uint32_t>& first = mesh.tiles.block_first;
    for (std::uint32_t v = count_before; v < count_after; ++v) {
        const std::uint32_t begin = first[first.size() - 2];
        if (begin >= mesh.places.first_young_vertex && v - begin < block_size)
            first.back() = v + 1;
        else
            first.push_back(v + 1);
    }
    if (!mesh.boundary.is_closed) return true;
    for (std::uint32_t v = count_before; v < count_after; ++v) mesh.boundary.loose.push_back(v);
    if (!mesh.places.triangles.empty()) mesh.places.triangles.resize(count_after);
    return true;
}

void remove_loose(Boundary& boundary, std::uint32_t vertex) noexcept {
    const auto place = std::lower_bound(boundary.loose.begin(), boundary.loose.end(), vertex);
    if (place != boundary.loose.end() && *place == vertex) boundary.loose.erase(place);
}

} // namespace vox
