// Where a closed segment meets a closed triangle, decided as in infinite precision. The segment may be a
// point, the triangle a segment or a point. Coordinates are as in predicates.hpp.
#pragma once

#include "base/vectors.hpp"
#include "exact/predicates.hpp"

#include <array>
#include <cstdint>

namespace vox {

enum class CrossingKind : std::uint8_t {
    none,     // no point in common
    through,  // through the interior of the triangle, with an end on either side
    touching, // an end is on the triangle, or the segment passes through a side or a corner of it
    coplanar  // they lie in one plane and meet, or one of them is degenerate and they meet
};

// A common point of segment and triangle. If there are several, it is the first of these: the first end of
// the segment, its second end, a point of the first side ab, bc, ca that the segment meets.
struct Crossing {
    CrossingKind kind = CrossingKind::none; // if none, the rest is unspecified
    // In [0, 1], with the sum 1 up to rounding, and off by at most 2^-38. Zeros are exact.
    std::array<double, 2> edge_weights;
    std::array<double, 3> face_weights;
    Vec3d position; // rounded; at an end of the segment or a corner exactly that
};

// True if the line pq certainly has no point in common with the triangle abc: two of the volumes over its
// sides have opposite signs, which a line through the triangle excludes. Computed in doubles.
inline bool passes_beside(const Vec3d& p, const Vec3d& q, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d d = q - p, u = a - p, v = b - p, w = c - p;
    const Minor du = minor(d, u), dv = minor(d, v), dw = minor(d, w);
    const BoundedVolume sides[3] = {determinant(d.z, minor(u, v), u.z, dv, v.z, du),
                                    determinant(d.z, minor(v, w), v.z, dw, w.z, dv),
                                    determinant(d.z, minor(w, u), w.z, du, u.z, dw)};
    bool positive = false, negative = false;
    for (const BoundedVolume& side : sides) {
        positive |= side.volume > side.error;
        negative |= -side.volume > side.error;
    }
    return positive && negative;
}

// Finds the crossing of segment pq and triangle abc. `exact_tests` counts as in orientation().
Crossing find_crossing(const Vec3d& p, const Vec3d& q, const Vec3d& a, const Vec3d& b, const Vec3d& c,
                       std::uint64_t& exact_tests);

} // namespace vox
