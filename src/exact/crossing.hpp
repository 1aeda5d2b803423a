// Where a closed segment meets a closed triangle, decided as in infinite precision. Either may be degenerate:
// a segment of no length, a triangle that is a segment or a point. Coordinates as in predicates.hpp.
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

// Whether the line pq certainly has no point in common with the triangle abc: two of the volumes over its
// sides have opposite signs, which those of a line through the triangle never have. In doubles alone.
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

// The segment pq and the triangle abc. `exact_tests` counts as that of orientation().
Crossing find_crossing(const Vec3d& p, const Vec3d& q, const Vec3d& a, const Vec3d& b, const Vec3d& c,
                       std::uint64_t& exact_tests);

} // namespace vox
