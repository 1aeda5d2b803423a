// Some tetrahedra, edges and facets of a mesh, and how many it has of each. Its geometry is estimated from
// these while it deforms. They depend on the topology alone, so they are chosen once.
//
// Edges and facets are sampled by their lowest vertex (cluster sampling: W. G. Cochran, Sampling Techniques,
// 1977): those of some vertices are listed, all of them, each once, however many tetrahedra share it. That
// takes one pass over the tetrahedra, or over the tiles, and no list of all edges.
#pragma once

#include "base/array.hpp"
#include "base/scene.hpp"
#include "mesh/tiles.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>

namespace vox {

struct MeshSample {
    explicit MeshSample(std::pmr::memory_resource* memory)
        : tets(memory), edges(memory), facets(memory), boundary_facets(memory), unused_vertices(memory) {}

    struct Edge {
        std::array<std::uint32_t, 2> v;
        std::uint32_t tets; // how many share it
    };
    struct Facet {
        std::array<std::uint32_t, 3> v;
        std::uint32_t tets;
    };

    // Spread evenly over the lists of all; all if there are few. Without tetrahedra that are off, and without
    // edges and facets of those that name a vertex twice.
    Array<Tet> tets;
    Array<Edge> edges;
    Array<Facet> facets, boundary_facets;

    // Counts for the whole mesh: estimates, unless the edges and facets of all vertices were listed.
    std::uint64_t edge_count = 0, facet_count = 0, boundary_facet_count = 0;
    bool is_whole = false; // the counts are exact
    // unused_vertices() below, if requested.
    Array<std::uint64_t> unused_vertices;
};

// About how much of a mesh is listed and kept.
struct SampleSize {
    std::size_t vertices; // whose edges and facets are listed
    // How many of the listed ones are kept; half as many boundary facets.
    std::size_t tets, edges = std::numeric_limits<std::size_t>::max();
    bool unused_vertices = false; // whether to find them
};

// How many tetrahedra of a grid's scene are sampled.
std::size_t sampled_tets(std::uint64_t tets) noexcept;
// The sample of a mesh of a grid.
SampleSize kept_sample(std::uint64_t tets) noexcept;

// `tiles`, of a body without edits or tetrahedra that are off, save most of the time and do not change the
// result. Throws what the memory throws.
MeshSample make_sample(const Body& body, const SampleSize& size, std::pmr::memory_resource* memory,
                       const Tiles* tiles = nullptr);

// Vertices that no enabled tetrahedron uses, as bits (bits.hpp). Empty if there are none, or no enabled
// tetrahedra. `tiles` are as above.
Array<std::uint64_t> unused_vertices(const Body& body, std::pmr::memory_resource* memory,
                                     const Tiles* tiles = nullptr);

// True if a tetrahedron of a body has a vertex; no tetrahedron is off. Starts at the tetrahedra whose
// relative place in their list is that of the vertex in its own, as neighbours mostly have similar places.
bool is_used(const Body& body, std::uint32_t vertex) noexcept;

} // namespace vox
