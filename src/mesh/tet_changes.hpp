// How an edit changes tetrahedra, and which facets and vertices it touches. Prepared data is repaired only
// there.
#pragma once

#include "base/array.hpp"
#include "base/lists.hpp"
#include "base/scene.hpp"
#include "mesh/facets.hpp"

#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

// A tetrahedron before and after a change. An edit is a sequence of changes; a tetrahedron may occur twice in
// it.
struct TetChange {
    std::uint32_t tet;
    bool was_on, is_on;
    Tet before, after; // valid if was_on and if is_on
};

// Calls function(vertex) for each different corner of a tetrahedron.
template <class Function>
void for_corners(const Tet& tet, Function&& function) {
    for (int i = 0; i < 4; ++i) {
        bool again = false;
        for (int j = 0; j < i; ++j) again |= tet.v[i] == tet.v[j];
        if (!again) function(tet.v[i]);
    }
}

// Lists the enabled tetrahedra at each vertex, in any order.
void list_tets(std::span<const Tet> tets, std::span<const std::uint64_t> off, std::uint32_t vertex_count,
               IndexLists& tets_of);
// Throws what the memory throws; then `tets_of` must be made again.
void apply_changes(std::span<const TetChange> changes, IndexLists& tets_of);

// The facets, and the vertices, of the tetrahedra that changed, before and after. Sorted, each once.
void list_changed_facets(std::span<const TetChange> changes, Array<FacetKey>& facets);
void list_changed_vertices(std::span<const TetChange> changes, Array<std::uint32_t>& vertices);

// Calls function(tet, i) for each tetrahedron whose facet i is `key`.
template <class Function>
void for_tets_at(const FacetKey& key, std::span<const Tet> tets, const IndexLists& tets_of,
                 Function&& function) {
    std::span<const std::uint32_t> around = tets_of[key.low];
    for (const std::uint32_t v : {key.middle, key.high})
        if (tets_of[v].size() < around.size()) around = tets_of[v];
    for (const std::uint32_t t : around) {
        const Tet& tet = tets[t];
        if (names_a_vertex_twice(tet)) continue;
        int shared = 0, opposite = 0;
        for (int i = 0; i < 4; ++i) {
            const bool is_corner = tet.v[i] == key.low || tet.v[i] == key.middle || tet.v[i] == key.high;
            shared += is_corner;
            if (!is_corner) opposite = i;
        }
        if (shared == 3) function(t, static_cast<std::uint32_t>(opposite));
    }
}

} // namespace vox
