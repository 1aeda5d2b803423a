// Closest points (C. Ericson, Real-Time Collision Detection, 2005, Sect. 5.1), and lower bounds by separating
// axes.
#include "surface/distance.hpp"

#include "exact/closest_point.hpp"

#include <algorithm>
#include <iterator>

namespace vox {

namespace {

// The point of a segment from p with direction d that is closest to the origin, as a fraction of the way.
double nearest_fraction(const Vec3d& p, const Vec3d& d) noexcept {
    const double squared = dot(d, d);
    return squared > 0 ? std::clamp(-dot(p, d) / squared, 0.0, 1.0) : 0;
}

template <int kCorners>
Vec3d weighted(const Vec3d (&corner)[kCorners], const double* weight) noexcept {
    Vec3d sum = weight[0] * corner[0];
    for (int i = 1; i < kCorners; ++i) sum = sum + weight[i] * corner[i];
    return sum;
}

struct CornerWeights {
    double a[3], b[3];
};

// Two edges: where the lines are closest, if that is inside of both; else an end of one is closest. Where
// the edges are nearly parallel, rounding decides too much, and the best of all of them is taken.
CornerWeights closest_weights(const Vec3d (&a)[2], const Vec3d (&b)[2]) noexcept {
    const Vec3d d = a[1] - a[0], e = b[1] - b[0], r = a[0] - b[0];
    double s = 0, t = 0, best = -1;
    const auto consider = [&](double at_a, double at_b) {
        const Vec3d way = r + (at_a * d - at_b * e);
        const double squared = dot(way, way);
        if (best >= 0 && !(squared < best)) return;
        best = squared;
        s = at_a;
        t = at_b;
    };
    // By products of vectors: where the edges are nearly parallel, the difference of squared lengths has few
    // digits.
    const Vec3d normal = cross(d, e);
    const double area = dot(normal, normal);
    if (area > 0) {
        const double at_a = dot(cross(e, r), normal) / area, at_b = dot(cross(d, r), normal) / area;
        if (at_a >= 0 && at_a <= 1 && at_b >= 0 && at_b <= 1) {
            if (area > 0x1p-20 * (dot(d, d) * dot(e, e))) return {{1 - at_a, at_a, 0}, {1 - at_b, at_b, 0}};
            consider(at_a, nearest_fraction(b[0] - (a[0] + at_a * d), e));
        }
    }
    for (int end = 0; end < 2; ++end) {
        consider(end, nearest_fraction(b[0] - a[end], e));
        consider(nearest_fraction(a[0] - b[end], d), end);
    }
    return {{1 - s, s, 0}, {1 - t, t, 0}};
}

CornerWeights closest_weights(const Vec3d (&a)[3], const Vec3d (&b)[1]) noexcept {
    const auto weights =
        normalised(closest_on_triangle({0, 0, 0}, a[0] - b[0], a[1] - b[0], a[2] - b[0]).weight);
    return {{weights[0], weights[1], weights[2]}, {1, 0, 0}};
}

CornerWeights closest_weights(const Vec3d (&a)[2], const Vec3d (&b)[1]) noexcept {
    const double s = nearest_fraction(a[0] - b[0], a[1] - a[0]);
    return {{1 - s, s, 0}, {1, 0, 0}};
}

CornerWeights closest_weights(const Vec3d (&)[1], const Vec3d (&)[1]) noexcept {
    return {{1, 0, 0}, {1, 0, 0}};
}

// `way` without what is left of an edge's direction in it.
Vec3d across(const Vec3d& way, const Vec3d& edge) noexcept {
    const double squared = dot(edge, edge);
    return squared > 0 ? way - (dot(way, edge) / squared) * edge : way;
}

Vec3d along(const Vec3d& axis, const Vec3d& way) noexcept { return dot(axis, way) < 0 ? -1 * axis : axis; }

// The way between the closest points is off by rounding of the corners, which matters where it is short: what
// is perpendicular to the edges that it ends on does better. Of a point inside of a face and of two edges
// that is the normal.
Vec3d normal_of(const Vec3d (&a)[3], const Vec3d (&)[1]) noexcept { return cross(a[1] - a[0], a[2] - a[0]); }
Vec3d normal_of(const Vec3d (&a)[2], const Vec3d (&b)[2]) noexcept { return cross(a[1] - a[0], b[1] - b[0]); }

bool is_normal(const CornerWeights& at, const Vec3d (&)[3], const Vec3d (&)[1]) noexcept {
    return at.a[0] > 0 && at.a[1] > 0 && at.a[2] > 0;
}
bool is_normal(const CornerWeights& at, const Vec3d (&)[2], const Vec3d (&)[2]) noexcept {
    return at.a[0] > 0 && at.a[1] > 0 && at.b[0] > 0 && at.b[1] > 0;
}

Vec3d squared_up(const Vec3d& way, const CornerWeights& at, const Vec3d (&a)[3],
                 const Vec3d (&)[1]) noexcept {
    for (int i = 0; i < 3; ++i)
        if (!(at.a[i] > 0) && at.a[(i + 1) % 3] > 0 && at.a[(i + 2) % 3] > 0)
            return across(way, a[(i + 2) % 3] - a[(i + 1) % 3]);
    return way;
}
Vec3d squared_up(const Vec3d& way, const CornerWeights& at, const Vec3d (&a)[2],
                 const Vec3d (&b)[2]) noexcept {
    const bool on_a = at.a[0] > 0 && at.a[1] > 0, on_b = at.b[0] > 0 && at.b[1] > 0;
    return on_a ? across(way, a[1] - a[0]) : on_b ? across(way, b[1] - b[0]) : way;
}

// The corners as seen from the first one of b, enlarged where they are tiny.
template <int kA, int kB>
struct SeenPair {
    SeenPair(std::span<const Vec3d> a, std::span<const Vec3d> b) noexcept : origin(b[0]) {
        for (std::size_t i = 0; i < kA; ++i)
            size = std::max(size, largest_coordinate(own[i] = a[i] - origin));
        for (std::size_t i = 0; i < kB; ++i)
            size = std::max(size, largest_coordinate(other[i] = b[i] - origin));
        powers = powers_to_enlarge(size);
        if (powers == 0) return;
        for (Vec3d& v : own) v = times_power(v, powers);
        for (Vec3d& v : other) v = times_power(v, powers);
        size = std::ldexp(size, powers);
    }

    Vec3d origin, own[kA], other[kB];
    double size = 0; // the largest number, after they were enlarged
    int powers;      // of two
};

template <int kA, int kB>
CloseFeatures closest(std::span<const Vec3d> a, std::span<const Vec3d> b) noexcept {
    const SeenPair<kA, kB> pair(a, b);
    const auto& [origin, own, other, size, powers] = pair;
    const CornerWeights at = closest_weights(own, other);
    const Vec3d on_a = weighted(own, at.a), on_b = weighted(other, at.b), way = on_a - on_b;
    const double most = largest_coordinate(way); // of which the square might underflow
    CloseFeatures found{most > 0x1p-400 ? length(way) : std::ldexp(length(times_power(way, 600)), -600),
                        {at.a[0], at.a[1], at.a[2]},
                        {at.b[0], at.b[1], at.b[2]},
                        origin + times_power(on_a, -powers),
                        origin + times_power(on_b, -powers)};
    found.distance = std::ldexp(found.distance, -powers);
    return found;
}

// Proof, as in cull.cpp: the corners' projections on any axis w are apart by a gap, and so are the features
// by gap / |w|. Rounding, with u = 2^-53, R the largest coordinate relative to the origin and |w|1 the sum of
// the magnitudes of w's numbers: a coordinate is off by u R, a projection by another 3.01 u |w|1 R, a
// difference of two by 10.1 u |w|1 R in all, and |w|1 < 1.74 |w|; so a gap is off by less than 18 u R |w|.
// The bound that is subtracted has 32 u R, whose surplus covers its own rounding; that of gap / |w| is less
// than 4 u of it.
template <int kA, int kB>
double at_least(std::span<const Vec3d> a, std::span<const Vec3d> b) noexcept {
    const SeenPair<kA, kB> pair(a, b);
    const auto& [origin, own, other, size, powers] = pair;
    double best = 0;
    const Axes axes = axes_between(own, other);
    // Returns whether another axis need not be tried.
    const auto is_enough = [&, &own = own, &other = other, size = size](const Vec3d& w) {
        const double squared = dot(w, w);
        if (!(squared > least_squared_axis)) return false;
        double least = dot(w, own[0]), most = dot(w, other[0]);
        for (int i = 1; i < kA; ++i) least = std::min(least, dot(w, own[i]));
        for (int i = 1; i < kB; ++i) most = std::max(most, dot(w, other[i]));
        best = std::max(best, (least - most) / std::sqrt(squared) * (1 - 0x1p-50) - 0x1p-48 * size);
        return best > good_enough * axes.length;
    };
    // Where rounding hides which of two corners, or of a corner and an edge, are closest, all are tried.
    const auto is_enough_between_corners = [&, &own = own, &other = other](const Vec3d& p, const Vec3d& q) {
        const Vec3d way = p - q;
        const auto is_enough_across = [&](const auto& corners, const Vec3d& from) {
            return std::any_of(std::begin(corners), std::end(corners),
                               [&](const Vec3d& to) { return is_enough(across(way, to - from)); });
        };
        return is_enough(way) || is_enough_across(own, p) || is_enough_across(other, q);
    };
    if (std::none_of(std::begin(axes.axis), std::end(axes.axis), is_enough))
        for (int i = 0; i < kA * kB; ++i)
            if (is_enough_between_corners(own[i / kB], other[i % kB])) break;
    // Rounded to a denormal it may have grown.
    const double scaled = std::ldexp(best, -powers);
    return scaled > 0 && powers > 0 ? std::nextafter(scaled, 0.0) : scaled;
}

} // namespace

template <int kA, int kB>
Axes axes_between(const Vec3d (&a)[kA], const Vec3d (&b)[kB]) noexcept {
    const CornerWeights at = closest_weights(a, b);
    const Vec3d way = weighted(a, at.a) - weighted(b, at.b);
    const Vec3d normal = along(normal_of(a, b), way), square = squared_up(way, at, a, b);
    const double length_of_way = length(way);
    if (is_normal(at, a, b)) return {{normal, square, way}, length_of_way};
    return {{square, normal, way}, length_of_way};
}
template Axes axes_between(const Vec3d (&)[3], const Vec3d (&)[1]) noexcept;
template Axes axes_between(const Vec3d (&)[2], const Vec3d (&)[2]) noexcept;

CloseFeatures closest_features(std::span<const Vec3d> a, std::span<const Vec3d> b) noexcept {
    if (a.size() < b.size()) {
        CloseFeatures found = closest_features(b, a);
        std::swap(found.weights_a, found.weights_b);
        std::swap(found.point_a, found.point_b);
        return found;
    }
    if (a.size() == 3) return closest<3, 1>(a, b);
    if (a.size() == 1) return closest<1, 1>(a, b);
    return b.size() == 2 ? closest<2, 2>(a, b) : closest<2, 1>(a, b);
}

double distance_at_least(std::span<const Vec3d> a, std::span<const Vec3d> b) noexcept {
    return a.size() == 3 ? at_least<3, 1>(a, b) : at_least<2, 2>(a, b);
}

} // namespace vox
