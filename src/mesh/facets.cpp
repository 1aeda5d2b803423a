// Tetrahedra are listed by corner with a counting sort. Then the facets that have a vertex as their lowest
// one are sorted and matched, vertex by vertex: these lists are short and stay in cache.
#include "mesh/facets.hpp"

#include <algorithm>

namespace vox {

namespace {

// The corners of a tetrahedron, ascending, each as vertex << 2 | local index. Without branches, which would
// be mispredicted.
std::array<std::uint64_t, 4> sorted_corners(const Tet& tet) noexcept {
    std::array<std::uint64_t, 4> c;
    for (std::uint32_t i = 0; i < 4; ++i) c[i] = std::uint64_t{tet.v[i]} << 2 | i;
    const auto order = [&c](std::size_t i, std::size_t j) {
        const std::uint64_t low = std::min(c[i], c[j]), high = std::max(c[i], c[j]);
        c[i] = low;
        c[j] = high;
    };
    order(0, 1);
    order(2, 3);
    order(0, 2);
    order(1, 3);
    order(1, 2);
    return c;
}

} // namespace

IndexLists list_whole_tets(std::span<const Tet> tets, std::uint32_t vertex_count,
                           std::pmr::memory_resource* memory) {
    IndexLists lists(memory);
    lists.list_by_vertex(static_cast<std::uint32_t>(tets.size()), vertex_count, [&](std::uint32_t t) {
        return std::span<const std::uint32_t>(tets[t].v, names_a_vertex_twice(tets[t]) ? 0 : 4);
    });
    return lists;
}

IndexLists list_by_lowest(std::span<const Tet> tets, std::uint32_t vertex_count,
                          std::pmr::memory_resource* memory) {
    IndexLists lists(memory);
    std::uint32_t lowest[2];
    lists.list_by_vertex(static_cast<std::uint32_t>(tets.size()), vertex_count, [&](std::uint32_t t) {
        const std::array<std::uint64_t, 4> corners = sorted_corners(tets[t]);
        for (std::size_t i = 0; i < 2; ++i) lowest[i] = static_cast<std::uint32_t>(corners[i] >> 2);
        return std::span<const std::uint32_t>(lowest, names_a_vertex_twice(tets[t]) ? 0 : 2);
    });
    return lists;
}

void list_facets_at(std::uint32_t vertex, std::span<const Tet> tets, std::span<const std::uint32_t> around,
                    std::pmr::vector<TetFacet>& facets) {
    facets.resize(3 * around.size());
    std::size_t count = 0;
    for (const std::uint32_t t : around) {
        // With two lower corners, every facet has one of them.
        const std::uint32_t* v = tets[t].v;
        if ((v[0] < vertex) + (v[1] < vertex) + (v[2] < vertex) + (v[3] < vertex) > 1) continue;
        const std::array<std::uint64_t, 4> c = sorted_corners(tets[t]);
        const auto facet = [&](std::size_t middle, std::size_t high, std::size_t opposite) {
            return TetFacet{c[middle] >> 2 << 32 | c[high] >> 2, static_cast<std::uint32_t>(c[opposite] >> 2),
                            4 * t + static_cast<std::uint32_t>(c[opposite] & 3)};
        };
        const bool lowest = c[0] >> 2 == vertex; // else it is the second
        facets[count] = facet(lowest ? 1 : 2, lowest ? 2 : 3, lowest ? 3 : 0);
        if (lowest) {
            facets[count + 1] = facet(1, 3, 2);
            facets[count + 2] = facet(2, 3, 1);
        }
        count += lowest ? 3 : 1;
    }
    facets.resize(count);
}

void sort_facets(std::span<TetFacet> facets) {
    constexpr std::size_t few = 48;
    if (facets.size() > few) return std::sort(facets.begin(), facets.end());
    // By insertion, as each element costs one mispredicted branch.
    for (std::size_t i = 1; i < facets.size(); ++i) {
        const TetFacet facet = facets[i];
        std::size_t j = i;
        for (; j > 0 && facet < facets[j - 1]; --j) facets[j] = facets[j - 1];
        facets[j] = facet;
    }
}

void MatchedFacets::clear(std::size_t tets) {
    across.begin(tets);
    triangles.clear();
    is_repaired = false;
}

void FacetMatcher::match_at(std::uint32_t vertex, std::span<const std::uint32_t> around) {
    list_facets_at(vertex, tets_, around, facets_);
    if (facets_.size() <= most_hashed && match_pairs(vertex)) return;
    sort_facets(facets_);
    for_equal_facets(facets_, [&](std::span<const TetFacet> same) { match(same); });
}

void FacetMatcher::match(std::span<const TetFacet> same) {
    out_.match(tets_, same, [this](std::uint32_t tet, std::uint32_t facet, std::uint32_t value) {
        out_.across.build(tet, facet, value);
    });
}

// Almost all facets belong to one tetrahedron or two different ones, which a small hash table finds sooner
// than sorting does. Returns false, and has matched nothing, where a facet does not.
bool FacetMatcher::match_pairs(std::uint32_t vertex) {
    constexpr std::uint32_t none = 0xffffffffu;
    constexpr std::size_t last = (std::size_t{1} << table_bits) - 1;
    const auto count = static_cast<std::uint32_t>(facets_.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        const TetFacet& facet = facets_[i];
        // Multiplicative hashing (D. E. Knuth, The Art of Computer Programming 3, Sect. 6.4).
        std::size_t place = facet.others * 0x9e3779b97f4a7c15u >> (64 - table_bits);
        while (table_[place].used_at == vertex + 1 && table_[place].others != facet.others)
            place = (place + 1) & last;
        Slot& slot = table_[place];
        partner_[i] = none;
        if (slot.used_at != vertex + 1) {
            slot = {facet.others, vertex + 1, i};
            continue;
        }
        if (partner_[slot.first] != none || facets_[slot.first].opposite == facet.opposite) return false;
        partner_[slot.first] = facet.tet();
        partner_[i] = facets_[slot.first].tet();
    }
    std::size_t alone = 0; // they move to the front
    for (std::uint32_t i = 0; i < count; ++i) {
        const TetFacet facet = facets_[i];
        if (partner_[i] != none)
            out_.across.build(facet.tet(), facet.index(), partner_[i]);
        else
            facets_[alone++] = facet;
    }
    facets_.resize(alone);
    sort_facets(facets_);
    for (const TetFacet& facet : facets_) match({&facet, 1});
    return true;
}

void match_facets(std::span<const Tet> tets, std::uint32_t vertex_count, MatchedFacets& out) {
    std::pmr::memory_resource* memory = out.across.memory();
    MatchedFacets made(memory);
    made.clear(tets.size());
    const IndexLists around = list_by_lowest(tets, vertex_count, memory);
    FacetMatcher matcher(tets, made);
    for (std::uint32_t v = 0; v < vertex_count; ++v) matcher.match_at(v, around[v]);
    made.across.finish();
    out = std::move(made);
}

} // namespace vox
