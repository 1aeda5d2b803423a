#include "mesh/sample.hpp"

#include "base/bits.hpp"
#include "base/sampling.hpp"
#include "base/simd.hpp"
#include "mesh/facets.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#undef VOX_SOURCE
#define VOX_SOURCE "mesh/sample.cpp"
#include "base/each_target.hpp"

#include "base/lanes-inl.hpp"

#ifndef VOX_MESH_SAMPLE_ONCE
#define VOX_MESH_SAMPLE_ONCE
namespace vox {

// Which vertices are chosen: those whose multiple of the golden ratio has a small enough fractional part, so
// that they are spread evenly over the numbering (H. Weyl, 1916), whatever pattern repeats in it.
struct ChosenVertices {
    std::uint32_t last; // of the fractional parts, in units of 2^-32

    static constexpr std::uint32_t factor = 0x9e3779b9u;
    static std::uint32_t part(std::uint32_t v) noexcept { return v * factor; }
    bool operator()(std::uint32_t v) const noexcept { return part(v) <= last; }
};

} // namespace vox
#endif

HWY_BEFORE_NAMESPACE();
namespace vox {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Writes at which places of a list there is a chosen vertex, and returns at how many.
std::size_t FindChosen(const std::uint32_t* HWY_RESTRICT list, std::size_t count,
                       const ChosenVertices& chosen, std::uint32_t* HWY_RESTRICT found) {
    const hn::CappedTag<std::uint32_t, 16> d;
    const std::size_t lanes = hn::Lanes(d);
    const auto factor = hn::Set(d, ChosenVertices::factor), last = hn::Set(d, chosen.last);
    std::size_t n = 0, i = 0;
    for (; i + lanes <= count; i += lanes) {
        const auto part = hn::Mul(hn::LoadU(d, list + i), factor);
        const auto is_chosen = hn::Eq(hn::Min(part, last), part); // part <= last
        for (std::uint64_t bits = BitsOfMask(d, is_chosen); bits != 0; bits &= bits - 1)
            found[n++] = static_cast<std::uint32_t>(i) + static_cast<std::uint32_t>(std::countr_zero(bits));
    }
    for (; i < count; ++i)
        if (chosen(list[i])) found[n++] = static_cast<std::uint32_t>(i);
    return n;
}

// A bit for each tetrahedron of a tile that has a vertex of the tile as a corner.
std::uint64_t TetsAt(std::uint8_t vertex, const std::uint8_t* HWY_RESTRICT corners) {
    const hn::CappedTag<std::uint8_t, 16> d;
    const std::size_t lanes = hn::Lanes(d);
    const auto wanted = hn::Set(d, vertex);
    std::uint64_t tets = 0;
    for (std::size_t t = 0; t < tile_size; t += lanes) {
        const auto is = [&](std::size_t corner) HWY_ATTR {
            return hn::Eq(hn::LoadU(d, corners + corner * tile_size + t), wanted);
        };
        tets |= BitsOfMask(d, hn::Or(hn::Or(is(0), is(1)), hn::Or(is(2), is(3)))) << t;
    }
    return tets;
}

} // namespace HWY_NAMESPACE
} // namespace vox
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {

std::size_t sampled_tets(std::uint64_t tets) noexcept {
    return static_cast<std::size_t>(std::clamp<std::uint64_t>(tets / 48, 96, 256));
}

SampleSize kept_sample(std::uint64_t tets) noexcept {
    const std::size_t kept = sampled_tets(tets);
    return {std::max<std::size_t>(kept / 6, 24), kept, kept, true};
}

namespace {

ChosenVertices choose_about(std::uint64_t wanted, std::uint64_t of) {
    if (wanted >= of) return {0xffffffffu};
    return {static_cast<std::uint32_t>(static_cast<double>(wanted) / static_cast<double>(of) * 0x1p32)};
}

// The corners of a tetrahedron above its chosen vertex.
struct Above {
    std::uint32_t vertex;
    std::uint32_t count; // 1 to 3
    std::uint32_t v[4];
};

// The parts of a mesh at chosen vertices.
struct Listed {
    explicit Listed(std::pmr::memory_resource* memory) : above(memory) {}

    void clear() {
        above.clear();
        corners = proper = 0;
    }
    void add(std::uint32_t vertex, const Tet& tet) {
        if (names_a_vertex_twice(tet)) {
            corners += static_cast<std::uint64_t>(std::count(tet.v, tet.v + 4, vertex));
            return;
        }
        ++corners;
        ++proper;
        Above next{vertex, 0, {}};
        for (const std::uint32_t other : tet.v) {
            next.v[next.count] = other;
            next.count += other > vertex;
        }
        if (next.count > 0) above.push_back(next);
    }

    Array<Above> above;
    // Corners that are chosen vertices: of all tetrahedra, and of those that name no vertex twice.
    std::uint64_t corners = 0, proper = 0;
};

constexpr std::size_t at_once = 4096; // vertices

// Finds the tetrahedra around chosen vertices.
void list_around(const Body& body, const ChosenVertices& chosen, Listed& out) {
    const auto find = VOX_SIMD_DISPATCH(FindChosen);
    std::array<std::uint32_t, at_once> found;
    for (std::size_t first = 0; first < body.tets.size(); first += at_once / 4) {
        const std::size_t count = std::min(at_once / 4, body.tets.size() - first);
        const Tet* tets = body.tets.data() + first;
        const std::size_t found_count = find(tets->v, 4 * count, chosen, found.data());
        for (std::size_t i = 0; i < found_count; ++i) {
            const std::size_t t = found[i] / 4, corner = found[i] % 4;
            const std::uint32_t* v = tets[t].v;
            if (!has_bit(body.off, first + t) && std::find(v, v + corner, v[corner]) == v + corner)
                out.add(v[corner], tets[t]);
        }
    }
}

// Does so by tiles: these have fewer vertices than tetrahedra have corners, close together in memory.
void list_around(const Tiles& tiles, const ChosenVertices& chosen, Listed& out) {
    const auto find = VOX_SIMD_DISPATCH(FindChosen);
    const auto tets_at = VOX_SIMD_DISPATCH(TetsAt);
    std::array<std::uint32_t, at_once> found;
    const std::span<const std::uint32_t> all = tiles.vertices;
    auto tile = tiles.tiles.begin();
    for (std::size_t first = 0; first < all.size(); first += at_once) {
        const std::size_t found_count =
            find(all.data() + first, std::min(at_once, all.size() - first), chosen, found.data());
        for (std::size_t i = 0; i < found_count; ++i) {
            const std::size_t place = first + found[i];
            while (tile + 1 != tiles.tiles.end() && place >= (tile + 1)->first_vertex) ++tile;
            const std::size_t own = place - tile->first_vertex;
            if (own >= tile->vertex_count) continue; // padding
            const std::uint8_t* corners =
                tiles.corners_of(static_cast<std::size_t>(tile - tiles.tiles.begin()));
            std::uint64_t tets = tets_at(static_cast<std::uint8_t>(own), corners) & tile->all_tets();
            for (; tets != 0; tets &= tets - 1) {
                const auto t = static_cast<std::uint32_t>(std::countr_zero(tets));
                Tet tet;
                for (std::uint32_t c = 0; c < 4; ++c)
                    tet.v[c] = all[tile->first_vertex + corners[c * tile_size + t]];
                out.add(all[place], tet);
            }
        }
    }
}

// A byte for each vertex: 1 where a tetrahedron has it.
Array<std::uint8_t> used_vertices(const Body& body, std::pmr::memory_resource* memory, const Tiles* tiles) {
    Array<std::uint8_t> used(body.vertex_count, 0, memory);
    std::uint8_t* const mark = used.data(); // else it is read anew after each byte, which might be part of it
    if (tiles) {                            // which name a vertex less often
        const std::uint32_t *v = tiles->vertices.data(), *const end = v + tiles->vertices.size();
        for (; end - v >= 4; v += 4) mark[v[0]] = mark[v[1]] = mark[v[2]] = mark[v[3]] = 1;
        for (; v != end; ++v) mark[*v] = 1;
        return used;
    }
    for (std::size_t t = 0; t < body.tets.size(); ++t)
        if (!has_bit(body.off, t))
            for (const std::uint32_t v : body.tets[t].v) mark[v] = 1;
    return used;
}

// By counting, where the list is not much shorter than what would be counted. The order at a vertex is free.
void sort_by_vertex(std::uint32_t vertex_count, Array<Above>& list) {
    if (list.size() < vertex_count / 16) {
        std::sort(list.begin(), list.end(),
                  [](const Above& a, const Above& b) { return a.vertex < b.vertex; });
        return;
    }
    std::pmr::memory_resource* memory = list.memory();
    Array<std::uint32_t> place(std::size_t{vertex_count} + 1, 0, memory);
    for (const Above& above : list) ++place[std::size_t{above.vertex} + 1];
    for (std::size_t v = 0; v < vertex_count; ++v) place[v + 1] += place[v];
    Array<Above> sorted(list.size(), memory);
    for (const Above& above : list) sorted[place[above.vertex]++] = above;
    list = std::move(sorted);
}

template <class Item>
void keep(std::size_t wanted, Array<Item>& items) {
    if (items.size() <= wanted) return;
    std::size_t kept = 0;
    for_stratified(items.size(), wanted, 0.5,
                   [&](std::uint64_t i) { items[kept++] = items[static_cast<std::size_t>(i)]; });
    items.resize(kept);
    items.shrink_to_fit();
}

// Calls visit(item, how often) for each item of a sorted list.
template <class Item, class Visit>
void for_equal(const Array<Item>& items, Visit&& visit) {
    for (std::size_t i = 0, end = 0; i < items.size(); i = end) {
        while (end < items.size() && items[end] == items[i]) ++end;
        visit(items[i], static_cast<std::uint32_t>(end - i));
    }
}

// Counts of all from those of a part: how often tetrahedra have what was listed, against how often they have
// any. Exact where everything was listed.
std::uint64_t of_all(std::uint64_t listed, std::uint64_t met, double met_in_all) {
    return met == 0 ? 0
                    : static_cast<std::uint64_t>(std::llround(static_cast<double>(listed) *
                                                              (met_in_all / static_cast<double>(met))));
}

} // namespace

Array<std::uint64_t> unused_vertices(const Body& body, std::pmr::memory_resource* memory,
                                     const Tiles* tiles) {
    Array<std::uint64_t> unused(memory);
    if (body.tets.size() == body.off_count) return unused;
    const auto used = used_vertices(body, memory, tiles);
    if (std::find(used.begin(), used.end(), 0) == used.end()) return unused;
    unused.resize((used.size() + 63) / 64);
    for (std::size_t v = 0; v < used.size(); ++v)
        if (!used[v]) unused[v / 64] |= std::uint64_t{1} << v % 64;
    return unused;
}

bool is_used(const Body& body, std::uint32_t vertex) noexcept {
    constexpr std::size_t part = 256; // tetrahedra, looked at without a branch
    const std::size_t parts = (body.tets.size() + part - 1) / part;
    const auto has = [&](std::size_t p) {
        const std::size_t first = p * part, last = std::min(first + part, body.tets.size());
        std::uint32_t found = 0;
        for (std::size_t t = first; t < last; ++t)
            for (const std::uint32_t v : body.tets[t].v) found |= v == vertex;
        return found != 0;
    };
    const std::size_t guess = std::size_t{vertex} * parts / body.vertex_count;
    for (std::size_t away = 0; away < parts; ++away) {
        if (guess >= away && has(guess - away)) return true;
        if (away > 0 && guess + away < parts && has(guess + away)) return true;
    }
    return false;
}

MeshSample make_sample(const Body& body, const SampleSize& size, std::pmr::memory_resource* memory,
                       const Tiles* tiles) {
    MeshSample sample(memory);
    const std::uint64_t tets = body.tets.size() - body.off_count;
    if (tets == 0) return sample;
    if (size.unused_vertices) sample.unused_vertices = unused_vertices(body, memory, tiles);
    for_stratified(body.tets.size(), size.tets, 0.5, [&](std::uint64_t t) {
        if (!has_bit(body.off, t)) sample.tets.push_back(body.tets[static_cast<std::size_t>(t)]);
    });

    Listed listed(memory);
    std::uint64_t vertices = body.vertex_count;
    const auto list = [&] {
        const ChosenVertices chosen = choose_about(size.vertices, vertices);
        sample.is_whole = chosen.last == 0xffffffffu;
        listed.clear();
        if (tiles)
            list_around(*tiles, chosen, listed);
        else
            list_around(body, chosen, listed);
    };
    list();
    // Where tetrahedra use few of the vertices, too few may have been chosen.
    const auto too_few = [&] {
        return listed.corners < std::min<std::uint64_t>(size.vertices, tets) && vertices > 1;
    };
    if (too_few()) {
        const auto used = used_vertices(body, memory, tiles);
        const auto used_count = static_cast<std::uint64_t>(std::count(used.begin(), used.end(), 1));
        do {
            vertices = std::min(used_count, vertices / 4 + 1);
            list();
        } while (too_few());
    }
    sort_by_vertex(body.vertex_count, listed.above);

    std::uint64_t edges_met = 0, facets_met = 0;
    Array<std::uint32_t> ends(memory);
    Array<std::uint64_t> others(memory); // of a facet: the middle vertex << 32 | the highest one
    for (auto first = listed.above.begin(); first != listed.above.end();) {
        const std::uint32_t v = first->vertex;
        ends.clear();
        others.clear();
        for (; first != listed.above.end() && first->vertex == v; ++first)
            for (std::uint32_t i = 0; i < first->count; ++i) {
                ends.push_back(first->v[i]);
                for (std::uint32_t j = i + 1; j < first->count; ++j) {
                    const auto [middle, highest] = std::minmax(first->v[i], first->v[j]);
                    others.push_back(std::uint64_t{middle} << 32 | highest);
                }
            }
        edges_met += ends.size();
        facets_met += others.size();
        std::sort(ends.begin(), ends.end());
        std::sort(others.begin(), others.end());
        for_equal(ends, [&](std::uint32_t end, std::uint32_t tets_there) {
            sample.edges.push_back({{v, end}, tets_there});
        });
        for_equal(others, [&](std::uint64_t two, std::uint32_t tets_there) {
            sample.facets.push_back(
                {{v, static_cast<std::uint32_t>(two >> 32), static_cast<std::uint32_t>(two)}, tets_there});
            if (tets_there == 1) sample.boundary_facets.push_back(sample.facets.back());
        });
    }
    const double proper = listed.corners == 0
                              ? 0
                              : static_cast<double>(tets) * static_cast<double>(listed.proper) /
                                    static_cast<double>(listed.corners);
    sample.edge_count = of_all(sample.edges.size(), edges_met, 6 * proper);
    sample.facet_count = of_all(sample.facets.size(), facets_met, 4 * proper);
    sample.boundary_facet_count = of_all(sample.boundary_facets.size(), facets_met, 4 * proper);
    keep(size.edges, sample.edges);
    keep(size.edges, sample.facets);
    keep(size.edges / 2, sample.boundary_facets);
    return sample;
}

} // namespace vox
#endif
