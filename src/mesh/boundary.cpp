#include "mesh/boundary.hpp"

#include "base/vectors.hpp"

#include <algorithm>

namespace vox {

bool is_negative(const Tet& tet, const Positions& positions) noexcept {
    const Vec3d a = positions.exact(tet.v[0]);
    const auto edge = [&](int corner) { return positions.exact(tet.v[corner]) - a; };
    return determinant(edge(1), edge(2), edge(3)) < 0;
}

std::array<std::uint32_t, 3> triangle_of(const SortedFacet& facet) noexcept {
    const auto& [low, middle, high] = facet.key;
    if (facet.even) return {low, middle, high};
    return {low, high, middle};
}

namespace {

// Finds the tets that are mirrored or ignored, for each tile, and the vertices of no other tets. Returns for
// each tet whether it is mirrored.
std::pmr::vector<std::uint8_t> look_at_tets(std::span<const Tet> tets, std::uint32_t vertex_count,
                                            const Positions& positions, const Tiles& tiles, Boundary& made) {
    std::pmr::memory_resource* memory = made.triangles.get_allocator().resource();
    std::pmr::vector<std::uint8_t> negative(tets.size(), 0, memory), used(vertex_count, 0, memory);
    made.mirrored.reserve(tiles.tiles.size());
    made.ignored.reserve(tiles.tiles.size());
    for (const Tile& tile : tiles.tiles) {
        std::uint64_t mirrored = 0, ignored = 0;
        for (std::uint32_t i = 0; i < tile.tet_count; ++i) {
            const std::uint32_t t = tiles.tets[tile.first_tet + i];
            if (names_a_vertex_twice(tets[t])) {
                ignored |= std::uint64_t{1} << i;
                continue;
            }
            negative[t] = is_negative(tets[t], positions);
            mirrored |= std::uint64_t{negative[t]} << i;
            for (const std::uint32_t v : tets[t].v) used[v] = 1;
        }
        made.mirrored.push_back(mirrored);
        made.ignored.push_back(ignored);
    }
    for (std::uint32_t v = 0; v < vertex_count; ++v)
        if (!used[v]) made.loose.push_back(v);
    return negative;
}

// Makes the triangles; false where tets on different sides of a facet do not cancel.
bool make_triangles(std::span<const Tet> tets, std::span<const std::uint8_t> negative,
                    const MatchedFacets& facets, Boundary& made) {
    constexpr std::array<std::uint32_t, 3> missing{};
    // Facet i of a tet, even when low, middle, high are counter-clockwise from outside.
    const auto as_positive = [&](std::uint32_t t, std::uint32_t i) {
        SortedFacet facet = sorted_facet(tets[t], i);
        facet.even = facet.even != (negative[t] != 0);
        return facet;
    };
    made.triangles.assign(facets.triangles.size(), missing);
    for (std::uint32_t t = 0; t < tets.size(); ++t) {
        if (names_a_vertex_twice(tets[t])) continue;
        for (std::uint32_t i = 0; i < 4; ++i) {
            const std::uint32_t across = facets.across[t][i];
            if (across == MatchedFacets::nothing) return false; // three tets or more
            const SortedFacet facet = as_positive(t, i);
            if (across & MatchedFacets::surface_bit) {
                std::array<std::uint32_t, 3>& triangle = made.triangles[across & ~MatchedFacets::surface_bit];
                if (triangle != missing) return false; // a doubled tet
                triangle = triangle_of(facet);
                continue;
            }
            const auto& back = facets.across[across];
            const auto j = static_cast<std::uint32_t>(std::find(back.begin(), back.end(), t) - back.begin());
            if (j == 4) return false;                                    // a doubled tet
            if (as_positive(across, j).even == facet.even) return false; // both on one side
        }
    }
    const auto key = [](const std::array<std::uint32_t, 3>& t) { return sorted_facet(t[0], t[1], t[2]).key; };
    if (facets.is_repaired)
        std::sort(made.triangles.begin(), made.triangles.end(),
                  [&](const auto& a, const auto& b) { return key(a) < key(b); });
    return true;
}

} // namespace

void make_boundary(std::span<const Tet> tets, std::uint32_t vertex_count, Positions positions,
                   const Tiles& tiles, Boundary& out, const MatchedFacets* facets) {
    std::pmr::memory_resource* memory = out.triangles.get_allocator().resource();
    Boundary made(memory);
    if (tets.size() > most_tets) {
        out = std::move(made);
        return;
    }
    std::pmr::vector<std::uint8_t> negative = look_at_tets(tets, vertex_count, positions, tiles, made);
    if (facets) {
        made.is_closed = make_triangles(tets, negative, *facets, made);
    } else { // in the order of the tiles, in which neighbours are near each other in memory
        std::pmr::vector<Tet> ordered(memory);
        std::pmr::vector<std::uint8_t> signs(memory);
        ordered.reserve(tets.size());
        signs.reserve(tets.size());
        for (const Tile& tile : tiles.tiles)
            for (std::uint32_t i = 0; i < tile.tet_count; ++i) {
                const std::uint32_t t = tiles.tets[tile.first_tet + i];
                ordered.push_back(tets[t]);
                signs.push_back(negative[t]);
            }
        MatchedFacets matched(memory);
        match_facets(ordered, vertex_count, matched);
        made.is_closed = make_triangles(ordered, signs, matched, made);
    }
    out = made.is_closed ? std::move(made) : Boundary(memory);
}

} // namespace vox
