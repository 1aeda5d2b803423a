#include "exact/closest_point.hpp"

#include "base/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

constexpr ClosestPoint nowhere{std::numeric_limits<double>::infinity(), {1, 0, 0}};

// The height over a triangle is off by rounding errors of its length, times length over thickness. Of one
// that is thinner than that, squared, the longest edge and what is across it do better.
constexpr double squared_thinness = 0x1p-12;

// The point in the interior that is closest to p, by its place along the longest edge and across it: off by
// rounding errors of the length, however thin the triangle. `nowhere` if it is not in the interior.
ClosestPoint closest_in_thin(const Vec3d& p, const Vec3d (&corner)[3]) noexcept {
    int first = 0;
    double longest = -1;
    for (int i = 0; i < 3; ++i) {
        const Vec3d edge = corner[(i + 1) % 3] - corner[i];
        if (!(dot(edge, edge) > longest)) continue;
        longest = dot(edge, edge);
        first = i;
    }
    const int second = (first + 1) % 3, third = (first + 2) % 3;
    const Vec3d edge = corner[second] - corner[first], other = corner[third] - corner[first],
                way = p - corner[first];
    const double along = dot(way, edge) / longest, foot = dot(other, edge) / longest;
    const Vec3d across = other - foot * edge, away = way - along * edge;
    const double thickness = dot(across, across), share = dot(away, across) / thickness;
    ClosestPoint found = nowhere;
    found.weight[third] = share;
    found.weight[second] = along - share * foot;
    found.weight[first] = 1 - found.weight[second] - share;
    if (!(found.weight[0] >= 0 && found.weight[1] >= 0 && found.weight[2] >= 0)) return nowhere;
    const Vec3d rest = away - share * across;
    found.squared_distance = dot(rest, rest);
    return found;
}

} // namespace

ClosestPoint closest_on_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) noexcept {
    constexpr double small = 0x1p-900; // squares and products below it lose digits
    const auto squared = [](const Vec3d& d) { return dot(d, d); };
    const Vec3d corner[3] = {a, b, c};
    const Vec3d normal = cross(b - a, c - a);
    const double area = dot(normal, normal), squared_length = squared(b - a) + squared(c - a);
    const bool is_thin = !(area > squared_thinness * (squared_length * squared_length));
    if (area > small) {
        // Areas of the triangles that the projection of p makes with the edges, divided by the whole area.
        // They add up to 1, unless the triangle is so thin that its normal is lost in rounding.
        double weight[3];
        for (int i = 0; i < 3; ++i) {
            const Vec3d &from = corner[(i + 1) % 3], &to = corner[(i + 2) % 3];
            weight[i] = dot(cross(to - from, p - from), normal) / area;
        }
        if (weight[0] >= 0 && weight[1] >= 0 && weight[2] >= 0 &&
            std::abs(weight[0] + weight[1] + weight[2] - 1) < 0x1p-26) {
            const double height = dot(p - a, normal);
            if (!is_thin)
                return {height * height > small ? height * height / area : height * (height / area),
                        {weight[0], weight[1], weight[2]}};
        }
    } else if (const int powers = enlargement(p - a, b - a, c - a); powers > 0) {
        ClosestPoint found = closest_on_triangle(times_power(p - a, powers), {0, 0, 0},
                                                 times_power(b - a, powers), times_power(c - a, powers));
        found.squared_distance = std::ldexp(found.squared_distance, -2 * powers);
        return found;
    }
    ClosestPoint best = is_thin && area > small ? closest_in_thin(p, corner) : nowhere;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const double t = closest_on_segment(p, corner[i], corner[j]);
        const double distance = squared(p - (corner[i] + t * (corner[j] - corner[i])));
        if (!(distance < best.squared_distance)) continue;
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
