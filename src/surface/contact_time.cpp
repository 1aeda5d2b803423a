// Conservative advancement along directions that separate (B. Mirtich, Impulse-based Dynamic Simulation of
// Rigid Body Systems, 1996, Sect. 2.3; with the rule of additive CCD for where to stop: Li, Kaufman, Jiang,
// Codimensional Incremental Potential Contact, 2021, Sect. 5).
//
// At a time t, let w be any vector, a_i and b_j the corners of the two features. As in cull.cpp, |w| times
// the distance of the features is at least min_i w . a_i - max_j w . b_j. Each w . (a_i - b_j) is linear in
// time, so the time up to which all of them stay above |w| d is known in closed form; until then the features
// are further apart than d. There the next w is taken, that between the closest points. Nothing depends on w
// being right: a bad one gives a short step, and a time that is early.
//
// Rounding. u = 2^-53. Coordinates are taken from the first corner of a at time 0, and displacements from its
// displacement; both cancel in every difference. A coordinate x of a position relative to it is off by u |x|;
// a displacement d = q - p by u |d|, and relative to that of the first corner, v, by u |d| + u |v|. Let P be
// the largest |x| + |v| and D the largest |d|. A coordinate at time t, fl(x + fl(t v)), is then off by less
// than u (4 P + D), and its product with w, summed, by less than u (7.1 P + D) |w|1. A difference of two such
// products is off by less than u (16.3 P + 2 D) |w|1: `error` is u (20 P + 3 D) |w|1. That of two products of
// w with v is off by less than u (10.1 P + 2 D) |w|1, which is below it, too. The quotient of the one and the
// other, a time, is rounded downwards, and so is the sum with t.
//
// Where all move far together, v is taken from relative positions at both times, of which each is at most P:
// it is off by less than 2 u P, a coordinate at time t by 4 u P, and without D the rest is as above. Tiny
// pairs are enlarged by a power of two, as products underflow.
#include "surface/contact_time.hpp"

#include "base/vectors.hpp"
#include "surface/distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace vox {

namespace {

constexpr double unit_roundoff = 0x1p-53;

struct MovingFeature {
    std::size_t corners;
    std::array<Vec3d, 3> at, way; // at time 0, and to time 1

    Vec3d corner(std::size_t i, double time) const noexcept { return at[i] + time * way[i]; }
};

struct MovingPair {
    MovingPair(const SurfaceMotion& motion, std::span<const std::uint32_t> first,
               std::span<const std::uint32_t> second) noexcept {
        const Vec3d origin = motion.from[first[0]], common = motion.to[first[0]] - origin;
        double positions = 0, displacements = 0;
        const auto take = [&](std::span<const std::uint32_t> corners, bool together, MovingFeature& out) {
            out.corners = corners.size();
            for (std::size_t i = 0; i < corners.size(); ++i) {
                const Vec3d p = motion.from[corners[i]], q = motion.to[corners[i]], d = q - p;
                const Vec3d x = out.at[i] = p - origin,
                            v = out.way[i] = together ? q - motion.to[first[0]] - x : d - common;
                positions = std::max({positions, std::abs(x.x) + std::abs(v.x), std::abs(x.y) + std::abs(v.y),
                                      std::abs(x.z) + std::abs(v.z)});
                displacements = std::max(displacements, largest_coordinate(d));
            }
        };
        const auto take_both = [&](bool together) {
            take(first, together, a);
            take(second, together, b);
        };
        take_both(false);
        if (displacements > 1024 * positions) {
            positions = displacements = 0;
            take_both(true);
            displacements = 0;
        }
        powers = powers_to_enlarge(positions);
        if (powers > 0)
            for (MovingFeature* feature : {&a, &b})
                for (std::size_t i = 0; i < feature->corners; ++i) {
                    feature->at[i] = times_power(feature->at[i], powers);
                    feature->way[i] = times_power(feature->way[i], powers);
                }
        error = unit_roundoff * std::ldexp(20 * positions + 3 * displacements, powers);
    }

    MovingFeature a, b;
    int powers;   // of two, by which it was enlarged
    double error; // of a difference of projections, for |w|1 = 1
};

// Projections on w at one time: where the features are along it, and how fast they change.
struct AlongWay {
    AlongWay(const MovingPair& pair, const Vec3d& w, double time) noexcept
        : length(vox::length(w)), error(pair.error * (std::abs(w.x) + std::abs(w.y) + std::abs(w.z))) {
        for (std::size_t i = 0; i < pair.a.corners; ++i) {
            a[i] = dot(w, pair.a.corner(i, time));
            rate_a[i] = dot(w, pair.a.way[i]);
        }
        for (std::size_t j = 0; j < pair.b.corners; ++j) {
            b[j] = dot(w, pair.b.corner(j, time));
            rate_b[j] = dot(w, pair.b.way[j]);
        }
        gap = *std::min_element(a, a + pair.a.corners) - *std::max_element(b, b + pair.b.corners) - error;
    }
    // At most the distance of the features.
    double distance() const noexcept {
        return length > 0x1p-500 && gap > 0 ? gap / length * (1 - 0x1p-48) : 0;
    }

    double a[3]{}, rate_a[3]{}, b[3]{}, rate_b[3]{};
    double length, error, gap;
};

// The direction, of those between the closest points at a time, that separates the features furthest.
template <int kA, int kB>
AlongWay best_way(const MovingPair& pair, double time) noexcept {
    Vec3d a[kA], b[kB];
    for (std::size_t i = 0; i < kA; ++i) a[i] = pair.a.corner(i, time);
    for (std::size_t j = 0; j < kB; ++j) b[j] = pair.b.corner(j, time);
    const Axes axes = axes_between(a, b);
    AlongWay best(pair, axes.axis[0], time);
    for (std::size_t i = 1; i < 3 && best.distance() < good_enough * axes.length; ++i) {
        const AlongWay other(pair, axes.axis[i], time);
        if (other.distance() > best.distance()) best = other;
    }
    return best;
}

// How long the features stay further apart along the way than `distance`, rounded downwards; infinite:
// always.
double time_along(const MovingPair& pair, const AlongWay& way, double distance) noexcept {
    const double most = distance * way.length * (1 + 0x1p-48) + way.error;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < pair.a.corners; ++i)
        for (std::size_t j = 0; j < pair.b.corners; ++j) {
            const double rate = way.rate_b[j] - way.rate_a[i] + way.error;
            if (rate > 0) least = std::min(least, (way.a[i] - way.b[j] - most) / rate);
        }
    return least * (1 - 0x1p-48);
}

} // namespace

ContactTime contact_time(const SurfaceMotion& motion, std::span<const std::uint32_t> a,
                         std::span<const std::uint32_t> b, const ContactTimeRule& rule,
                         double latest) noexcept {
    const MovingPair pair(motion, a, b);
    const double distance = std::ldexp(rule.distance, pair.powers);
    double time = 0, enough = 0;
    for (std::uint32_t iteration = 0; iteration < rule.most_iterations; ++iteration) {
        const AlongWay way = pair.b.corners == 1 ? best_way<3, 1>(pair, time) : best_way<2, 2>(pair, time);
        const double left = way.distance() - distance;
        if (!(left > 0)) return {time, true, true};
        if (iteration == 0)
            enough = rule.slack * left;
        else if (left <= enough)
            return {time, true, true};
        const double step = time_along(pair, way, distance + rule.slack / 2 * left);
        if (!(step > 0)) return {time, true, true}; // less than rounding leaves
        const double sum = time + step;
        if (sum > 1) return {1, false, true};
        const double next = std::nextafter(sum, 0.0);
        if (!(next > time)) return {time, true, true};
        time = next;
        if (time > latest) return {time, true, true};
    }
    return {time, true, false};
}

} // namespace vox
