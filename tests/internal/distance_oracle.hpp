// Distances of features in long double, the slow way: the least of all candidates.
#pragma once

#include "base/scene.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vox::test {

struct Long3 {
    long double x, y, z;
    Long3 operator+(const Long3& o) const { return {x + o.x, y + o.y, z + o.z}; }
    Long3 operator-(const Long3& o) const { return {x - o.x, y - o.y, z - o.z}; }
    Long3 operator*(long double s) const { return {x * s, y * s, z * s}; }
};
inline Long3 longer(const Vec3d& v) { return {v.x, v.y, v.z}; }
inline long double dot(const Long3& a, const Long3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Long3 cross(const Long3& a, const Long3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline long double norm(const Long3& a) { return std::sqrt(dot(a, a)); }

inline long double to_segment(const Long3& p, const Long3& a, const Long3& b) {
    const Long3 d = b - a;
    const long double dd = dot(d, d);
    const long double t = dd > 0 ? std::clamp(dot(p - a, d) / dd, 0.0L, 1.0L) : 0;
    return norm(p - a - d * t);
}

inline long double oracle_distance(const std::vector<Long3>& a, const std::vector<Long3>& b) {
    if (a.size() < b.size()) return oracle_distance(b, a);
    if (a.size() == 1) return norm(a[0] - b[0]);
    if (a.size() == 2 && b.size() == 1) return to_segment(b[0], a[0], a[1]);
    if (a.size() == 3) {
        const Long3 p = b[0];
        long double least =
            std::min({to_segment(p, a[0], a[1]), to_segment(p, a[1], a[2]), to_segment(p, a[2], a[0])});
        const Long3 n = cross(a[1] - a[0], a[2] - a[0]);
        const long double nn = dot(n, n);
        if (nn > 0) {
            const long double v = dot(cross(p - a[0], a[2] - a[0]), n) / nn,
                              w = dot(cross(a[1] - a[0], p - a[0]), n) / nn;
            if (v >= 0 && w >= 0 && v + w <= 1)
                least = std::min(least, norm(p - a[0] - (a[1] - a[0]) * v - (a[2] - a[0]) * w));
        }
        for (std::size_t i = 0; i < 3; ++i) { // along an edge and across it: right for slivers, too
            const Long3 d = a[(i + 1) % 3] - a[i], e = a[(i + 2) % 3] - a[i], r = p - a[i];
            const long double s = dot(e, d) / dot(d, d), t = dot(r, d) / dot(d, d);
            const Long3 across = e - d * s, away = r - d * t;
            const long double share = dot(away, across) / dot(across, across);
            if (share >= 0 && t - share * s >= 0 && 1 - t + share * s - share >= 0)
                least = std::min(least, norm(away - across * share));
        }
        return least;
    }
    long double least = std::min({to_segment(a[0], b[0], b[1]), to_segment(a[1], b[0], b[1]),
                                  to_segment(b[0], a[0], a[1]), to_segment(b[1], a[0], a[1])});
    const Long3 d = a[1] - a[0], e = b[1] - b[0], r = a[0] - b[0];
    const Long3 n = cross(d, e);
    const long double nn = dot(n, n);
    if (nn > 0) { // of the points where the lines are closest
        const long double s = dot(cross(e, r), n) / nn, t = dot(cross(d, r), n) / nn;
        if (s >= 0 && s <= 1 && t >= 0 && t <= 1) least = std::min(least, norm(r + d * s - e * t));
    }
    return least;
}

} // namespace vox::test
