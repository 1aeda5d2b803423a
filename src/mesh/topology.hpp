// What the depth stage prepares of a mesh's tetrahedra: neighbours of vertices, tetrahedra across facets, and
// the surface. Positions play no part in it. Made once, and repaired where the mesh is cut.
//
// Tetrahedra that name a vertex twice have no edges and facets of their own, and doubled ones count once.
#pragma once

#include "base/lists.hpp"
#include "base/scene.hpp"
#include "mesh/facets.hpp"
#include "mesh/tet_changes.hpp"

#include <array>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

// All empty for a mesh without tetrahedra.
struct Topology : MatchedFacets {
    explicit Topology(std::pmr::memory_resource* memory) noexcept
        : MatchedFacets(memory), neighbours(memory), rings(memory) {}

    IndexLists neighbours; // of each vertex, over edges, ascending
    IndexLists rings;      // of each vertex the triangles around it, in the order of before()

    std::span<const std::uint32_t> neighbours_of(std::uint32_t vertex) const noexcept {
        if (neighbours.empty()) return {};
        return neighbours[vertex];
    }
    std::span<const std::uint32_t> ring_of(std::uint32_t vertex) const noexcept {
        if (rings.empty()) return {};
        return rings[vertex];
    }

    // The order in which triangles count, whatever edits the mesh went through: by their vertices, sorted.
    bool before(std::uint32_t triangle, std::uint32_t other) const noexcept {
        return is_repaired ? key(triangle) < key(other) : triangle < other;
    }

    FacetKey key(std::uint32_t triangle) const noexcept {
        const std::uint32_t* v = triangles[triangle].v;
        return sorted_facet(v[0], v[1], v[2]).key;
    }
};

// Throws Error(LIMIT) for more than most_tets.
void check_tet_count(std::uint64_t tets);

// Throws std::bad_alloc (or what the memory throws) and leaves `out` as it was then.
void make_topology(std::span<const Tet> tets, std::uint32_t vertex_count, Topology& out);

// More vertices, at the end, that no tetrahedron names. Throws as repair_topology().
void add_vertices(std::uint32_t vertex_count, Topology& topology);

// Follows changes of the mesh, which is `tets` now, around each vertex `tets_of` it; those that are off name a
// vertex twice. As make_topology() but for the order of triangles. Throws what the memory throws, and is to be
// made anew then.
void repair_topology(std::span<const Tet> tets, const IndexLists& tets_of, std::span<const TetChange> changes,
                     Topology& topology);

} // namespace vox
