// The separating axes of boxes: the sides of either, and across a side of each (S. Gottschalk, M. C. Lin,
// D. Manocha, OBBTree, SIGGRAPH 1996, sec. 5). What is across the first axis is at least
// 2^-20 of what it is taken from, so that axes are at right angles to within 2^-30, and what rounding adds is
// less than 2^-24 of the largest coordinate.
#include "grid/oriented_box.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

namespace {

// Along an axis of length 1, or zero.
bool apart_along(const Vec3d& w, const OrientedBox& a, const OrientedBox& b, double reach) noexcept {
    return std::abs(dot(w, b.middle - a.middle)) > extent(a, w) + extent(b, w) + reach;
}

} // namespace

OrientedBox oriented_box(std::span<const Vec3d> points, const Vec3d& along) noexcept {
    OrientedBox box{};
    box.axis[0] = normalised(along);
    if (!(dot(box.axis[0], box.axis[0]) > 0)) box.axis[0] = {1, 0, 0};
    Vec3d across = cross(box.axis[0], std::abs(box.axis[0].x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0});
    double most = 0;
    for (const Vec3d& p : points) {
        const Vec3d from_first = p - points[0], c = cross(box.axis[0], from_first);
        const double squared = dot(c, c);
        if (!(squared > most) || !(squared > 0x1p-40 * dot(from_first, from_first))) continue;
        most = squared;
        across = c;
    }
    box.axis[1] = normalised(across);
    box.axis[2] = cross(box.axis[1], box.axis[0]);
    for (int i = 0; i < 3; ++i) {
        double low = 0, high = 0; // from the first point on
        for (const Vec3d& p : points) {
            const double at = dot(box.axis[i], p - points[0]);
            low = std::min(low, at);
            high = std::max(high, at);
        }
        box.half[i] = 0.5 * (high - low);
        box.middle = box.middle + 0.5 * (low + high) * box.axis[i];
    }
    box.middle = box.middle + points[0];
    return box;
}

bool apart_along_axes(const OrientedBox& a, const OrientedBox& b, double reach) noexcept {
    return apart_along(a.axis[0], a, b, reach) || apart_along(a.axis[1], a, b, reach) ||
           apart_along(a.axis[2], a, b, reach);
}

bool stay_apart(const OrientedBox& a, const OrientedBox& b, double reach) noexcept {
    if (apart_along_axes(a, b, reach) || apart_along_axes(b, a, reach)) return true;
    for (const Vec3d& u : a.axis)
        for (const Vec3d& v : b.axis)
            if (apart_along(normalised(cross(u, v)), a, b, reach)) return true;
    return false;
}

} // namespace vox
