// The distance of a face and a vertex, or of two edges, by another way than the library's.
#pragma once

#include "base/vectors.hpp"
#include "exact/closest_point.hpp"

#include <algorithm>
#include <cmath>

namespace vox::test {

inline double from_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
    return std::sqrt(closest_on_triangle(p, a, b, b).squared_distance);
}

// Of the face of the first three corners and the fourth, or of the edges of the first two and the last two.
inline double feature_distance(const Vec3d (&p)[4], bool edges) {
    if (!edges) return std::sqrt(closest_on_triangle(p[3], p[0], p[1], p[2]).squared_distance);
    double least = std::min({from_segment(p[0], p[2], p[3]), from_segment(p[1], p[2], p[3]),
                             from_segment(p[2], p[0], p[1]), from_segment(p[3], p[0], p[1])});
    // Between their insides: the distance of the two lines, where the feet are inside.
    const Vec3d u = p[1] - p[0], v = p[3] - p[2], w = p[0] - p[2], n = cross(u, v);
    const double nn = dot(n, n);
    if (nn > 1e-18 * dot(u, u) * dot(v, v)) {
        const double s = dot(cross(v, w), n) / nn, t = dot(cross(u, w), n) / nn;
        if (s >= 0 && s <= 1 && t >= 0 && t <= 1)
            least = std::min(least, std::abs(dot(w, n)) / std::sqrt(nn));
    }
    return least;
}

} // namespace vox::test
