// Where a closed segment meets a closed triangle, decided as in infinite precision. Either may be degenerate:
// a segment of no length, a triangle that is a segment or a point. Coordinates as in predicates.hpp.
#pragma once

#include "base/scene.hpp"

#include <array>
#include <cstdint>

namespace vox {

enum class CrossingKind : std::uint8_t {
    none,     // no point in common
    through,  // through the interior of the triangle, with an end on either side
    touching, // an end is on the triangle, or the segment passes through a side or a corner of it
    coplanar  // they lie in one plane and meet, or one of them is degenerate and they meet
};

// A point that both have in common. Of several it is the first of these: an end of the segment, the first
// one first, or else a point of the first side ab, bc, ca that the segment meets.
struct Crossing {
    CrossingKind kind = CrossingKind::none; // the rest is unspecified where it is none
    // In [0, 1], with the sum 1 up to rounding, and within 2^-38 of those of the point. One that is zero is
    // exactly zero.
    std::array<double, 2> edge_weights;
    std::array<double, 3> face_weights;
    Vec3d position; // rounded; at an end of the segment or a corner exactly that
};

// The segment pq and the triangle abc. `exact_tests` counts as that of orientation().
Crossing find_crossing(const Vec3d& p, const Vec3d& q, const Vec3d& a, const Vec3d& b, const Vec3d& c,
                       std::uint64_t& exact_tests);

} // namespace vox
