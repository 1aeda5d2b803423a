// Times of contact that are known exactly, or checked by samples: never late, and not too early.
#include "base/vectors.hpp"
#include "internal/feature_distance.hpp"
#include "internal/random.hpp"
#include "surface/contact_time.hpp"

#include <vox/vox_surface.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <vector>

#include "support/suite.h"
#include "support/surface_counter.h" // last: it defines macros with common names

using namespace vox;
using test::feature_distance;

namespace {

constexpr std::uint32_t numbers[4] = {0, 1, 2, 3};

// Four corners: a face and a vertex, or two edges.
struct Query {
    Vec3d from[4], to[4];
    bool edges = false;

    std::span<const std::uint32_t> a() const { return std::span(numbers).first(edges ? 2 : 3); }
    std::span<const std::uint32_t> b() const { return std::span(numbers).subspan(edges ? 2 : 3); }
    SurfaceMotion motion() const { return {from, to, 0, true, false}; }
    Vec3d at(int corner, double time) const { return from[corner] + time * (to[corner] - from[corner]); }
};

ContactTimeRule rule_of(double distance = 0, double slack = 0.1) { return {distance, slack, 10000}; }

ContactTime answer(const Query& q, const ContactTimeRule& rule = rule_of(), double latest = 1) {
    return contact_time(q.motion(), q.a(), q.b(), rule, latest);
}

double distance_at(const Query& q, double time) {
    const Vec3d p[4] = {q.at(0, time), q.at(1, time), q.at(2, time), q.at(3, time)};
    return feature_distance(p, q.edges);
}

double whole(test::Random& random, int most) {
    return double(random.below(std::uint32_t(2 * most + 1))) - most;
}
Vec3d whole_vector(test::Random& random, int most) {
    return {whole(random, most), whole(random, most), whole(random, most)};
}

// Features that have a point in common at time `touch`, a multiple of 1/64, with numbers that doubles hold
// exactly.
Query touching_query(test::Random& random, double touch) {
    Query q;
    q.edges = random.below(2) == 0;
    Vec3d at[4], way[4];
    const bool flat = random.below(4) == 0; // degenerate now and then
    for (int i = 0; i < 4; ++i) {
        at[i] = 8 * whole_vector(random, flat ? 1 : 6);
        way[i] = random.below(5) == 0 ? Vec3d{0, 0, 0} : 8 * whole_vector(random, 8);
    }
    const double s = random.below(9) / 8.0, t = random.below(9) / 8.0;
    if (q.edges)
        at[3] = 8.0 * whole_vector(random, 6), at[2] = at[0] + s * (at[1] - at[0]),
        at[2] = at[2] - t * (at[3] - at[2]);
    else
        at[3] = at[0] + s * (1 - t) * (at[1] - at[0]) + s * t * (at[2] - at[0]);
    if (q.edges) { // the point is at t of the second edge: solve for its first corner, or let it be that
                   // corner
        const Vec3d point = at[0] + s * (at[1] - at[0]);
        at[2] = point;
        if (random.below(2)) { // inside it
            const Vec3d half = whole_vector(random, 6);
            at[2] = point - half;
            at[3] = point + half;
        }
    }
    for (int i = 0; i < 4; ++i) {
        q.from[i] = at[i] - touch * way[i];
        q.to[i] = at[i] + (1 - touch) * way[i];
    }
    return q;
}

std::uint64_t queries_wanted() { return volume_from("VOX_CONTACT_TIME_QUERIES", 30000); }

START_TEST(never_later_than_a_time_that_is_known) {
    test::Random random{1};
    std::uint64_t close = 0, late_touch = 0;
    for (std::uint64_t n = 0; n < queries_wanted(); ++n) {
        const double touch = random.below(65) / 64.0;
        const Query q = touching_query(random, touch);
        const ContactTime found = answer(q);
        ck_assert_msg(found.touches, "query %llu: a touch at %g is not seen", (unsigned long long)n, touch);
        ck_assert_msg(found.time <= touch, "query %llu: %.17g is later than %.17g", (unsigned long long)n,
                      found.time, touch);
        ck_assert(found.finished);
        // Not too early: what was left of the distance is at most the slack, but for rounding.
        const double start = distance_at(q, 0), left = distance_at(q, found.time);
        if (start > 1e-6)
            ck_assert_msg(left <= 0.11 * start, "query %llu: %g of %g left", (unsigned long long)n, left,
                          start);
        close += found.time > 0.8 * touch;
        late_touch += touch > 0.5 && found.time > 0;
    }
    ck_assert_uint_gt(close, queries_wanted() / 10);
    ck_assert_uint_gt(late_touch, queries_wanted() / 10);
}
END_TEST

// At no time before the answer are the features within the distance; far from the origin, and with common
// motion, too.
START_TEST(apart_until_then) {
    test::Random random{2};
    std::uint64_t touching = 0, apart = 0;
    for (std::uint64_t n = 0; n < queries_wanted(); ++n) {
        Query q;
        q.edges = random.below(2) == 0;
        const double away = random.below(3) == 0 ? 1e6 : 0, common = random.below(3) == 0 ? 1e3 : 0;
        for (int i = 0; i < 4; ++i) {
            q.from[i] = {random.unit() + away, random.unit() - away, random.unit()};
            const double far = random.below(4) == 0 ? 5 : 1;
            q.to[i] = q.from[i] + Vec3d{far * (random.unit() - .5) + common, far * (random.unit() - .5),
                                        far * (random.unit() - .5)};
        }
        const double distance = random.below(2) == 0 ? 0 : random.unit() / 5;
        const ContactTimeRule rule = rule_of(distance, random.below(2) == 0 ? 0.1 : 0.01);
        const ContactTime found = answer(q, rule);
        const double rounding = 1e-9 * (1 + away / 1e3);
        for (int k = 0; k < 64; ++k) {
            const double t = k / 64.0;
            if (t < found.time)
                ck_assert_msg(distance_at(q, t) > distance - rounding, "query %llu: %g at %g, before %g",
                              (unsigned long long)n, distance_at(q, t), t, found.time);
        }
        const double start = distance_at(q, 0) - distance, left = distance_at(q, found.time) - distance;
        if (found.touches && start > 1e-3) ck_assert(left <= rule.slack * start * 1.01 + rounding);
        (found.touches ? touching : apart) += 1;
        // A time that is looked for no further is the same, or above what it is compared with.
        const double latest = random.unit();
        const ContactTime pruned = answer(q, rule, latest);
        ck_assert(found.touches && found.time <= latest ? pruned.touches && pruned.time == found.time
                                                        : !pruned.touches || pruned.time > latest);
    }
    ck_assert_uint_gt(touching, queries_wanted() / 10);
    ck_assert_uint_gt(apart, queries_wanted() / 10);
}
END_TEST

START_TEST(plain_cases) {
    Query q{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {.2, .2, 1}},
            {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {.2, .2, -1}},
            false};
    ContactTime found = answer(q);
    ck_assert(found.touches && found.time <= 0.5 && found.time > 0.44);
    found = answer(q, rule_of(0.5)); // from 1 to 0.5 at a quarter
    ck_assert(found.touches && found.time <= 0.25 && found.time > 0.22);
    found = answer(q, rule_of(0, 1e-6));
    ck_assert(found.time <= 0.5 && found.time > 0.499999);
    q.to[3] = q.from[3]; // standing still
    ck_assert(!answer(q).touches && answer(q).time == 1);
    for (int i = 0; i < 4; ++i) q.to[i] = q.from[i] + Vec3d{1e6, -3e5, 0.1}; // moving together
    ck_assert(!answer(q).touches);
    q = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {.2, .2, 0}},
         {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {.2, .2, 1}},
         false};
    found = answer(q); // touching at the beginning
    ck_assert(found.touches && found.time == 0);
    q = {{{0, 0, 0}, {1, 0, 0}, {.5, -1, 1}, {.5, 1, 1}},
         {{0, 0, 0}, {1, 0, 0}, {.5, -1, -1}, {.5, 1, -1}},
         true};
    found = answer(q);
    ck_assert(found.touches && found.time <= 0.5 && found.time > 0.44);
    q = {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}},
         {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0}},
         true}; // along one line
    found = answer(q);
    ck_assert(found.touches && found.time <= 0.5 && found.time > 0.44);
    const ContactTime given_up = contact_time(q.motion(), q.a(), q.b(), {0, 1e-9, 1}, 1);
    ck_assert(given_up.touches && !given_up.finished && given_up.time <= 0.5);
}
END_TEST

// A pair of any size, or that moves far together, has the time of the same pair at rest and of size 1.
START_TEST(any_size_and_common_motion) {
    const Query q{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {.25, .25, 1}},
                  {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {.25, .25, -1}},
                  false};
    for (const double size : {1e-290, 1e-160, 1e-100, 1e30}) {
        Query other = q;
        for (int i = 0; i < 4; ++i) other.from[i] = size * q.from[i], other.to[i] = size * q.to[i];
        ck_assert_double_eq_tol(answer(other).time, answer(q).time, 1e-12);
        ck_assert_double_eq_tol(answer(other, rule_of(.5 * size)).time, answer(q, rule_of(.5)).time, 1e-12);
    }
    for (const double far : {0x1p20, 0x1p40, 0x1p50}) { // coordinates of which are exact
        Query other = q;
        for (Vec3d& p : other.to) p = p + Vec3d{far, -far, far};
        if (far == 0x1p50) other.to[3] = other.to[3] + Vec3d{0, 0, -.25}; // where 1/4 is the last digit
        const ContactTime found = answer(other);
        ck_assert(found.touches && found.time > 0.4 && found.time <= 0.5);
    }
    Query gone = q; // as far as that all end at one place
    for (Vec3d& p : gone.to) p = p + Vec3d{1e30, 1e30, 1e30};
    ck_assert_double_gt(answer(gone).time, 0.8);
}
END_TEST

// ---- through vox_surface.h ----------------------------------------------------------------------------

constexpr int side = 12;

// Two sheets, one of which falls onto the other.
struct Sheets {
    std::vector<double> from, to;
    std::vector<std::uint32_t> faces;

    explicit Sheets(std::uint64_t seed, double fall) {
        test::Random random{seed};
        for (std::uint32_t sheet = 0; sheet < 2; ++sheet)
            for (int i = 0; i < side * side; ++i)
                from.insert(from.end(), {i % side + .3 * random.unit(), i / side + .3 * random.unit(),
                                         sheet + .4 * random.unit()});
        to = from;
        for (std::size_t i = 3 * side * side + 2; i < to.size(); i += 3) to[i] -= fall;
        for (std::uint32_t sheet = 0; sheet < 2; ++sheet)
            for (std::uint32_t i = 0; i + side + 1 < side * side; ++i) {
                const std::uint32_t v = sheet * side * side + i;
                if (i % side + 1 < side)
                    faces.insert(faces.end(), {v, v + 1, v + side, v + side, v + 1, v + side + 1});
            }
    }
    std::uint64_t vertices() const { return from.size() / 3; }
};

vox_surface* surface_of(const Sheets& s, std::uint32_t workers) {
    vox_surface_desc desc = vox_default_surface_desc();
    desc.worker_count = workers;
    desc.vertex_count = s.vertices();
    desc.faces = s.faces.data();
    desc.face_count = s.faces.size() / 3;
    vox_surface* surface = nullptr;
    ck_ok(vox_surface_create(&desc, &surface));
    return surface;
}

void move(vox_surface* surface, const Sheets& s) {
    vox_motion motion = vox_default_motion();
    motion.from.data = s.from.data();
    motion.to.data = s.to.data();
    motion.from.count = motion.to.count = s.vertices();
    motion.from.format = motion.to.format = VOX_FORMAT_DOUBLE;
    ck_ok(vox_surface_move(surface, &motion));
}

Vec3d point(const std::vector<double>& at, std::uint32_t v) {
    return {at[3 * v], at[3 * v + 1], at[3 * v + 2]};
}

START_TEST(a_safe_step_is_the_least_time_of_all_pairs) {
    std::uint64_t culled = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const Sheets s(seed, seed == 6 ? .1 : .5 + double(seed) / 2);
        std::vector<vox_impact> first_times[2];
        vox_safe_step first_step{};
        for (const std::uint32_t workers : {1u, 3u}) {
            vox_surface* const surface = surface_of(s, workers);
            move(surface, s);
            vox_safe_step step{};
            ck_ok(vox_surface_find_safe_step(surface, nullptr, &step));
            double least = 1;
            vox_feature_view features[3]{};
            for (int kind = 1; kind < 3; ++kind)
                ck_ok(vox_surface_get_features(surface, vox_feature(kind), &features[kind]));
            for (int k = 0; k < 2; ++k) {
                const vox_feature a = k ? VOX_FEATURE_EDGE : VOX_FEATURE_FACE,
                                  b = k ? VOX_FEATURE_EDGE : VOX_FEATURE_VERTEX;
                vox_impact_view view{};
                ck_ok(vox_surface_find_impacts(surface, a, b, nullptr, &view));
                const std::vector<vox_impact> times(view.data, view.data + view.count);
                for (const vox_impact& pair : times) least = std::min(least, pair.time);
                if (workers == 1) {
                    first_times[k] = times;
                } else {
                    ck_assert_uint_eq(times.size(), first_times[k].size());
                    ck_assert(times.empty() || std::memcmp(times.data(), first_times[k].data(),
                                                           times.size() * sizeof times[0]) == 0);
                }
                // By definition: all pairs without a vertex in common.
                std::vector<vox_impact> expected;
                for (std::uint32_t i = 0; i < features[a].count && workers == 1; ++i)
                    for (std::uint32_t j = k ? i + 1 : 0; j < (k ? features[1].count : s.vertices()); ++j) {
                        const std::uint32_t* p = features[a].vertices + (k ? 2 : 3) * i;
                        const std::uint32_t* q = k ? features[1].vertices + 2 * j : &j;
                        Query query;
                        query.edges = k;
                        std::uint32_t corners[4];
                        for (int c = 0; c < 4; ++c) corners[c] = c < (k ? 2 : 3) ? p[c] : q[c - (k ? 2 : 3)];
                        bool shares = false;
                        for (int c = 0; c < 4; ++c) {
                            for (int d = c + 1; d < 4; ++d) shares |= corners[c] == corners[d];
                            query.from[c] = point(s.from, corners[c]);
                            query.to[c] = point(s.to, corners[c]);
                        }
                        if (shares) continue;
                        const ContactTime found = answer(query);
                        if (!found.touches) continue;
                        double nearest = 1;
                        for (int t = 0; t <= 64; ++t)
                            nearest = std::min(nearest, distance_at(query, t / 64.));
                        const bool is_there =
                            std::any_of(times.begin(), times.end(),
                                        [&](const vox_impact& pair) { return pair.a == i && pair.b == j; });
                        ck_assert(is_there || nearest > 1e-6);
                        expected.push_back({i, j, found.time});
                    }
                std::size_t next = 0; // of times; those that are not there were culled
                for (const vox_impact& pair : expected)
                    if (next < times.size() && times[next].a == pair.a && times[next].b == pair.b)
                        ck_assert(times[next++].time == pair.time);
                    else
                        ++culled;
                if (workers == 1) ck_assert_uint_eq(next, times.size());
            }
            ck_assert(step.step == least);
            ck_assert((seed == 6) == (least == 1));
            if (workers == 1)
                first_step = step;
            else
                ck_assert(std::memcmp(&step, &first_step, sizeof step) == 0);
            vox_surface_destroy(surface);
        }
    }
    ck_assert_uint_gt(culled, 0);
}
END_TEST

// Where all moves together, no more is looked at than at rest.
START_TEST(common_motion_costs_nothing) {
    vox_safe_step steps[2];
    std::uint64_t compared[2], overlaps[2];
    for (int far = 0; far < 2; ++far) {
        Sheets s(7, 1);
        for (std::size_t i = 0; far && i < s.to.size(); ++i)
            s.to[i] += i % 3 == 0 ? 48 : i % 3 == 1 ? 51 : 38;
        vox_surface* const surface = surface_of(s, 1);
        move(surface, s);
        ck_ok(vox_surface_find_safe_step(surface, nullptr, &steps[far]));
        compared[far] = surface_counter(surface, "boxes_compared");
        overlaps[far] = surface_counter(surface, "overlaps");
        vox_surface_destroy(surface);
    }
    ck_assert_uint_le(2 * compared[1], 3 * compared[0]);
    ck_assert_uint_le(2 * overlaps[1], 3 * overlaps[0]);
    ck_assert_double_lt(steps[0].step, 1);
    ck_assert_double_eq_tol(steps[0].step, steps[1].step, 1e-6);
}
END_TEST

START_TEST(what_is_refused) {
    const Sheets s(1, 1);
    vox_surface* const surface = surface_of(s, 1);
    vox_safe_step step{};
    step.step = 7;
    ck_fails(vox_surface_find_safe_step(surface, nullptr, &step), VOX_ERROR_INVALID_STATE, "no positions");
    move(surface, s);
    vox_impact_desc desc = vox_default_impact_desc();
    for (const double bad : {-1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
        desc = vox_default_impact_desc();
        desc.distance = bad;
        ck_fails(vox_surface_find_safe_step(surface, &desc, &step), VOX_ERROR_INVALID_ARGUMENT, "distance");
    }
    for (const double bad : {1.0, -1.0, std::nan("")}) {
        desc = vox_default_impact_desc();
        desc.slack = bad;
        ck_fails(vox_surface_find_safe_step(surface, &desc, &step), VOX_ERROR_INVALID_ARGUMENT, "slack");
    }
    vox_impact_view view{};
    ck_fails(vox_surface_find_impacts(surface, VOX_FEATURE_VERTEX, VOX_FEATURE_FACE, nullptr, &view),
             VOX_ERROR_INVALID_ARGUMENT, "VOX_FEATURE_FACE and VOX_FEATURE_VERTEX");
    ck_assert(step.step == 7);
    vox_surface_destroy(surface);
}
END_TEST

} // namespace

SUITE(contact_time) {
    TCase* tests = add_case(suite, "contact_time");
    tcase_add_each(tests, plain_cases, never_later_than_a_time_that_is_known, apart_until_then,
                   any_size_and_common_motion, common_motion_costs_nothing,
                   a_safe_step_is_the_least_time_of_all_pairs, what_is_refused);
}
