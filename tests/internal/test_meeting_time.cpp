// Times of meeting: never later than one that is known exactly, at one that is a meeting up to rounding
// errors, and none where there is none.
#include "base/vectors.hpp"
#include "exact/closest_point.hpp"
#include "exact/meeting_time.hpp"

#include "scenes/random.h"
#include "support/suite.h"

#include <algorithm>
#include <cmath>

using namespace vox;

namespace {

std::uint64_t tests_so_far = 0;

double meeting_time(const SeenMotion& motion, double latest) {
    return vox::meeting_time(motion, latest, tests_so_far);
}

Vec3d small_integers(std::uint64_t& state, std::uint32_t range) {
    const auto number = [&] {
        return static_cast<double>(random_below(&state, 2 * range + 1)) - static_cast<double>(range);
    };
    const double x = number(), y = number(), z = number();
    return {x, y, z};
}

double distance_at(const SeenMotion& m, double t) {
    Vec3d corner[3];
    for (int i = 0; i < 3; ++i) corner[i] = (1 - t) * m.from[i] + t * m.to[i];
    return length(closest_seen_from({0, 0, 0}, corner[0], corner[1], corner[2]).way);
}

double largest_coordinate(const SeenMotion& m) {
    double largest = 0;
    for (int i = 0; i < 3; ++i)
        for (const Vec3d& v : {m.from[i], m.to[i]})
            largest = std::max({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return largest;
}

// A motion of small integers in which the point is in the triangle, or on its boundary, at `time` = 2^-k,
// with weights that are multiples of 1 / 4. Everything is exact.
SeenMotion meeting_at(std::uint64_t& state, double time, std::uint32_t range, bool stands_still) {
    const double inverse = 1 / time;
    Vec3d from[3], to[3];
    for (int i = 0; i < 3; ++i) {
        from[i] = 4 * small_integers(state, range);
        to[i] = stands_still ? from[i] : 4 * small_integers(state, range);
    }
    const double u = random_below(&state, 5), v = random_below(&state, static_cast<std::uint32_t>(5 - u));
    const double weight[3] = {u / 4, v / 4, (4 - u - v) / 4};
    Vec3d met{0, 0, 0};
    for (int i = 0; i < 3; ++i) met = met + weight[i] * ((1 - time) * from[i] + time * to[i]);
    const Vec3d start = 4 * small_integers(state, range);
    const Vec3d end = inverse * met - (inverse - 1) * start;
    SeenMotion m;
    for (int i = 0; i < 3; ++i) {
        m.from[i] = from[i] - start;
        m.to[i] = to[i] - end;
    }
    return m;
}

} // namespace

START_TEST(never_late) {
    std::uint64_t state = 1;
    for (int i = 0; i < 100000; ++i) {
        const double time = std::ldexp(1.0, -static_cast<int>(random_below(&state, 4)));
        const std::uint32_t range = 1 + random_below(&state, i % 2 ? 2 : 100); // many are degenerate
        const SeenMotion m = meeting_at(state, time, range, i % 5 == 0);
        const double found = meeting_time(m, 1);
        ck_assert_double_le(found, time);
        ck_assert_double_ge(found, 0);
        ck_assert_double_le(distance_at(m, found), 1e-5 * largest_coordinate(m));
        // What is asked for does not change it.
        ck_assert_double_eq(meeting_time(m, found), found);
        if (found > 0) ck_assert_double_eq(meeting_time(m, std::nextafter(found, 0)), no_meeting);
    }
}
END_TEST

// Of a point that crosses the interior of a triangle once, transversally, the time is exact to rounding.
START_TEST(tight) {
    std::uint64_t state = 2;
    for (int i = 0; i < 20000; ++i) {
        SeenMotion m;
        const double height = 1 + random_unit(&state), below = 1 + random_unit(&state);
        const Vec3d corner[3] = {{-2, -2, 0}, {3, -1, 0}, {-1, 3, 0}};
        const Vec3d drift = 0.25 * small_integers(state, 1);
        for (int c = 0; c < 3; ++c) {
            m.from[c] = corner[c] - Vec3d{0, 0, height};
            m.to[c] = corner[c] - Vec3d{drift.x, drift.y, -below};
        }
        const double exact = height / (height + below), found = meeting_time(m, 1);
        ck_assert_double_le(found, exact);
        ck_assert_double_ge(found, exact - 1e-13);
    }
}
END_TEST

START_TEST(none) {
    std::uint64_t state = 3;
    for (int i = 0; i < 100000; ++i) {
        // The triangle stays in z >= gap, of any orientation, size and scale; both turn as one.
        const double gap = std::ldexp(1.0, -static_cast<int>(random_below(&state, 30)));
        const double scale = std::ldexp(1.0, static_cast<int>(random_below(&state, 200)) - 100);
        SeenMotion m;
        for (int c = 0; c < 3; ++c)
            for (Vec3d* v : {&m.from[c], &m.to[c]}) {
                const Vec3d p{random_symmetric(&state), random_symmetric(&state), random_unit(&state) + gap};
                *v = scale * Vec3d{p.z, p.x, p.y};
            }
        ck_assert_double_eq(meeting_time(m, 1), no_meeting);
    }
}
END_TEST

// All in one plane, in one line, in one point; no number of intervals runs away.
START_TEST(degenerate) {
    SeenMotion m{};
    ck_assert_double_eq(meeting_time(m, 1), 0);
    for (int c = 0; c < 3; ++c) m.from[c] = {4, 0, 0}, m.to[c] = {-4, 0, 0}; // a point through a point
    ck_assert_double_le(meeting_time(m, 1), 0.5);
    ck_assert_double_ge(meeting_time(m, 1), 0.5 - 1e-9);
    for (int c = 0; c < 3; ++c) m.to[c] = {4, 1, 0}; // and past it
    ck_assert_double_eq(meeting_time(m, 1), no_meeting);
    // A triangle that turns in its plane past a point in that plane, beside it.
    m = {{{1, -1, 0}, {1, 1, 0}, {3, 0, 0}}, {{1, 1, 0}, {3, 0, 0}, {1, -1, 0}}};
    const double found = meeting_time(m, 1);
    ck_assert(found == no_meeting || distance_at(m, found) < 1e-5);
    const Vec3d far{1e38, -1e38, 1e38}; // no overflow
    for (int c = 0; c < 3; ++c) m.from[c] = far, m.to[c] = -1.0 * far;
    m.from[1] = {1e38, 1e38, -1e38};
    ck_assert_double_le(meeting_time(m, 1), 0.5);
}
END_TEST

// Of what goes straight through a face, or all through one point, few intervals are tested.
START_TEST(few_tests) {
    std::uint64_t state = 4;
    constexpr std::uint64_t count = 10000;
    for (const bool collapses : {false, true}) {
        const std::uint64_t before = tests_so_far;
        for (std::uint64_t i = 0; i < count; ++i) {
            const double power = random_unit(&state);
            const Vec3d way{random_symmetric(&state), random_symmetric(&state), -4};
            SeenMotion m;
            for (int c = 0; c < 3; ++c) {
                const double x = c == 0 ? 2 : -1, y = c == 1 ? 2 : -1;
                m.from[c] = {x + random_unit(&state), y + random_unit(&state), 1 + random_unit(&state)};
                m.to[c] = collapses ? -power * m.from[c] : m.from[c] + way;
            }
            const double found = meeting_time(m, 1);
            if (collapses) ck_assert_double_eq_tol(found, 1 / (1 + power), 1e-12);
        }
        ck_assert_uint_lt(tests_so_far - before, 6 * count);
    }
}
END_TEST

SUITE(meeting_time) {
    tcase_add_each(add_case(suite, "meeting_time"), never_late, tight, none, degenerate, few_tests);
}
