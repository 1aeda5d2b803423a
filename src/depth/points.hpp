// The colliding vertices of a pair of bodies, which the parts of the depth stage hand on.
#pragma once

#include "depth/walk.hpp"

#include <vox/vox.h>

#include <cstddef>
#include <cstdint>

namespace vox::depth {

constexpr std::uint32_t no_triangle = 0xffffffffu;

// A colliding vertex of one body, and what is found for it: a cache line, since neighbours look at it.
struct alignas(64) Point {
    double depth = 0;
    Vec3d direction{0, 0, 0};
    std::uint32_t vertex;
    std::uint32_t tet;                   // of the hit
    std::uint32_t hit;                   // the first hit of the pair with this vertex
    std::uint32_t place;                 // index of its penetration
    std::uint32_t closest = no_triangle; // the triangle of b's surface that was found to be closest
    vox_penetration_state state = VOX_PENETRATION_ENCLOSED;
    bool interior; // certainly in the interior of `tet`; else it may be on its boundary
};
static_assert(sizeof(Point) == 64);

// Whether depth and direction of an ENCLOSED or CROSSING point are known.
inline bool has_answer(const Point& point) noexcept { return point.depth > 0; }

// Vertices of body a in tetrahedra of body b.
struct BodyPair {
    const Topology* topology_a;
    Positions positions_a;
    std::uint32_t vertex_count_a;
    Solid b;
    bool self;
};

struct Counts {
    std::uint64_t leaving_edges = 0, edge_tests = 0, closest_tests = 0; // as in vox_counters
};

inline bool has_corner(const Triangle& triangle, std::uint32_t vertex) noexcept {
    return triangle.v[0] == vertex || triangle.v[1] == vertex || triangle.v[2] == vertex;
}

} // namespace vox::depth
