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

// Finds the tets that are ignored, for each tile, and the vertices of no other tets. Returns for each tet
// whether it is negative.
Array<std::uint8_t> look_at_tets(std::span<const Tet> tets, std::uint32_t vertex_count,
                                 const Positions& positions, const Tiles& tiles, Boundary& made) {
    std::pmr::memory_resource* memory = made.triangles.memory();
    Array<std::uint8_t> negative(tets.size(), 0, memory), used(vertex_count, 0, memory);
    made.ignored.reserve(tiles.tiles.size());
    for (const Tile& tile : tiles.tiles) {
        std::uint64_t ignored = 0;
        for (std::uint32_t i = 0; i < tile.tet_count; ++i) {
            const std::uint32_t t = tiles.tets[tile.first_tet + i];
            if (names_a_vertex_twice(tets[t])) {
                ignored |= std::uint64_t{1} << i;
                continue;
            }
            negative[t] = is_negative(tets[t], positions);
            for (const std::uint32_t v : tets[t].v) used[v] = 1;
        }
        made.ignored.push_back(ignored);
    }
    for (std::uint32_t v = 0; v < vertex_count; ++v)
        if (!used[v]) made.loose.push_back(v);
    return negative;
}

// Calls visit(facet, other, its facet) for each neighbour of a tet across a facet that they alone share.
template <class Visit>
void for_neighbours(const MatchedFacets& facets, std::uint32_t t, Visit&& visit) {
    for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t across = facets.across(t, i);
        if (across & MatchedFacets::surface_bit) continue; // also of `nothing`
        const std::array<std::uint32_t, 4> back = facets.across[across];
        const auto j = static_cast<std::uint32_t>(std::find(back.begin(), back.end(), t) - back.begin());
        if (j < 4) visit(i, across, j);
    }
}

// Tets that have turned over are negative beside neighbours that are not. Calls each tet negative, or not, so
// that neighbours are on different sides of their facet, and so that as few as possible of a connected part
// change. False where that cannot be.
bool agree_with_neighbours(std::span<const Tet> tets, const MatchedFacets& facets,
                           std::span<std::uint8_t> negative) {
    std::pmr::memory_resource* memory = facets.across.memory();
    Array<std::uint8_t> seen(tets.size(), 0, memory), found(negative.begin(), negative.end(), memory);
    Array<std::uint32_t> part(memory);
    for (std::uint32_t first = 0; first < tets.size(); ++first) {
        if (seen[first] || names_a_vertex_twice(tets[first])) continue;
        part.assign(1, first);
        seen[first] = 1;
        std::size_t changed = 0;
        bool agree = true;
        for (std::size_t next = 0; next < part.size(); ++next) {
            const std::uint32_t t = part[next];
            changed += found[t] != negative[t];
            for_neighbours(facets, t, [&](std::uint32_t i, std::uint32_t other, std::uint32_t j) {
                const bool same = sorted_facet(tets[t], i).even == sorted_facet(tets[other], j).even;
                const auto wanted = static_cast<std::uint8_t>(same != (found[t] != 0));
                if (seen[other]) {
                    agree = agree && found[other] == wanted;
                    return;
                }
                seen[other] = 1;
                found[other] = wanted;
                part.push_back(other);
            });
        }
        if (!agree) return false;
        for (const std::uint32_t t : part) negative[t] = found[t] != (2 * changed > part.size());
    }
    return true;
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
            const std::uint32_t across = facets.across(t, i);
            if (across == MatchedFacets::nothing) return false; // three tets or more
            const SortedFacet facet = as_positive(t, i);
            if (across & MatchedFacets::surface_bit) {
                std::array<std::uint32_t, 3>& triangle = made.triangles[across & ~MatchedFacets::surface_bit];
                if (triangle != missing) return false; // a doubled tet
                triangle = triangle_of(facet);
                continue;
            }
            const std::array<std::uint32_t, 4> back = facets.across[across];
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
    std::pmr::memory_resource* memory = out.triangles.memory();
    Boundary made(memory);
    if (tets.size() > most_tets) {
        out = std::move(made);
        return;
    }
    MatchedFacets matched(memory);
    if (!facets) {
        match_facets(tets, vertex_count, matched);
        facets = &matched;
    }
    Array<std::uint8_t> negative = look_at_tets(tets, vertex_count, positions, tiles, made);
    made.is_closed =
        make_triangles(tets, negative, *facets, made) ||
        (agree_with_neighbours(tets, *facets, negative) && make_triangles(tets, negative, *facets, made));
    made.mirrored.assign(made.is_closed ? tiles.tiles.size() : 0, 0);
    for (std::size_t tile = 0; tile < made.mirrored.size(); ++tile)
        for (std::uint32_t i = 0; i < tiles.tiles[tile].tet_count; ++i)
            made.mirrored[tile] |= std::uint64_t{negative[tiles.tets[tiles.tiles[tile].first_tet + i]]} << i;
    out = made.is_closed ? std::move(made) : Boundary(memory);
}

} // namespace vox
