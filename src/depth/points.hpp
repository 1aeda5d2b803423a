// The colliding vertices of a pair of bodies, which the parts of the depth stage hand on. A point is such a
// vertex, and what is known of it is its penetration, at the same place from the beginning.
#pragma once

#include "depth/penetrations.hpp"
#include "depth/walk.hpp"

#include <vox/vox.h>

#include <cstdint>
#include <span>

namespace vox::depth {

// Whether depth and direction of an ENCLOSED or CROSSING point are known.
inline bool has_answer(const Depth& depth) noexcept { return depth.depth > 0; }

// Vertices of body a in tetrahedra of body b.
struct BodyPair {
    const Topology* topology_a;
    Positions positions_a;
    std::uint32_t vertex_count_a;
    Solid b;
    bool self;
    std::span<const std::uint32_t> places; // of their penetrations, in the order of vertices
};

struct Counts {
    std::uint64_t leaving_edges = 0, edge_tests = 0, closest_tests = 0; // as in Counters
};

inline bool has_corner(const Triangle& triangle, std::uint32_t vertex) noexcept {
    return triangle.v[0] == vertex || triangle.v[1] == vertex || triangle.v[2] == vertex;
}

} // namespace vox::depth
