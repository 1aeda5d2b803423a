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

// True if the two certainly do not meet during an interval.
bool stay_apart(const SeenMotion& motion, double begin_time, double end_time) noexcept {
    const CornerPositions begin = corners_at(motion, begin_time), end = corners_at(motion, end_time);
    if (stays_on_one_side(begin, end)) return true;
    const CornerPositions middle = corners_at(motion, 0.5 * begin_time + 0.5 * end_time);
    const Vec3d way = closest_seen_from({0, 0, 0}, middle.at[0], middle.at[1], middle.at[2]).way;
    if (is_separated(begin, end, way)) return true;
    // Close to the triangle, rounding errors turn `way` more than the normal.
    const Vec3d* c = middle.at;
    const Vec3d normal = cross(c[1] - c[0], c[2] - c[0]);
    return is_separated(begin, end, dot(normal, c[0]) > 0 ? normal : -1.0 * normal);
}

} // namespace

double meeting_time(const SeenMotion& given, double latest) noexcept {
    double largest = 0;
    for (int i = 0; i < 3; ++i)
        largest = std::max({largest, largest_coordinate(given.from[i]), largest_coordinate(given.to[i])});
    if (!(largest > 0)) return 0;
    SeenMotion motion;
    const int power = -1 - std::ilogb(largest);
    for (int i = 0; i < 3; ++i) {
        motion.from[i] = times_power(given.from[i], power);
        motion.to[i] = times_power(given.to[i], power);
    }
    // The intervals are those of a binary tree, in their order in time.
    struct Interval {
        double begin;
        int divisions;
    };
    Interval stack[most_divisions + 2] = {{0, 0}};
    int size = 1, tested = 0;
    while (size > 0) {
        const Interval interval = stack[--size];
        if (interval.begin > latest) return no_meeting;
        const double length = std::ldexp(1.0, -interval.divisions);
        if (stay_apart(motion, interval.begin, interval.begin + length)) continue;
        if (interval.divisions == most_divisions || ++tested == most_intervals) return interval.begin;
        stack[size++] = {interval.begin + 0.5 * length, interval.divisions + 1};
        stack[size++] = {interval.begin, interval.divisions + 1};
    }
    return no_meeting;
}

} // namespace vox
