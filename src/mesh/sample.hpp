// Some tetrahedra, edges and facets of a mesh, and how many of each there are in all. Its geometry is
// estimated from them while it deforms. They depend on the topology alone, so they are chosen once.
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
        std::uint32_t tets; // that share it
    };
    struct Facet {
        std::array<std::uint32_t, 3> v;
        std::uint32_t tets;
    };

    // Spread evenly over the lists of all; all where there are few. None of a tetrahedron that is off, and no
    // edges and facets of one that names a vertex twice.
    Array<Tet> tets;
    Array<Edge> edges;
    Array<Facet> facets, boundary_facets;

    // Of all. Estimates, unless the edges and facets of all vertices were listed.
    std::uint64_t edge_count = 0, facet_count = 0, boundary_facet_count = 0;
    bool is_whole = false; // whether they were
    // As of unused_vertices() below, where they were asked for.
    Array<std::uint64_t> unused_vertices;
};

// How much of a mesh is listed and kept, about.
struct SampleSize {
    std::size_t vertices; // whose edges and facets are listed
    // Kept of what is listed; of boundary facets half as many.
    std::size_t tets, edges = std::numeric_limits<std::size_t>::max();
    bool unused_vertices = false; // whether to find them
};

// How many tetrahedra are looked at in a grid's scene of so many.
std::size_t sampled_tets(std::uint64_t tets) noexcept;
// What a mesh of a grid keeps: as many tetrahedra and edges.
SampleSize kept_sample(std::uint64_t tets) noexcept;

// `tiles` of a body without tetrahedra that are off, as they were made, save most of the time; the result is
// the same without. Throws what the memory throws.
MeshSample make_sample(const Body& body, const SampleSize& size, std::pmr::memory_resource* memory,
                       const Tiles* tiles = nullptr);

// By tetrahedra that are not off, as bits (bits.hpp). Empty: none; also where there are no such tetrahedra.
// `tiles` as above.
Array<std::uint64_t> unused_vertices(const Body& body, std::pmr::memory_resource* memory,
                                     const Tiles* tiles = nullptr);

// Whether a tetrahedron of a body, none of which is off, has a vertex. Looks first at those whose place in
// their list is that of the vertex in its own: numbers that are near in one are mostly near in the other, and
// where they are random, it takes a part of the list.
bool is_used(const Body& body, std::uint32_t vertex) noexcept;

} // namespace vox
