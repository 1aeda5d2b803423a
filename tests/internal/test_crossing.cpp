// Compares where segments meet triangles with what rational numbers (GMP) say: by clipping the segment
// against the triangle, which is another way than that of the library.
//
// Environment: VOX_CROSSING_CASES, how many of each kind.
#include "exact/crossing.hpp"
#include "exact/facet_normal.hpp"
#include "grid/surface_search.hpp"
#include "internal/random.hpp"
#include "internal/rational.hpp"
#include "support/suite.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

using namespace vox;

namespace {

// ---- vectors of rational numbers ------------------------------------------------------------------

using Vector = std::array<Rational, 3>;

Vector vector(const Vec3d& p) { return {p.x, p.y, p.z}; }
Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Rational dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
bool is_zero(const Vector& v) { return v[0].sign() == 0 && v[1].sign() == 0 && v[2].sign() == 0; }
Vector combined(const Rational& s, const Vector& a, const Rational& t, const Vector& b) {
    return {s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]};
}

// ---- by clipping ----------------------------------------------------------------------------------

struct Case {
    Vec3d p, q, a, b, c;
};

// The part [low, high] of a segment's parameters; empty when low > high.
struct Part {
    Rational low = 0, high = 1;

    bool empty() const { return high < low; }
    // Keeps where f(t) >= 0, f being linear with these values at 0 and 1.
    void clip(const Rational& at_0, const Rational& at_1) {
        if (at_0.sign() >= 0 && at_1.sign() >= 0) return;
        if (at_0.sign() < 0 && at_1.sign() < 0) {
            low = 1;
            high = 0;
            return;
        }
        const Rational zero = at_0 / (at_0 - at_1);
        if (at_0.sign() < 0) {
            if (low < zero) low = zero;
        } else if (zero < high) {
            high = zero;
        }
    }
};

struct Truth {
    CrossingKind kind = CrossingKind::none;
    Rational t; // of the point, where it is the only one: through and touching
};

// Where the segment from p to q meets that from r to s: in two planes through it and in its extent.
bool segments_meet(const Vector& p, const Vector& q, const Vector& r, const Vector& s) {
    const Vector d = s - r;
    Part part;
    if (is_zero(d)) {
        for (std::size_t i = 0; i < 3; ++i) {
            part.clip(p[i] - r[i], q[i] - r[i]);
            part.clip(r[i] - p[i], r[i] - q[i]);
            if (part.empty()) return false;
        }
        return true;
    }
    for (std::size_t i = 0; i < 3; ++i) { // on the line of rs, the cross product with its direction is zero
        const Rational at_p = cross(p - r, d)[i], at_q = cross(q - r, d)[i];
        part.clip(at_p, at_q);
        if (part.empty()) return false;
        part.clip(Rational(0) - at_p, Rational(0) - at_q);
        if (part.empty()) return false;
    }
    part.clip(dot(p - r, d), dot(q - r, d));
    if (part.empty()) return false;
    part.clip(dot(s - p, d), dot(s - q, d));
    return !part.empty();
}

Truth truth_of(const Case& of) {
    const Vector p = vector(of.p), q = vector(of.q), corner[3] = {vector(of.a), vector(of.b), vector(of.c)};
    const Vector normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
    Truth truth;
    if (is_zero(normal)) {
        for (std::size_t i = 0; i < 3; ++i)
            if (segments_meet(p, q, corner[i], corner[(i + 1) % 3])) truth.kind = CrossingKind::coplanar;
        return truth;
    }
    const Rational of_p = dot(normal, p - corner[0]), of_q = dot(normal, q - corner[0]);
    Part part;
    part.clip(of_p, of_q);
    if (part.empty()) return truth;
    part.clip(Rational(0) - of_p, Rational(0) - of_q);
    bool on_side = false;
    for (int i = 0; i < 3; ++i) {
        if (part.empty()) return truth;
        const Vector inwards = cross(normal, corner[(i + 1) % 3] - corner[i]);
        const Rational at_p = dot(inwards, p - corner[i]), at_q = dot(inwards, q - corner[i]);
        part.clip(at_p, at_q);
        if (!part.empty()) on_side |= (at_p + part.low * (at_q - at_p)).sign() == 0;
    }
    if (part.empty()) return truth;
    truth.t = part.low;
    if (of_p.sign() == 0 && of_q.sign() == 0)
        truth.kind = CrossingKind::coplanar;
    else if (on_side || of_p.sign() == 0 || of_q.sign() == 0)
        truth.kind = CrossingKind::touching;
    else
        truth.kind = CrossingKind::through;
    return truth;
}

// The largest coordinate of a vector in magnitude.
double size_of(const Vector& v) {
    return std::max({std::abs(v[0].rounded()), std::abs(v[1].rounded()), std::abs(v[2].rounded())});
}

// The same on both, and where the caller is told.
void check_point(const Case& of, const Crossing& found, const Truth& truth) {
    double edge_sum = 0, face_sum = 0;
    for (const double w : found.edge_weights) {
        ck_assert(w >= 0 && w <= 1);
        edge_sum += w;
    }
    for (const double w : found.face_weights) {
        ck_assert(w >= 0 && w <= 1);
        face_sum += w;
    }
    ck_assert_double_le(std::abs(edge_sum - 1), 1e-15);
    ck_assert_double_le(std::abs(face_sum - 1), 1e-15);
    const Vector p = vector(of.p), q = vector(of.q), a = vector(of.a), b = vector(of.b), c = vector(of.c);
    // From corners, so that it is in proportion to the edge and the face, not to the coordinates.
    const Vector on_edge = combined(found.edge_weights[1], q - p, 1, p);
    const Vector on_face =
        combined(1, a, 1, combined(found.face_weights[1], b - a, found.face_weights[2], c - a));
    const double size = std::max({size_of(q - p), size_of(b - a), size_of(c - a)});
    const double slack = 0x1p-36 * size;
    ck_assert_double_le(size_of(on_edge - on_face), slack);
    const double most = std::max({size_of(p), size_of(q), size_of(a), size_of(b), size_of(c)});
    ck_assert_double_le(size_of(vector(found.position) - on_edge), slack + 0x1p-51 * most);
    if (truth.kind == CrossingKind::coplanar) return;
    ck_assert_double_le(std::abs((truth.t - Rational(found.edge_weights[1])).rounded()), 0x1p-38);
    if (truth.t.sign() == 0) ck_assert(found.edge_weights[1] == 0 && found.edge_weights[0] == 1);
    if ((truth.t - 1).sign() == 0) ck_assert(found.edge_weights[0] == 0 && found.edge_weights[1] == 1);
}

// Whether lanes of floats say that the line of the segment passes beside the triangle.
bool is_beside(const Case& of) {
    static const SurfaceFeatures features = [] {
        SurfaceFeatures one(std::pmr::get_default_resource());
        one.faces.push_back({0, 1, 2});
        return one;
    }();
    const SurfaceTile tile{0, 0, 0, 0, 3, 1, 0, 0};
    const Vec3d corners[3] = {of.a, of.b, of.c};
    FaceLines lines;
    load_lines(features, tile, corners, lines);
    const Segment segment{of.p, of.q};
    std::uint32_t met = 1;
    keep_crossed(&segment, 1, lines, &met);
    return met == 0;
}

void check_normal(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d normal = triangle_normal(a, b, c);
    const Vector exact = cross(vector(b) - vector(a), vector(c) - vector(a));
    Rational largest = 0;
    for (const Rational& x : exact) {
        const Rational size = x.sign() < 0 ? Rational(0) - x : x;
        if (largest < size) largest = size;
    }
    if (largest.sign() == 0) return ck_assert(length(normal) == 0);
    const Vec3d way{(exact[0] / largest).rounded(), (exact[1] / largest).rounded(),
                    (exact[2] / largest).rounded()};
    ck_assert_double_le(length(normal - normalised(way)), 0x1p-28);
}

std::uint64_t counts[4], beside = 0, beside_in_lanes = 0;

void check(const Case& of) {
    std::uint64_t exact_tests = 0;
    const Crossing found = find_crossing(of.p, of.q, of.a, of.b, of.c, exact_tests);
    const Truth truth = truth_of(of);
    ck_assert_msg(found.kind == truth.kind,
                  "kind %d, expected %d: (%a %a %a) (%a %a %a) (%a %a %a) (%a %a %a) (%a %a %a)",
                  static_cast<int>(found.kind), static_cast<int>(truth.kind), of.p.x, of.p.y, of.p.z, of.q.x,
                  of.q.y, of.q.z, of.a.x, of.a.y, of.a.z, of.b.x, of.b.y, of.b.z, of.c.x, of.c.y, of.c.z);
    ++counts[static_cast<int>(found.kind)];
    if (found.kind != CrossingKind::none) check_point(of, found, truth);
    // What is certain in doubles is so.
    if (found.kind != CrossingKind::none) {
        ck_assert(!TrianglePlane(of.a, of.b, of.c).has_on_one_side(of.p, of.q));
        ck_assert(!passes_beside(of.p, of.q, of.a, of.b, of.c));
        ck_assert(!is_beside(of));
    }
    beside += passes_beside(of.p, of.q, of.a, of.b, of.c);
    beside_in_lanes += is_beside(of);
    check_normal(of.a, of.b, of.c);
    // The kind is one of the sets of points, in whatever order they are named.
    const Crossing turned = find_crossing(of.q, of.p, of.c, of.a, of.b, exact_tests);
    const Crossing mirrored = find_crossing(of.p, of.q, of.b, of.a, of.c, exact_tests);
    ck_assert(turned.kind == found.kind && mirrored.kind == found.kind);
}

// ---- kinds of points ------------------------------------------------------------------------------

using Coordinate = double (*)(Random&);

double tiny_grid(Random& r) { return r.below(3); }
double small_grid(Random& r) { return r.below(5); }
double fine_grid(Random& r) { return r.below(65) / 16.0 - 2.0; }
double unit_range(Random& r) { return 2 * r.unit() - 1; }
double floats(Random& r) { return r.uniform(-1, 1); }
double far_away(Random& r) { return 1e15 + (8 * r.unit() - 4); }
double few_ulps(Random& r) { return 0.5 + r.below(5) * 0x1p-53; }
double denormal(Random& r) { return r.below(9) * DBL_TRUE_MIN; }
double vanishing(Random& r) { return std::ldexp(2 * r.unit() - 1, -358 + static_cast<int>(r.below(20))); }
double exponents_apart(Random& r) {
    return std::ldexp(2 * r.unit() - 1, static_cast<int>(r.below(1100)) - 974);
}
double mixed(Random& r) {
    constexpr double sizes[] = {1e30, 1, 1e-30, 0};
    return sizes[r.below(4)] * (r.below(2) ? 1 : 2 * r.unit() - 1);
}
double huge(Random& r) { return (2 * r.unit() - 1) * FLT_MAX; }
constexpr Coordinate coordinates[] = {tiny_grid, small_grid, fine_grid, unit_range,      floats, far_away,
                                      few_ulps,  denormal,   vanishing, exponents_apart, mixed,  huge};

Vec3d point(Coordinate make, Random& r) {
    const double x = make(r), y = make(r);
    return {x, y, make(r)};
}

Vec3d blend(const Vec3d& a, const Vec3d& b, double t) {
    return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

Case any(Coordinate make, Random& r) {
    return {point(make, r), point(make, r), point(make, r), point(make, r), point(make, r)};
}

// Some points in place of others, on lines and planes through others as nearly as doubles can be.
Case degenerate(Coordinate make, Random& r) {
    Case c = any(make, r);
    Vec3d* const all[5] = {&c.p, &c.q, &c.a, &c.b, &c.c};
    const int changes = 1 + static_cast<int>(r.below(3));
    for (int i = 0; i < changes; ++i) {
        Vec3d& changed = *all[r.below(5)];
        const Vec3d &x = *all[r.below(5)], &y = *all[r.below(5)], &z = *all[r.below(5)];
        const double t = r.below(2) ? r.below(5) / 4.0 : r.unit();
        switch (r.below(5)) {
        case 0:
            changed = x;
            break;
        case 1:
            changed = blend(x, y, t);
            break;
        case 2:
            changed = blend(blend(x, y, t), z, r.below(5) / 4.0);
            break;
        case 3:
            changed = {2 * x.x - y.x, 2 * x.y - y.y, 2 * x.z - y.z};
            break;
        default: // in one axis-aligned plane
            for (Vec3d* p : all) p->z = c.a.z;
        }
    }
    return c;
}

// The segment goes through a point of the triangle, as nearly as doubles can be.
Case aimed(Coordinate make, Random& r) {
    Case c = any(make, r);
    const double u = r.below(2) ? r.below(5) / 4.0 : r.unit();
    const Vec3d target = blend(blend(c.a, c.b, u), c.c, r.below(2) ? r.below(5) / 4.0 : r.unit());
    const double t = r.below(4) ? 0.25 + r.unit() : 1;
    c.q = blend(c.p, target, 1 / t);
    return c;
}

bool in_range(const Case& c) {
    for (const Vec3d& p : {c.p, c.q, c.a, c.b, c.c})
        for (const double x : {p.x, p.y, p.z})
            if (!(std::abs(x) < 0x1p128)) return false;
    return true;
}

void check_cases(Case (*make)(Coordinate, Random&)) {
    std::fill(std::begin(counts), std::end(counts), 0);
    const std::uint64_t cases = volume_from("VOX_CROSSING_CASES", 2000);
    std::uint64_t seed = 0;
    for (const Coordinate coordinate : coordinates) {
        Random r{++seed};
        for (std::uint64_t i = 0; i < cases; ++i)
            if (const Case c = make(coordinate, r); in_range(c)) check(c);
    }
    for (const std::uint64_t count : counts) ck_assert_uint_gt(count, 0);
    ck_assert_uint_gt(10 * beside_in_lanes, 6 * beside);
}

// Most segments meet no triangle here, and some of the small grids do in every way.
START_TEST(random_cases_equal_rational_arithmetic) { check_cases(any); }
END_TEST

START_TEST(degenerate_cases_equal_rational_arithmetic) { check_cases(degenerate); }
END_TEST

START_TEST(aimed_cases_equal_rational_arithmetic) { check_cases(aimed); }
END_TEST

// All segments and triangles of a small lattice in a plane: every way of being degenerate.
START_TEST(all_of_a_lattice) {
    const auto at = [](int i, bool in_space) {
        return in_space ? Vec3d{double(i & 1), double(i >> 1 & 1), double(i >> 2 & 1)}
                        : Vec3d{double(i % 3), double(i / 3), 1.0};
    };
    for (const bool in_space : {false, true}) {
        const int count = in_space ? 8 : 6;
        for (int code = 0; code < count * count * count * count * count; ++code) {
            int rest = code;
            Vec3d p[5];
            for (Vec3d& v : p) {
                v = at(rest % count, in_space);
                rest /= count;
            }
            check({p[0], p[1], p[2], p[3], p[4]});
        }
    }
}
END_TEST

// The common points that the header promises, where there are several.
START_TEST(first_of_several_points) {
    std::uint64_t exact_tests = 0;
    const Vec3d a{0, 0, 0}, b{4, 0, 0}, c{0, 4, 0};
    // An end in the triangle comes first, then the other end, then the first side.
    Crossing found = find_crossing({1, 1, 0}, {2, 1, 0}, a, b, c, exact_tests);
    ck_assert(found.kind == CrossingKind::coplanar && found.edge_weights[0] == 1 && found.position.x == 1);
    found = find_crossing({-1, 1, 0}, {1, 1, 0}, a, b, c, exact_tests);
    ck_assert(found.kind == CrossingKind::coplanar && found.edge_weights[1] == 1 && found.position.x == 1);
    found = find_crossing({1, -1, 0}, {1, 9, 0}, a, b, c, exact_tests);
    ck_assert(found.kind == CrossingKind::coplanar && found.position.y == 0 && found.face_weights[2] == 0);
    ck_assert(found.face_weights[0] == 0.75 && found.face_weights[1] == 0.25);
    // Through the inside, through a side, through a corner.
    found = find_crossing({1, 1, -1}, {1, 1, 3}, a, b, c, exact_tests);
    ck_assert(found.kind == CrossingKind::through && found.edge_weights[0] == 0.75);
    ck_assert(found.face_weights[0] == 0.5 && found.face_weights[1] == 0.25 && found.position.z == 0);
    found = find_crossing({1, 0, -1}, {1, 0, 3}, a, b, c, exact_tests);
    ck_assert(found.kind == CrossingKind::touching && found.face_weights[2] == 0);
    found = find_crossing({0, 0, -1}, {0, 0, 3}, a, b, c, exact_tests);
    ck_assert(found.kind == CrossingKind::touching && found.face_weights[0] == 1);
    // An end within the triangle.
    found = find_crossing({1, 1, 0}, {1, 1, 3}, a, b, c, exact_tests);
    ck_assert(found.kind == CrossingKind::touching && found.edge_weights[0] == 1);
}
END_TEST

} // namespace

SUITE(crossing) {
    TCase* tests = add_case(suite, "exactness");
    tcase_add_each(tests, random_cases_equal_rational_arithmetic, degenerate_cases_equal_rational_arithmetic,
                   aimed_cases_equal_rational_arithmetic, all_of_a_lattice, first_of_several_points);
}
