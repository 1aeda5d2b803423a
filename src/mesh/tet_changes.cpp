#include "mesh/tet_changes.hpp"

#include "base/bits.hpp"

#include <algorithm>
#include <utility>

namespace vox {

void list_tets(std::span<const Tet> tets, std::span<const std::uint64_t> off, std::uint32_t vertex_count,
               IndexLists& tets_of) {
    IndexLists made(tets_of.memory());
    std::uint32_t corners[4];
    made.list_by_vertex(static_cast<std::uint32_t>(tets.size()), vertex_count, [&](std::uint32_t t) {
        std::size_t count = 0;
        if (!has_bit(off, t)) for_corners(tets[t], [&](std::uint32_t v) { corners[count++] = v; });
        return std::span<const std::uint32_t>(corners, count);
    });
    tets_of = std::move(made);
}

void apply_changes(std::span<const TetChange> changes, IndexLists& tets_of) {
    for (const TetChange& change : changes) {
        if (change.was_on)
            for_corners(change.before, [&](std::uint32_t v) { tets_of.remove(v, change.tet); });
        if (change.is_on) for_corners(change.after, [&](std::uint32_t v) { tets_of.add(v, change.tet); });
    }
}

namespace {

template <class T>
void sort_each_once(Array<T>& items) {
    std::sort(items.begin(), items.end());
    items.erase(std::unique(items.begin(), items.end()), items.end());
}

} // namespace

void list_changed_facets(std::span<const TetChange> changes, Array<FacetKey>& facets) {
    facets.clear();
    facets.reserve(8 * changes.size());
    const auto add = [&](const Tet& tet) {
        if (names_a_vertex_twice(tet)) return;
        for (int i = 0; i < 4; ++i)
            facets.push_back(sorted_facet(tet.v[(i + 1) % 4], tet.v[(i + 2) % 4], tet.v[(i + 3) % 4]).key);
    };
    for (const TetChange& change : changes) {
        if (change.was_on) add(change.before);
        if (change.is_on) add(change.after);
    }
    sort_each_once(facets);
}

void list_changed_vertices(std::span<const TetChange> changes, Array<std::uint32_t>& vertices) {
    vertices.clear();
    vertices.reserve(8 * changes.size());
    for (const TetChange& change : changes) {
        if (change.was_on) vertices.insert(vertices.end(), change.before.v, change.before.v + 4);
        if (change.is_on) vertices.insert(vertices.end(), change.after.v, change.after.v + 4);
    }
    sort_each_once(vertices);
}

} // namespace vox
