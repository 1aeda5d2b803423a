#include "mesh/sample.hpp"

#include "base/bits.hpp"
#include "base/sampling.hpp"
#include "mesh/check.hpp"

#include <algorithm>
#include <iterator>

namespace vox {

std::size_t sampled_tets(std::uint64_t tets) noexcept {
    return static_cast<std::size_t>(std::clamp<std::uint64_t>(tets / 48, 96, 256));
}

MeshSample make_sample(const Body& body, const Topology& topology, std::pmr::memory_resource* memory) {
    MeshSample sample(memory);
    const std::size_t wanted = sampled_tets(body.tets.size());
    for_stratified(body.tets.size(), wanted, 0.5, [&](std::uint64_t t) {
        if (has_bit(body.off, t)) return;
        std::uint32_t shared = 0;
        for (std::uint32_t f = 0; f < 4; ++f) {
            const std::uint32_t across = topology.across(static_cast<std::uint32_t>(t), f);
            // Where three or more tetrahedra meet, `across` names none of them.
            const bool own = across != Topology::nothing && (across & Topology::surface_bit) != 0;
            shared |= std::uint32_t{!own} << f;
        }
        if (names_a_vertex_twice(body.tets[t])) shared = MeshSample::SampledTet::no_facets;
        sample.tets.push_back({body.tets[t], shared});
    });

    std::uint64_t ends = 0; // each edge has two
    for (std::uint32_t v = 0; v < body.vertex_count; ++v) {
        const std::size_t count = topology.neighbours_of(v).size();
        ends += count;
        if (count > 0 || body.tets.empty()) continue;
        sample.unused_vertices.resize((std::size_t{body.vertex_count} + 63) / 64);
        sample.unused_vertices[v / 64] |= std::uint64_t{1} << v % 64;
    }
    sample.edge_count = ends / 2;
    std::uint32_t v = 0;
    std::uint64_t before = 0; // ends at the vertices before v
    for_stratified(ends, wanted, 0.5, [&](std::uint64_t end) {
        while (end >= before + topology.neighbours_of(v).size()) before += topology.neighbours_of(v++).size();
        sample.edges.push_back(
            {v, *std::next(topology.neighbours_of(v).begin(), static_cast<std::ptrdiff_t>(end - before))});
    });

    sample.boundary_facet_count = topology.triangles.size();
    for_stratified(topology.triangles.size(), wanted / 2, 0.5, [&](std::uint64_t i) {
        const std::uint32_t* corners = topology.triangles[static_cast<std::size_t>(i)].v;
        sample.facets.push_back({corners[0], corners[1], corners[2]});
    });
    return sample;
}

MeshSample make_sample(const Body& body, std::pmr::memory_resource* memory) {
    Topology topology(memory);
    make_topology(body.tets, body.vertex_count, topology);
    return make_sample(body, topology, memory);
}

} // namespace vox
