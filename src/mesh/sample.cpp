#include "mesh/sample.hpp"

#include "base/bits.hpp"
#include "base/sampling.hpp"
#include "mesh/facets.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

std::size_t sampled_tets(std::uint64_t tets) noexcept {
    return static_cast<std::size_t>(std::clamp<std::uint64_t>(tets / 48, 96, 256));
}

SampleSize kept_sample(std::uint64_t tets) noexcept {
    const std::size_t kept = sampled_tets(tets);
    return {kept / 2, kept, kept};
}

namespace {

// Which vertices are chosen: those whose multiple of the golden ratio has a small enough fractional part, so
// that they are spread evenly over the numbering (H. Weyl, 1916), whatever pattern repeats in it.
struct ChosenVertices {
    std::uint32_t last; // of the fractional parts, in units of 2^-32

    static std::uint32_t part(std::uint32_t v) noexcept { return v * 0x9e3779b9u; }
    bool operator()(std::uint32_t v) const noexcept { return part(v) <= last; }
};

ChosenVertices choose_about(std::uint64_t wanted, std::uint64_t of) {
    if (wanted >= of) return {0xffffffffu};
    return {static_cast<std::uint32_t>(static_cast<double>(wanted) / static_cast<double>(of) * 0x1p32)};
}

// The corners above a chosen one, in ascending order.
struct Above {
    std::uint32_t vertex;
    std::uint32_t count; // 1 to 3
    std::uint32_t v[3];
};

// What chosen vertices have of a mesh.
struct Listed {
    explicit Listed(std::pmr::memory_resource* memory) : above(memory) {}

    std::pmr::vector<Above> above;
    std::uint64_t tets = 0, proper = 0; // that have a chosen vertex; of them, those that name none twice
};

// Finds the tetrahedra that have a chosen vertex, and the vertices that any has.
void list_around(const Body& body, const ChosenVertices& chosen, std::pmr::vector<std::uint8_t>& used,
                 Listed& out) {
    out.above.clear();
    out.tets = out.proper = 0;
    const auto add = [&](Tet tet) {
        ++out.tets;
        if (names_a_vertex_twice(tet)) return;
        ++out.proper;
        std::uint32_t* v = tet.v;
        if (v[0] > v[1]) std::swap(v[0], v[1]); // a sorting network
        if (v[2] > v[3]) std::swap(v[2], v[3]);
        if (v[0] > v[2]) std::swap(v[0], v[2]);
        if (v[1] > v[3]) std::swap(v[1], v[3]);
        if (v[1] > v[2]) std::swap(v[1], v[2]);
        for (std::uint32_t i = 0; i < 3; ++i) {
            if (!chosen(v[i])) continue;
            Above& above = out.above.emplace_back();
            above.vertex = v[i];
            above.count = 3 - i;
            std::copy(v + i + 1, v + 4, above.v);
        }
    };
    const auto visit = [&](std::size_t t) {
        if (has_bit(body.off, t)) return;
        const std::uint32_t* v = body.tets[t].v;
        used[v[0]] = used[v[1]] = used[v[2]] = used[v[3]] = 1;
        if (chosen(v[0]) || chosen(v[1]) || chosen(v[2]) || chosen(v[3])) add(body.tets[t]);
    };
    // Mostly none of some tetrahedra has a chosen vertex, which is found out without a branch.
    constexpr std::size_t at_once = 4;
    std::size_t t = 0;
    for (; t + at_once <= body.tets.size() && body.off.empty(); t += at_once) {
        const std::uint32_t* v = body.tets[t].v;
        std::uint32_t least = 0xffffffffu;
        for (std::size_t i = 0; i < 4 * at_once; ++i) least = std::min(least, ChosenVertices::part(v[i]));
        if (least <= chosen.last)
            for (std::size_t i = 0; i < at_once; ++i) visit(t + i);
        else
            for (std::size_t i = 0; i < 4 * at_once; ++i) used[v[i]] = 1;
    }
    for (; t < body.tets.size(); ++t) visit(t);
}

// Sorted by vertex (counting sort).
void sort_by_vertex(std::uint32_t vertex_count, std::pmr::vector<Above>& list) {
    std::pmr::memory_resource* memory = list.get_allocator().resource();
    std::pmr::vector<std::uint32_t> place(std::size_t{vertex_count} + 1, 0, memory);
    for (const Above& above : list) ++place[std::size_t{above.vertex} + 1];
    for (std::size_t v = 0; v < vertex_count; ++v) place[v + 1] += place[v];
    std::pmr::vector<Above> sorted(list.size(), memory);
    for (const Above& above : list) sorted[place[above.vertex]++] = above;
    list = std::move(sorted);
}

template <class Item>
void keep(std::size_t wanted, std::pmr::vector<Item>& items) {
    if (items.size() <= wanted) return;
    std::size_t kept = 0;
    for_stratified(items.size(), wanted, 0.5,
                   [&](std::uint64_t i) { items[kept++] = items[static_cast<std::size_t>(i)]; });
    items.resize(kept);
    items.shrink_to_fit();
}

// Counts of all from those of a part: how often tetrahedra have what was listed, against how often they have
// any. Exact where everything was listed.
std::uint64_t of_all(std::uint64_t listed, std::uint64_t met, double met_in_all) {
    return met == 0 ? 0
                    : static_cast<std::uint64_t>(std::llround(static_cast<double>(listed) *
                                                              (met_in_all / static_cast<double>(met))));
}

} // namespace

MeshSample make_sample(const Body& body, const SampleSize& size, std::pmr::memory_resource* memory) {
    MeshSample sample(memory);
    const std::uint64_t tets = body.tets.size() - body.off_count;
    if (tets == 0) return sample;
    for_stratified(body.tets.size(), size.tets, 0.5, [&](std::uint64_t t) {
        if (!has_bit(body.off, t)) sample.tets.push_back(body.tets[static_cast<std::size_t>(t)]);
    });

    std::pmr::vector<std::uint8_t> used(body.vertex_count, 0, memory);
    Listed listed(memory);
    std::uint64_t vertices = body.vertex_count;
    list_around(body, choose_about(size.vertices, vertices), used, listed);
    const auto used_count = static_cast<std::uint64_t>(std::count(used.begin(), used.end(), std::uint8_t{1}));
    if (used_count < vertices) {
        sample.unused_vertices.resize((std::size_t{body.vertex_count} + 63) / 64);
        for (std::uint32_t v = 0; v < body.vertex_count; ++v)
            if (!used[v]) sample.unused_vertices[v / 64] |= std::uint64_t{1} << v % 64;
    }
    // Where tetrahedra use few of the vertices, too few may have been chosen.
    while (listed.tets < std::min<std::uint64_t>(size.vertices, tets) && vertices > 1) {
        vertices = std::min(used_count, vertices / 4 + 1);
        list_around(body, choose_about(size.vertices, vertices), used, listed);
    }
    sort_by_vertex(body.vertex_count, listed.above);

    std::uint64_t edges_met = 0, facets_met = 0;
    std::pmr::vector<std::uint32_t> ends(memory);
    std::pmr::vector<std::uint64_t> others(memory); // of a facet: the middle vertex << 32 | the highest one
    for (auto first = listed.above.begin(); first != listed.above.end();) {
        const std::uint32_t v = first->vertex;
        ends.clear();
        others.clear();
        for (; first != listed.above.end() && first->vertex == v; ++first)
            for (std::uint32_t i = 0; i < first->count; ++i) {
                ends.push_back(first->v[i]);
                for (std::uint32_t j = i + 1; j < first->count; ++j)
                    others.push_back(std::uint64_t{first->v[i]} << 32 | first->v[j]);
            }
        edges_met += ends.size();
        facets_met += others.size();
        std::sort(ends.begin(), ends.end());
        std::sort(others.begin(), others.end());
        const auto last_end = std::unique(ends.begin(), ends.end());
        std::for_each(ends.begin(), last_end, [&](std::uint32_t end) { sample.edges.push_back({v, end}); });
        for (std::size_t i = 0, same = 0; i < others.size(); i = same) {
            while (same < others.size() && others[same] == others[i]) ++same;
            const MeshSample::Facet facet{v, static_cast<std::uint32_t>(others[i] >> 32),
                                          static_cast<std::uint32_t>(others[i])};
            sample.facets.push_back(facet);
            if (same == i + 1) sample.boundary_facets.push_back(facet);
        }
    }
    const double proper = listed.tets == 0 ? 0
                                           : static_cast<double>(tets) * static_cast<double>(listed.proper) /
                                                 static_cast<double>(listed.tets);
    sample.edge_count = of_all(sample.edges.size(), edges_met, 6 * proper);
    sample.facet_count = of_all(sample.facets.size(), facets_met, 4 * proper);
    sample.boundary_facet_count = of_all(sample.boundary_facets.size(), facets_met, 4 * proper);
    keep(size.edges, sample.edges);
    keep(size.edges, sample.facets);
    keep(size.edges / 2, sample.boundary_facets);
    return sample;
}

} // namespace vox
