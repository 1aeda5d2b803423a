// What the depth stage prepares of a mesh's tetrahedra, once: neighbours of vertices, tetrahedra across
// facets, and the surface. Positions play no part in it.
//
// Tetrahedra that name a vertex twice have no edges and facets of their own, and doubled ones count once.
#pragma once

#include "../scene.hpp"

#include <array>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox::depth {

// The facets of a tetrahedron, facet i opposite corner i; counter-clockwise from outside when it is positive.
inline constexpr std::uint8_t facet_corners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

// A facet of one tetrahedron only, in the order of facet_corners of that tetrahedron.
struct Triangle {
    std::uint32_t v[3];
    std::uint32_t apex; // the tetrahedron's other vertex
};

struct Topology {
    explicit Topology(std::pmr::memory_resource* memory) noexcept
        : first_neighbour(memory), neighbours(memory), across(memory), triangles(memory), first_ring(memory),
          rings(memory) {}

    // What lies across a facet: a tetrahedron, or on the surface one of `triangles`, or where three or more
    // tetrahedra meet nothing that could be told.
    static constexpr std::uint32_t surface_bit = 0x80000000u;
    static constexpr std::uint32_t nothing = 0xffffffffu;

    // All empty for a mesh without tetrahedra.
    std::pmr::vector<std::uint32_t> first_neighbour;       // of each vertex in `neighbours`, and the end
    std::pmr::vector<std::uint32_t> neighbours;            // over edges, ascending
    std::pmr::vector<std::array<std::uint32_t, 4>> across; // of each tetrahedron's facets
    std::pmr::vector<Triangle> triangles;
    std::pmr::vector<std::uint32_t> first_ring; // of each vertex in `rings`, and the end
    std::pmr::vector<std::uint32_t> rings;      // the triangles around it, ascending

    std::span<const std::uint32_t> neighbours_of(std::uint32_t vertex) const noexcept {
        return list(first_neighbour, neighbours, vertex);
    }
    std::span<const std::uint32_t> ring_of(std::uint32_t vertex) const noexcept {
        return list(first_ring, rings, vertex);
    }

private:
    static std::span<const std::uint32_t> list(const std::pmr::vector<std::uint32_t>& first,
                                               const std::pmr::vector<std::uint32_t>& items,
                                               std::uint32_t i) noexcept {
        if (first.empty()) return {};
        return {items.data() + first[i], items.data() + first[i + 1]};
    }
};

// Throws std::bad_alloc (or what the memory throws) and leaves `out` as it was then.
void make_topology(std::span<const Tet> tets, std::uint32_t vertex_count, Topology& out);

} // namespace vox::depth
