// Times of contact, each certified: that the features are further apart than the distance up to then. The
// time is cut into pieces, and for each a direction w is looked for with w . (a_i - b_j) > distance |w| for
// all corners at both ends of the piece; as that is linear in time, it holds throughout the piece. Decided in
// doubles with a bound on their rounding, or else in rational numbers (GMP). Nothing is shared with the
// library but the motion.
//
// Environment: VOX_CERTIFIED_QUERIES, how many. VOX_SAMPLE_QUERIES names a folder with
// https://github.com/Continuous-Collision-Detection/Sample-Queries, whose answers are compared with, too.
#include "base/vectors.hpp"
#include "internal/random.hpp"
#include "internal/rational.hpp"
#include "surface/contact_time.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "support/suite.h" // last: it defines macros with common names

using namespace vox;
using vox::test::Rational;

namespace {

constexpr std::uint32_t numbers[4] = {0, 1, 2, 3};

// A face and a vertex, or two edges, by their corners.
struct Query {
    std::array<Vec3d, 4> from{}, to{};
    bool edges = false;

    std::size_t first_of_b() const { return edges ? 2 : 3; }
};

ContactTime answer(const Query& q, const ContactTimeRule& rule) {
    const std::span<const std::uint32_t> corners(numbers);
    return contact_time({q.from, q.to, 0, true, false}, corners.first(q.first_of_b()),
                        corners.subspan(q.first_of_b()), rule, 1);
}

// ---- the certificate ------------------------------------------------------------------------------

template <class Number>
using Vector = std::array<Number, 3>;

template <class Number>
Vector<Number> vector(const Vec3d& p) {
    return {Number(p.x), Number(p.y), Number(p.z)};
}
template <class Number>
Vector<Number> sum(const Vector<Number>& a, const Number& s, const Vector<Number>& b) {
    return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}
template <class Number>
Vector<Number> difference(const Vector<Number>& a, const Vector<Number>& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class Number>
Number product(const Vector<Number>& a, const Vector<Number>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class Number>
Vector<Number> normal_to(const Vector<Number>& a, const Vector<Number>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class Number>
using Corners = std::array<Vector<Number>, 4>;

template <class Number>
Corners<Number> corners_at(const Query& q, double time) {
    Corners<Number> at;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vector<Number> from = vector<Number>(q.from[i]);
        at[i] = sum(from, Number(time), difference(vector<Number>(q.to[i]), from));
    }
    return at;
}

// From the closest point of the segment ab to p.
template <class Number>
Vector<Number> from_segment(const Vector<Number>& p, const Vector<Number>& a, const Vector<Number>& b) {
    const Vector<Number> along = difference(b, a), way = difference(p, a);
    const Number length = product(along, along), part = product(way, along);
    if (!(Number(0.0) < length) || !(Number(0.0) < part)) return way;
    return length < part ? difference(p, b) : sum(way, Number(0.0) - part / length, along);
}

// Along one of these the features lie apart the furthest.
template <class Number>
std::array<Vector<Number>, 6> directions(const Query& q, const Corners<Number>& c) {
    const auto opposite = [](const Vector<Number>& v) {
        return difference(Vector<Number>{0.0, 0.0, 0.0}, v);
    };
    if (q.edges) {
        const auto normal = normal_to(difference(c[1], c[0]), difference(c[3], c[2]));
        return {from_segment(c[0], c[2], c[3]),
                from_segment(c[1], c[2], c[3]),
                opposite(from_segment(c[2], c[0], c[1])),
                opposite(from_segment(c[3], c[0], c[1])),
                normal,
                opposite(normal)};
    }
    const auto normal = normal_to(difference(c[1], c[0]), difference(c[2], c[0]));
    return {opposite(from_segment(c[3], c[0], c[1])),
            opposite(from_segment(c[3], c[1], c[2])),
            opposite(from_segment(c[3], c[2], c[0])),
            normal,
            opposite(normal),
            Vector<Number>{0.0, 0.0, 0.0}};
}

double largest_coordinate(const Query& q) {
    double most = 0;
    for (const auto* corners : {&q.from, &q.to})
        for (const Vec3d& p : *corners) most = std::max({most, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return most;
}

// A coordinate at a time is off by less than 2^-50 of the largest, a difference of two by 2^-48, and a
// product of w with that by less than 2^-46 |w|1.
bool separates(const Query& q, const Corners<double>& at, const Vector<double>& w, double distance) {
    const double absolute = std::abs(w[0]) + std::abs(w[1]) + std::abs(w[2]), most = largest_coordinate(q);
    if (!(absolute > 0x1p-400 && most > 0x1p-400 && absolute < 0x1p400))
        return false; // rational numbers decide
    const double bound = distance * std::sqrt(product(w, w)) * (1 + 0x1p-40) + 0x1p-46 * most * absolute;
    for (std::size_t i = 0; i < q.first_of_b(); ++i)
        for (std::size_t j = q.first_of_b(); j < 4; ++j)
            if (!(product(w, difference(at[i], at[j])) > bound)) return false;
    return true;
}

bool separates(const Query& q, const Corners<Rational>& at, const Vector<Rational>& w, double distance) {
    const Rational bound = Rational(distance) * Rational(distance) * product(w, w);
    for (std::size_t i = 0; i < q.first_of_b(); ++i)
        for (std::size_t j = q.first_of_b(); j < 4; ++j) {
            const Rational gap = product(w, difference(at[i], at[j]));
            if (gap.sign() <= 0 || !(bound < gap * gap)) return false;
        }
    return true;
}

template <class Number>
bool has_direction(const Query& q, double begin, double end, double distance) {
    const auto at_begin = corners_at<Number>(q, begin), at_end = corners_at<Number>(q, end);
    for (const auto* at : {&at_begin, &at_end})
        for (const Vector<Number>& w : directions(q, *at))
            if (separates(q, at_begin, w, distance) && separates(q, at_end, w, distance)) return true;
    return false;
}

bool stay_apart(const Query& q, double begin, double end, double distance, int most_cuts = 1200) {
    if (has_direction<double>(q, begin, end, distance)) return true;
    const double middle = begin + (end - begin) / 2;
    const bool can_be_cut = most_cuts > 0 && begin < middle && middle < end;
    // Rational numbers take a thousand times as long, so they come where doubles have been tried on small
    // pieces.
    if ((most_cuts % 12 == 0 || !can_be_cut) && has_direction<Rational>(q, begin, end, distance)) return true;
    return can_be_cut && stay_apart(q, begin, middle, distance, most_cuts - 1) &&
           stay_apart(q, middle, end, distance, most_cuts - 1);
}

std::string text_of(const Query& q) {
    std::string text = q.edges ? "edges" : "face and vertex";
    char line[200];
    for (std::size_t i = 0; i < 4; ++i) {
        std::snprintf(line, sizeof line, "\n%a %a %a to %a %a %a", q.from[i].x, q.from[i].y, q.from[i].z,
                      q.to[i].x, q.to[i].y, q.to[i].z);
        text += line;
    }
    return text;
}

ContactTime certified_answer(const Query& q, const ContactTimeRule& rule) {
    const ContactTime found = answer(q, rule);
    ck_assert(found.time >= 0 && found.time <= 1 && (found.touches || found.time == 1));
    const bool is_certain = found.time == 0 || stay_apart(q, 0, found.time, rule.distance);
    ck_assert_msg(is_certain, "not certain until %.17g, distance %g: %s", found.time, rule.distance,
                  text_of(q).c_str());
    return found;
}

// ---- queries --------------------------------------------------------------------------------------

Vec3d uniform(test::Random& random, double size) {
    const auto number = [&] { return size * (2 * random.unit() - 1); };
    const double x = number(), y = number();
    return {x, y, number()};
}

constexpr std::uint32_t families = 10;

Query query_of(test::Random& random, std::uint32_t family, ContactTimeRule& rule) {
    Query q;
    q.edges = random.below(2) == 0;
    for (std::size_t i = 0; i < 4; ++i) {
        q.from[i] = uniform(random, 1);
        q.to[i] = q.from[i] + uniform(random, 2);
    }
    const auto change = [&](auto&& function) {
        for (auto* corners : {&q.from, &q.to})
            for (Vec3d& p : *corners) p = function(p);
    };
    if (family < 3 && random.below(3) == 0) rule.distance = random.unit() / 3;
    if (family == 1) { // small whole numbers: everything degenerate, and touching
        const auto whole = [&] { return double(random.below(5)) - 2; };
        change([&](const Vec3d&) { return Vec3d{whole(), whole(), whole()}; });
    } else if (family == 2) { // far from the origin
        const Vec3d away = uniform(random, 1e6);
        change([&](const Vec3d& p) { return p + away; });
    } else if (family == 3) { // smaller than normal floats
        change([](const Vec3d& p) { return 1e-40 * p; });
    } else if (family == 4) { // any scale
        const double scale = std::ldexp(1, 100 - int(random.below(400)));
        change([&](const Vec3d& p) { return scale * p; });
    } else if (family == 5) { // any floats
        change([&](const Vec3d&) {
            return Vec3d{random.any_finite(), random.any_finite(), random.any_finite()};
        });
    } else if (family == 6) { // all but one corner stand still
        const Vec3d moved = q.to[3];
        q.to = q.from;
        q.to[3] = moved;
    } else if (family == 7) { // all nearly in one plane
        for (std::size_t i = 0; i < 4; ++i) {
            q.from[i].z *= 1e-9;
            q.to[i].z = q.from[i].z * random.below(3);
        }
    } else if (family == 8) { // nearly parallel edges, thin faces, features that keep their shape
        const auto beside = [&](const Vec3d& p) { return p + Vec3d{1, 0, 0} + uniform(random, 1e-9); };
        q.from[1] = beside(q.from[0]);
        if (q.edges) q.from[3] = beside(q.from[2]);
        const Vec3d a = uniform(random, 2), b = uniform(random, 2);
        for (std::size_t i = 0; i < 4; ++i) q.to[i] = q.from[i] + (i < q.first_of_b() ? a : b);
    } else if (family == 9) { // moving far together, and little beside each other
        const Vec3d common = uniform(random, 1e5);
        for (std::size_t i = 0; i < 4; ++i) q.to[i] = q.from[i] + common + 1e-3 * (q.to[i] - q.from[i]);
        rule.distance = random.unit() / 20;
    }
    if (random.below(8) == 0) { // of no length
        q.from[1] = q.from[0];
        q.to[1] = q.to[0];
    }
    return q;
}

START_TEST(never_late) {
    const std::uint64_t queries_wanted = volume_from("VOX_CERTIFIED_QUERIES", 4000);
    test::Random random{3};
    std::array<std::uint64_t, families> touching{}, later{}; // of these, not at the very beginning
    for (std::uint64_t n = 0; n < queries_wanted; ++n) {
        const auto family = static_cast<std::uint32_t>(n % families);
        ContactTimeRule rule{0, random.below(4) == 0 ? 1e-6 : 0.1, 10000};
        const Query q = query_of(random, family, rule);
        const ContactTime found = certified_answer(q, rule);
        touching[family] += found.touches;
        later[family] += found.touches && found.time > 0;
    }
    for (std::uint32_t family = 0; family < families; ++family) {
        std::printf("family %u: of %llu queries %llu touch, %llu of them later than at the beginning\n",
                    family, static_cast<unsigned long long>(queries_wanted / families),
                    static_cast<unsigned long long>(touching[family]),
                    static_cast<unsigned long long>(later[family]));
        if (family != 9 && queries_wanted >= 20000)
            ck_assert_uint_gt(later[family], queries_wanted / families / 100);
    }
}
END_TEST

// A certificate that holds for whatever is claimed would be none.
START_TEST(what_is_late_is_not_certified) {
    test::Random random{4};
    std::uint64_t touching = 0;
    for (std::uint64_t n = 0; n < 300; ++n) {
        Query q;
        q.edges = n % 2 == 0;
        for (std::size_t i = 0; i < 4; ++i) q.from[i] = uniform(random, 8);
        for (std::size_t i = 0; i < 4; ++i) q.to[i] = q.from[i] + uniform(random, 8);
        // They meet at time 1/2, in the middle of an edge, and of an edge or the face.
        const auto half_way = [&](std::size_t i) { return 0.5 * (q.from[i] + q.to[i]); };
        const Vec3d middle = 0.5 * (half_way(0) + half_way(1));
        const Vec3d target = q.edges ? 2 * middle - half_way(2) : middle;
        q.to[3] = 2 * target - q.from[3];
        const double late = 0.5 + 1e-9;
        ck_assert(!stay_apart(q, 0, late, 0, 36));
        ++touching;
    }
    ck_assert_uint_eq(touching, 300);
}
END_TEST

// ---- Sample-Queries -------------------------------------------------------------------------------

START_TEST(sample_queries) {
    const char* const folder = std::getenv("VOX_SAMPLE_QUERIES");
    if (!folder) return;
    std::uint64_t queries = 0, truths = 0, more = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() != ".csv") continue;
        const bool edges = entry.path().parent_path().filename() == "edge-edge";
        std::ifstream file(entry.path());
        std::array<Vec3d, 8> rows;
        std::string line;
        for (std::size_t row = 0; std::getline(file, line); row = (row + 1) % 8) {
            std::replace(line.begin(), line.end(), ',', ' ');
            std::istringstream words(line);
            double number[3];
            for (double& x : number) {
                std::string numerator, denominator;
                words >> numerator >> denominator;
                mpq_t value; // which is a double's
                mpq_init(value);
                ck_assert_int_eq(mpq_set_str(value, (numerator + "/" + denominator).c_str(), 10), 0);
                mpq_canonicalize(value);
                x = mpq_get_d(value);
                mpq_clear(value);
            }
            int truth = 0;
            ck_assert(words >> truth);
            rows[row] = {number[0], number[1], number[2]};
            if (row < 7) continue;
            Query q;
            q.edges = edges;
            for (std::size_t i = 0; i < 4; ++i) { // the vertex comes before the face there
                const std::size_t at = edges ? i : (i + 1) % 4;
                q.from[i] = rows[at];
                q.to[i] = rows[4 + at];
            }
            const ContactTime found = certified_answer(q, {0, 1e-6, 10000});
            ck_assert_msg(found.touches || !truth, "a contact is not seen: %s", text_of(q).c_str());
            ++queries;
            truths += truth != 0;
            more += found.touches && !truth;
        }
    }
    std::printf("%llu sample queries, %llu of them in contact, %llu more taken for it\n",
                static_cast<unsigned long long>(queries), static_cast<unsigned long long>(truths),
                static_cast<unsigned long long>(more));
    ck_assert_uint_gt(queries, 0);
}
END_TEST

} // namespace

SUITE(contact_time_certified) {
    TCase* tests = add_case(suite, "contact_time_certified");
    tcase_add_each(tests, never_late, what_is_late_is_not_certified, sample_queries);
}
