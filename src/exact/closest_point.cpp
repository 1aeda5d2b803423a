#include "exact/closest_point.hpp"

#include "base/vectors.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

namespace {

// The closest point, as a fraction in [0, 1] of the way from a to b.
double closest_on_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) noexcept {
    const Vec3d ab = b - a;
    const double length = dot(ab, ab);
    return length > 0 ? std::clamp(dot(p - a, ab) / length, 0.0, 1.0) : 0;
}

// The power of two by which to enlarge a triangle and the distance to p, so that its area does not underflow;
// as far as p allows. 0 if the triangle is not that small.
int enlargement(const Vec3d& ap, const Vec3d& ab, const Vec3d& ac) noexcept {
    const double size = std::max(largest_coordinate(ab), largest_coordinate(ac)),
                 reach = largest_coordinate(ap);
    if (!(size > 0 && size < 0x1p-200)) return 0;
    return std::max(0, std::min(-std::ilogb(size), reach > 0 ? 300 - std::ilogb(reach) : 2000));
}

} // namespace

ClosestPoint closest_on_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) noexcept {
    constexpr double small = 0x1p-900; // squares and products below it lose digits
    const auto squared = [](const Vec3d& d) { return dot(d, d); };
    const Vec3d corner[3] = {a, b, c};
    const Vec3d normal = cross(b - a, c - a);
    const double area = dot(normal, normal);
    if (area > small) {
        // Areas of the triangles that the projection of p makes with the edges, divided by the whole area.
        // They add up to 1, unless the triangle is so thin that its normal is lost in rounding. Its height is
        // less than 2^-24 of its length then, and the edges are close enough.
        double weight[3];
        for (int i = 0; i < 3; ++i) {
            const Vec3d &from = corner[(i + 1) % 3], &to = corner[(i + 2) % 3];
            weight[i] = dot(cross(to - from, p - from), normal) / area;
        }
        if (weight[0] >= 0 && weight[1] >= 0 && weight[2] >= 0 &&
            std::abs(weight[0] + weight[1] + weight[2] - 1) < 0x1p-26) {
            const double squared_length = squared(b - a) + squared(c - a);
            const double height = dot(p - a, normal);
            // In a triangle thinner than 2^-45 of its length, `height` is mostly rounding error.
            if (area > 0x1p-90 * (squared_length * squared_length))
                return {height * height > small ? height * height / area : height * (height / area),
                        {weight[0], weight[1], weight[2]}};
        }
    } else if (const int powers = enlargement(p - a, b - a, c - a); powers > 0) {
        ClosestPoint found = closest_on_triangle(times_power(p - a, powers), {0, 0, 0},
                                                 times_power(b - a, powers), times_power(c - a, powers));
        found.squared_distance = std::ldexp(found.squared_distance, -2 * powers);
        return found;
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
