// Some tetrahedra, edges and boundary facets of a mesh, and how many of each there are in all. Its geometry
// is estimated from them while it deforms. They depend on the topology alone, so they are chosen once.
#pragma once

#include "base/scene.hpp"
#include "mesh/topology.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

struct MeshSample {
    explicit MeshSample(std::pmr::memory_resource* memory)
        : tets(memory), edges(memory), facets(memory), unused_vertices(memory) {}

    struct SampledTet {
        Tet tet;
        std::uint32_t shared; // bit i: another tet has facet i, opposite corner i, as well
        static constexpr std::uint32_t no_facets = 16; // it names a vertex twice
    };
    using Edge = std::array<std::uint32_t, 2>;
    using Facet = std::array<std::uint32_t, 3>;

    // Spread evenly over the lists of all; all where there are few.
    std::pmr::vector<SampledTet> tets; // none that is off
    std::pmr::vector<Edge> edges;
    std::pmr::vector<Facet> facets; // of the boundary

    // Of all.
    std::uint64_t edge_count = 0, boundary_facet_count = 0;
    // By tetrahedra, as bits (bits.hpp). Empty: none; also where there are no tetrahedra.
    std::pmr::vector<std::uint64_t> unused_vertices;
};

// How many tetrahedra are looked at in a scene of so many. A mesh alone keeps as many, and half as many
// boundary facets.
std::size_t sampled_tets(std::uint64_t tets) noexcept;

// `topology` is that of the tets. Throws what the memory throws.
MeshSample make_sample(const Body& body, const Topology& topology, std::pmr::memory_resource* memory);
// The same for a mesh without a topology: makes one for the time of the call.
MeshSample make_sample(const Body& body, std::pmr::memory_resource* memory);

} // namespace vox
