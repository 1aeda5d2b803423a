// Facets are matched within each tile first, by their local indices; the few that are left by their lowest
// vertex.
#include "mesh/boundary.hpp"

#include <algorithm>

namespace vox {

bool is_negative(const Tet& tet, const Positions& positions) noexcept {
    const Vec3d a = positions.exact(tet.v[0]);
    double e[3][3];
    for (int i = 0; i < 3; ++i) {
        const Vec3d p = positions.exact(tet.v[i + 1]);
        e[i][0] = p.x - a.x;
        e[i][1] = p.y - a.y;
        e[i][2] = p.z - a.z;
    }
    return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) +
               e[0][1] * (e[1][2] * e[2][0] - e[1][0] * e[2][2]) +
               e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]) <
           0;
}

std::array<std::uint32_t, 3> triangle_of(const SortedFacet& facet) noexcept {
    const auto& [low, middle, high] = facet.key;
    if (facet.even) return {low, middle, high};
    return {low, high, middle};
}

namespace {

// Facets without a partner in their tile.
using Open = SortedFacet;

// Adds the facets of tile `index` that have no partner in it to `open`; false when some facet has two.
bool match_in_tile(std::span<const Tet> tets, Positions positions, const Tiles& tiles, std::size_t index,
                   Boundary& made, std::pmr::vector<Open>& open, std::pmr::vector<std::uint8_t>& used) {
    const Tile& tile = tiles.tiles[index];
    const std::uint8_t* corners = tiles.corners.data() + index * 4 * tile_size;
    const std::uint32_t* vertices = tiles.vertices.data() + tile.first_vertex;
    // Sorted local vertices, 6 bits each, then the parity, above the number of tet and facet.
    std::uint32_t keys[4 * tile_size], count = 0;
    std::uint64_t mirrored = 0, ignored = 0;
    for (std::uint32_t t = 0; t < tile.tet_count; ++t) {
        std::uint32_t local[4];
        for (std::uint32_t c = 0; c < 4; ++c) local[c] = corners[c * tile_size + t];
        if (names_a_vertex_twice({{local[0], local[1], local[2], local[3]}})) {
            ignored |= std::uint64_t{1} << t;
            continue;
        }
        const bool negative = is_negative(tets[tiles.tets[tile.first_tet + t]], positions);
        if (negative) mirrored |= std::uint64_t{1} << t;
        for (std::uint32_t c = 0; c < 4; ++c) used[vertices[local[c]]] = 1;
        for (std::uint32_t f = 0; f < 4; ++f) {
            const auto [key, even] =
                sorted_facet(local[facets[f][0]], local[facets[f][1]], local[facets[f][2]]);
            keys[count++] = key.low << 13 | key.middle << 7 | key.high << 1 | std::uint32_t{even != negative};
        }
    }
    made.mirrored.push_back(mirrored);
    made.ignored.push_back(ignored);
    std::sort(keys, keys + count);
    for (std::uint32_t i = 0; i < count; ++i) {
        if (i + 1 < count && keys[i] >> 1 == keys[i + 1] >> 1) {
            if (keys[i] == keys[i + 1]) return false;                            // both on one side
            if (i + 2 < count && keys[i] >> 1 == keys[i + 2] >> 1) return false; // three tets
            ++i;
            continue;
        }
        const auto [key, even] =
            sorted_facet(vertices[keys[i] >> 13], vertices[keys[i] >> 7 & 63], vertices[keys[i] >> 1 & 63]);
        open.push_back({key, even == (keys[i] & 1)});
    }
    return true;
}

} // namespace

void make_boundary(std::span<const Tet> tets, std::uint32_t vertex_count, Positions positions,
                  const Tiles& tiles, Boundary& out) {
    std::pmr::memory_resource* memory = out.triangles.get_allocator().resource();
    Boundary made(memory);
    std::pmr::vector<Open> open(memory);
    std::pmr::vector<std::uint8_t> used(vertex_count, 0, memory);
    open.reserve(tets.size() + 64);
    made.mirrored.reserve(tiles.tiles.size());
    made.ignored.reserve(tiles.tiles.size());
    for (std::size_t i = 0; i < tiles.tiles.size(); ++i)
        if (!match_in_tile(tets, positions, tiles, i, made, open, used)) {
            out = Boundary(memory);
            return;
        }
    for (std::uint32_t v = 0; v < vertex_count; ++v)
        if (!used[v]) made.loose.push_back(v);

    // By the lowest vertex: counted, summed, placed; then by the others.
    std::pmr::vector<std::uint32_t> begin(std::size_t{vertex_count} + 1, 0, memory),
        placed(open.size(), memory);
    for (const Open& facet : open) ++begin[facet.key.low + 1];
    for (std::uint32_t v = 0; v < vertex_count; ++v) begin[v + 1] += begin[v];
    for (std::uint32_t i = 0; i < open.size(); ++i) placed[begin[open[i].key.low]++] = i;
    const auto before = [&](std::uint32_t x, std::uint32_t y) {
        const FacetKey &f = open[x].key, &g = open[y].key;
        return f.middle != g.middle ? f.middle < g.middle : f.high < g.high;
    };
    for (std::size_t first = 0; first < placed.size();) {
        std::size_t last = first;
        while (last < placed.size() && open[placed[last]].key.low == open[placed[first]].key.low) ++last;
        std::sort(placed.begin() + std::ptrdiff_t(first), placed.begin() + std::ptrdiff_t(last), before);
        for (std::size_t i = first; i < last;) {
            std::size_t end = i + 1;
            while (end < last && !before(placed[i], placed[end])) ++end;
            const Open& facet = open[placed[i]];
            if (end - i > 2 || (end - i == 2 && facet.even == open[placed[i + 1]].even)) {
                out = Boundary(memory);
                return;
            }
            if (end - i == 1) made.triangles.push_back(triangle_of(facet));
            i = end;
        }
        first = last;
    }
    made.triangles.shrink_to_fit();
    made.is_closed = true;
    out = std::move(made);
}

} // namespace vox
