// Bisection of time, as in inclusion-based methods (J. M. Snyder, Interval analysis for computer graphics,
// SIGGRAPH 1992; B. Wang et al., A large-scale benchmark and an inclusion-based algorithm for continuous
// collision detection, ACM Transactions on Graphics 40, 2021). An interval is excluded if the
// point stays on one side of the triangle's plane, or if an axis separates the two at both ends of the
// interval, since linear motion then keeps them apart in between.
//
// The volume of point and triangle is a cubic polynomial of time. Its Bernstein coefficients are blossoms,
// that is, volumes that mix corners at the beginning and the end of the interval (L. Ramshaw, Blossoms are
// polar forms, Computer Aided Geometric Design 6, 1989).
#include "exact/meeting_time.hpp"

#include "base/vectors.hpp"
#include "exact/closest_point.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

namespace {

// Coordinates are scaled to at most 1. Subtraction and interpolation put a corner off by at most 2^-51 on
// each axis; a dot product with an axis is off by 3 * 2^-51 + 3 * 2^-52 times the axis' largest coordinate; a
// determinant by 18 * 2^-51, as each of its six products has three factors, and 6 * 2^-50 for rounding; the
// mean of three by no more.
constexpr double dot_error = 0x1p-48;
constexpr double volume_error = 0x1p-45;

// Intervals divided so often are not divided further, and at most so many are tested: then the result is the
// beginning of the present one. Only a point that slides along the plane of a turning triangle takes more
// than some tens.
constexpr int most_divisions = 48;
constexpr int most_intervals = 2000;

struct CornerPositions {
    Vec3d at[3];
};

CornerPositions corners_at(const SeenMotion& motion, double time) noexcept {
    CornerPositions corners;
    for (int i = 0; i < 3; ++i) corners.at[i] = (1 - time) * motion.from[i] + time * motion.to[i];
    return corners;
}

bool stays_on_one_side(const CornerPositions& begin, const CornerPositions& end) noexcept {
    const Vec3d *a = begin.at, *b = end.at;
    const double first = determinant(a[0], a[1], a[2]);
    if (std::abs(first) <= volume_error) return false;
    const double sign = first > 0 ? 1 : -1;
    const auto same = [sign](double volume) { return sign * volume > volume_error; };
    return same(determinant(b[0], b[1], b[2])) &&
           same((determinant(b[0], a[1], a[2]) + determinant(a[0], b[1], a[2]) +
                 determinant(a[0], a[1], b[2])) /
                3) &&
           same((determinant(a[0], b[1], b[2]) + determinant(b[0], a[1], b[2]) +
                 determinant(b[0], b[1], a[2])) /
                3);
}

bool is_separated(const CornerPositions& begin, const CornerPositions& end, const Vec3d& axis) noexcept {
    const double error = dot_error * largest_coordinate(axis);
    for (int i = 0; i < 3; ++i)
        if (!(dot(begin.at[i], axis) > error) || !(dot(end.at[i], axis) > error)) return false;
    return true;
}

Vec3d normal_of(const CornerPositions& corners) noexcept {
    return cross(corners.at[1] - corners.at[0], corners.at[2] - corners.at[0]);
}

// True if the two certainly do not meet during an interval.
bool stay_apart(const SeenMotion& motion, double begin_time, double end_time) noexcept {
    const CornerPositions begin = corners_at(motion, begin_time), end = corners_at(motion, end_time);
    if (stays_on_one_side(begin, end)) return true;
    // Close to the triangle, rounding errors turn the way to the closest point more than the normal.
    const CornerPositions middle = corners_at(motion, 0.5 * begin_time + 0.5 * end_time);
    const Vec3d* c = middle.at;
    const Vec3d normal = normal_of(middle);
    if (is_separated(begin, end, dot(normal, c[0]) > 0 ? normal : -1.0 * normal)) return true;
    return is_separated(begin, end, closest_seen_from({0, 0, 0}, c[0], c[1], c[2]).way);
}

// The intervals are those of a binary tree, in their order in time.
struct Interval {
    double begin = 0, length = 1;
    int divisions = 0;

    double end() const noexcept { return begin + length; }
    double middle() const noexcept { return begin + 0.5 * length; }
    Interval earlier() const noexcept { return {begin, 0.5 * length, divisions + 1}; }
    Interval later() const noexcept { return {middle(), 0.5 * length, divisions + 1}; }
};

// The latest time, at most 1, up to which an axis is seen to separate the two from `begin` on; `begin` if it
// does not.
double separated_until(const SeenMotion& motion, const CornerPositions& first, double begin,
                       const Vec3d& axis) noexcept {
    const double error = 1.25 * dot_error * largest_coordinate(axis);
    double part = 1; // of what is left of the motion
    for (int i = 0; i < 3; ++i) {
        const double from = dot(first.at[i], axis), to = dot(motion.to[i], axis);
        if (!(from > error)) return begin;
        if (to < error) part = std::min(part, (from - error) / (from - to));
    }
    const double end = part < 1 ? begin + part * (1 - begin) : 1;
    return end > begin && is_separated(first, corners_at(motion, end), axis) ? end : begin;
}

// The two are apart until `begin`. Right after that they may be close, or the point is at the inside of the
// triangle, as far as rounding errors show.
enum class Next { unknown, close, met };
struct Advance {
    double begin;
    Next next;
};

// Conservative advancement (B. Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems, 1996, Sect.
// 2.3): each time to where the way to the closest point does not separate any more. The steps do not depend
// on `latest`, after which they end.
Advance advance(const SeenMotion& motion, double latest, std::uint64_t& tests) noexcept {
    constexpr int most_steps = 8;
    double begin = 0;
    for (int i = 0; i < most_steps; ++i, ++tests) {
        const CornerPositions first = corners_at(motion, begin);
        const Vec3d* c = first.at;
        const SeenPoint seen = closest_seen_from({0, 0, 0}, c[0], c[1], c[2]);
        const double* weight = seen.at.weight;
        Vec3d axis = seen.way;
        const bool is_over = weight[0] > 0 && weight[1] > 0 && weight[2] > 0;
        if (is_over) { // rounding errors turn the normal less
            const Vec3d normal = normal_of(first);
            axis = dot(normal, c[0]) > 0 ? normal : -1.0 * normal;
        }
        const double end = separated_until(motion, first, begin, axis);
        if (end > latest || end == 1) return {2, Next::unknown};
        const bool is_close = end < begin + 0x1p-44;
        begin = end;
        if (is_close)
            return {begin, is_over && dot(axis, c[0]) < 4 * dot_error * largest_coordinate(axis)
                               ? Next::met
                               : Next::close};
    }
    return {begin, Next::unknown};
}

// The beginning of the first interval that is neither excluded nor divided, or what is known to be excluded.
double first_left(const SeenMotion& motion, double latest, std::uint64_t& tests) noexcept {
    Interval stack[2 * most_divisions + 2];
    int size = 0, left = 0;
    const Advance advanced = advance(motion, latest, tests);
    double excluded = advanced.begin; // what is before it
    if (excluded > latest) return no_meeting;
    if (advanced.next == Next::met) return excluded;
    const auto descend = [&](Interval interval, int divisions) {
        while (interval.divisions < divisions) {
            if (interval.middle() > excluded) stack[size++] = interval.later();
            interval = interval.middle() > excluded ? interval.earlier() : interval.later();
        }
        stack[size++] = interval;
    };
    descend({}, advanced.next == Next::close ? most_divisions : 0);
    while (size > 0) {
        const Interval interval = stack[--size];
        const double begin = std::max(interval.begin, excluded);
        if (begin > latest) return no_meeting;
        if (interval.end() <= excluded) continue;
        ++tests;
        if (stay_apart(motion, begin, interval.end())) continue;
        if (interval.divisions == most_divisions || ++left == most_intervals) return begin;
        descend(interval, interval.divisions + 1);
    }
    return no_meeting;
}

} // namespace

double meeting_time(const SeenMotion& given, double latest, std::uint64_t& tests) noexcept {
    double largest = 0;
    for (int i = 0; i < 3; ++i)
        largest = std::max({largest, largest_coordinate(given.from[i]), largest_coordinate(given.to[i])});
    if (!(largest > 0)) return 0;
    SeenMotion motion;
    const int power = -1 - std::ilogb(largest), most = std::clamp(power, -1000, 1000); // others overflow
    const double scale = std::ldexp(1.0, most), rest = std::ldexp(1.0, power - most);
    for (int i = 0; i < 3; ++i) {
        motion.from[i] = rest * (scale * given.from[i]);
        motion.to[i] = rest * (scale * given.to[i]);
    }
    return first_left(motion, latest, tests);
}

} // namespace vox
