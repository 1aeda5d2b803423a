// Neighbours of vertices, tetrahedra across facets, and the surface of a mesh, for depths and queries.
// Independent of positions. Made once, and repaired by edits.
//
// Tetrahedra that name a vertex twice have no edges and facets, and doubled ones count once.
#pragma once

#include "base/lists.hpp"
#include "base/scene.hpp"
#include "mesh/facets.hpp"
#include "mesh/vertex_links.hpp"

#include <array>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

struct TetChange;

// Empty for a mesh without tetrahedra.
struct Topology : MatchedFacets {
    explicit Topology(std::pmr::memory_resource* memory) noexcept : MatchedFacets(memory), links(memory) {}

    // For each vertex the neighbours over edges, and the triangles around it in the order of before().
    VertexLinks links;

    LinkRange neighbours_of(std::uint32_t vertex) const noexcept {
        return links.empty() ? LinkRange() : links.neighbours(vertex);
    }
    LinkRange ring_of(std::uint32_t vertex) const noexcept {
        return links.empty() ? LinkRange() : links.ring(vertex);
    }

    // The order of triangles by their sorted vertices, which does not depend on earlier edits.
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

// If it throws what the memory throws, `out` is unchanged.
void make_topology(std::span<const Tet> tets, std::uint32_t vertex_count, Topology& out);

// Appends vertices that are in no tetrahedron. Throws like repair_topology().
void add_vertices(std::uint32_t vertex_count, Topology& topology);

// Applies changes. `tets` and `tets_of`, which lists the tets at each vertex, are the state after them; tets
// that are off name a vertex twice. The result is that of make_topology(), except for the order of triangles.
// Throws what the memory throws; then the topology must be made again.
void repair_topology(std::span<const Tet> tets, const IndexLists& tets_of, std::span<const TetChange> changes,
                     Topology& topology);

} // namespace vox
