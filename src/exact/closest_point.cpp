#include "exact/closest_point.hpp"

#include "base/vectors.hpp"

#include <algorithm>

namespace vox {

namespace {

// The closest point, as a fraction in [0, 1] of the way from a to b.
double closest_on_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) noexcept {
    const Vec3d ab = b - a;
    const double length = dot(ab, ab);
    return length > 0 ? std::clamp(dot(p - a, ab) / length, 0.0, 1.0) : 0;
}

} // namespace

ClosestPoint closest_on_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) noexcept {
    const auto squared = [](const Vec3d& d) { return dot(d, d); };
    const Vec3d corner[3] = {a, b, c};
    const Vec3d normal = cross(b - a, c - a);
    const double area = dot(normal, normal);
    if (area > 0) {
        // Areas of the triangles that the projection of p makes with the edges, divided by the whole area.
        double weight[3];
        for (int i = 0; i < 3; ++i) {
            const Vec3d &from = corner[(i + 1) % 3], &to = corner[(i + 2) % 3];
            weight[i] = dot(cross(to - from, p - from), normal) / area;
        }
        if (weight[0] >= 0 && weight[1] >= 0 && weight[2] >= 0) {
            const double height = dot(p - a, normal);
            const double squared = height * height;
            constexpr double small = 0x1p-900; // below it, digits are lost
            return {squared > small ? squared / area : height * (height / area),
                    {weight[0], weight[1], weight[2]}};
        }
    }
    ClosestPoint best{};
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const double t = closest_on_segment(p, corner[i], corner[j]);
        const double distance = squared(p - (corner[i] + t * (corner[j] - corner[i])));
        if (i > 0 && !(distance < best.squared_distance)) continue;
        best = {distance, {0, 0, 0}};
        best.weight[i] = 1 - t;
        best.weight[j] = t;
    }
    return best;
}

SeenPoint closest_seen_from(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) noexcept {
    const Vec3d from_p[3] = {a - p, b - p, c - p};
    const ClosestPoint at = closest_on_triangle({0, 0, 0}, from_p[0], from_p[1], from_p[2]);
    return {at, at.weight[0] * from_p[0] + at.weight[1] * from_p[1] + at.weight[2] * from_p[2]};
}

} // namespace vox
