// What points see of rigid shapes: inside by rational numbers, distances by them and by loops over all
// triangles. Many points are exactly on the surface.
#include "base/vectors.hpp"
#include "internal/random.hpp"
#include "internal/rational.hpp"
#include "shape/shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory_resource>
#include <vector>

#include "support/suite.h" // last: it defines macros with common names

using namespace vox;

namespace {

using Real = long double;
using Point = std::array<Real, 3>;
using Triangle = std::array<std::uint32_t, 3>;

// A shape, and what it was made from.
struct Sample {
    vox_shape_desc desc = vox_default_shape_desc();
    std::vector<double> points; // x y z each
    std::vector<Triangle> triangles;
    std::vector<double> heights;

    std::shared_ptr<const RigidShape> make() {
        desc.positions = vox_double_positions(points.data(), points.size() / 3);
        desc.triangles = triangles.empty() ? nullptr : triangles[0].data();
        desc.triangle_count = triangles.size();
        desc.heights = heights.data();
        return make_shape(desc, std::pmr::get_default_resource());
    }
    Vec3d point(std::uint32_t i) const { return {points[3 * i], points[3 * i + 1], points[3 * i + 2]}; }
};

Rational squared(double x) { return Rational(x) * Rational(x); }

// ---- inside, by rational numbers ------------------------------------------------------------------

struct RationalPoint {
    Rational x, y, z;
    RationalPoint(const Vec3d& p) : x(p.x), y(p.y), z(p.z) {}
    RationalPoint(const Rational& a, const Rational& b, const Rational& c) : x(a), y(b), z(c) {}
    friend RationalPoint operator-(const RationalPoint& a, const RationalPoint& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
};
Rational dot_of(const RationalPoint& a, const RationalPoint& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
RationalPoint cross_of(const RationalPoint& a, const RationalPoint& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

bool is_on_segment(const RationalPoint& p, const RationalPoint& a, const RationalPoint& b) {
    const RationalPoint ab = b - a, ap = p - a, across = cross_of(ab, ap);
    if (dot_of(ab, ab).sign() == 0) return dot_of(ap, ap).sign() == 0;
    return dot_of(across, across).sign() == 0 && dot_of(ap, ab).sign() >= 0 && dot_of(p - b, ab).sign() <= 0;
}

bool is_on_triangle(const RationalPoint& p, const RationalPoint& a, const RationalPoint& b,
                    const RationalPoint& c) {
    if (is_on_segment(p, a, b) || is_on_segment(p, b, c) || is_on_segment(p, c, a)) return true;
    const RationalPoint normal = cross_of(b - a, c - a);
    if (dot_of(normal, normal).sign() == 0 || dot_of(p - a, normal).sign() != 0) return false;
    return dot_of(cross_of(b - a, p - a), normal).sign() >= 0 &&
           dot_of(cross_of(c - b, p - b), normal).sign() >= 0 &&
           dot_of(cross_of(a - c, p - c), normal).sign() >= 0;
}

bool is_on_triangles(const Sample& s, const Vec3d& p) {
    return std::ranges::any_of(s.triangles, [&](const Triangle& t) {
        return is_on_triangle(p, s.point(t[0]), s.point(t[1]), s.point(t[2]));
    });
}

// How often the surface goes around p, which is not on it: triangles that a ray meets, in a direction in
// which it meets no edge.
int turns_around(const Sample& s, const Vec3d& at, Random& random) {
    for (;;) {
        const RationalPoint p(at), way(Vec3d{random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5});
        int turns = 0;
        bool is_clear = true;
        for (const Triangle& t : s.triangles) {
            const RationalPoint a = RationalPoint(s.point(t[0])) - p, b = RationalPoint(s.point(t[1])) - p,
                                c = RationalPoint(s.point(t[2])) - p;
            const int of[3] = {dot_of(way, cross_of(a, b)).sign(), dot_of(way, cross_of(b, c)).sign(),
                               dot_of(way, cross_of(c, a)).sign()};
            const int most = *std::max_element(of, of + 3), least = *std::min_element(of, of + 3);
            if (most > 0 && least < 0) continue;
            const RationalPoint normal = cross_of(b - a, c - a);
            if (most == 0 && least == 0 && dot_of(normal, normal).sign() == 0) continue; // no area
            if (most * least == 0) is_clear = false;
            if (dot_of(normal, a).sign() == most) turns += most; // ahead
        }
        if (is_clear) return turns;
    }
}

// In whose cell p is, by lines that are rounded as the shape's are.
bool is_below(const Sample& s, const Vec3d& p) {
    const auto x = [&](std::uint32_t column) { return column * s.desc.spacing[0]; };
    const auto y = [&](std::uint32_t row) { return row * s.desc.spacing[1]; };
    for (std::uint32_t row = 0; row + 1 < s.desc.rows; ++row)
        for (std::uint32_t column = 0; column + 1 < s.desc.columns; ++column) {
            if (!(x(column) <= p.x && p.x <= x(column + 1) && y(row) <= p.y && p.y <= y(row + 1))) continue;
            const Rational u = (Rational(p.x) - x(column)) / (Rational(x(column + 1)) - x(column)),
                           v = (Rational(p.y) - y(row)) / (Rational(y(row + 1)) - y(row));
            const auto height = [&](std::uint32_t dx, std::uint32_t dy) {
                return Rational(s.heights[(row + dy) * s.desc.columns + column + dx]);
            };
            const Rational low = height(0, 0), high = height(1, 1);
            const Rational z = v < u ? low + u * (height(1, 0) - low) + v * (high - height(1, 0))
                                     : low + v * (height(0, 1) - low) + u * (high - height(0, 1));
            return (Rational(p.z) - z).sign() <= 0;
        }
    return false;
}

bool is_inside(const Sample& s, const Vec3d& p, Random& random) {
    const vox_shape_desc& d = s.desc;
    const Rational flat = squared(p.x) + squared(p.y), limit = squared(d.radius);
    switch (d.kind) {
    case VOX_SHAPE_HALF_SPACE:
        return p.z <= 0;
    case VOX_SHAPE_SPHERE:
        return (flat + squared(p.z) - limit).sign() <= 0;
    case VOX_SHAPE_CAPSULE: {
        const Rational along = Rational(p.z) - std::clamp(p.z, -d.half_length, d.half_length);
        return (flat + along * along - limit).sign() <= 0;
    }
    case VOX_SHAPE_CYLINDER:
        return (flat - limit).sign() <= 0 && std::abs(p.z) <= d.half_length;
    case VOX_SHAPE_BOX:
        return std::abs(p.x) <= d.half_size[0] && std::abs(p.y) <= d.half_size[1] &&
               std::abs(p.z) <= d.half_size[2];
    case VOX_SHAPE_HEIGHTFIELD:
        return is_below(s, p);
    case VOX_SHAPE_SOLID:
        return is_on_triangles(s, p) || turns_around(s, p, random) != 0;
    default:
        return is_on_triangles(s, p);
    }
}

// ---- distances ------------------------------------------------------------------------------------

Real product(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point sum(const Point& a, Real t, const Point& b) {
    return {a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]};
}
Point real(const Vec3d& p) { return {p.x, p.y, p.z}; }

Real to_segment(const Point& p, const Point& a, const Point& b) {
    const Point ab = sum(b, -1, a), ap = sum(p, -1, a);
    const Real length = product(ab, ab),
               t = length > 0 ? std::clamp<Real>(product(ap, ab) / length, 0, 1) : 0;
    const Point way = sum(ap, -t, ab);
    return std::sqrt(product(way, way));
}

Real to_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
    const auto cross = [](const Point& u, const Point& v) {
        return Point{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    };
    const Point corner[3] = {a, b, c}, normal = cross(sum(b, -1, a), sum(c, -1, a));
    const Real area = product(normal, normal);
    bool is_over = area > 0;
    for (int i = 0; i < 3; ++i) {
        const Point &from = corner[i], &to = corner[(i + 1) % 3];
        is_over = is_over && product(cross(sum(to, -1, from), sum(p, -1, from)), normal) >= 0;
    }
    if (is_over) return std::abs(product(sum(p, -1, a), normal)) / std::sqrt(area);
    return std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
}

Real to_one(const Sample& s, std::uint32_t triangle, const Point& p) {
    const Triangle& t = s.triangles[triangle];
    return to_triangle(p, real(s.point(t[0])), real(s.point(t[1])), real(s.point(t[2])));
}

// Of a heightfield, made from its heights.
void add_cells(Sample& s) {
    const std::uint32_t columns = s.desc.columns;
    for (std::uint32_t row = 0; row < s.desc.rows; ++row)
        for (std::uint32_t column = 0; column < columns; ++column) {
            const std::uint32_t at = row * columns + column;
            for (const double x : {column * s.desc.spacing[0], row * s.desc.spacing[1], s.heights[at]})
                s.points.push_back(x);
            if (row + 1 == s.desc.rows || column + 1 == columns) continue;
            s.triangles.push_back({at, at + 1, at + columns + 1});
            s.triangles.push_back({at, at + columns + 1, at + columns});
        }
}

// From the surface, and not negative.
Real distance(const Sample& s, const Point& p) {
    const vox_shape_desc& d = s.desc;
    const Real along = std::abs(p[2]) - d.half_length, flat = std::hypot(p[0], p[1]);
    switch (d.kind) {
    case VOX_SHAPE_HALF_SPACE:
        return std::abs(p[2]);
    case VOX_SHAPE_SPHERE:
        return std::abs(std::hypot(flat, p[2]) - d.radius);
    case VOX_SHAPE_CAPSULE:
        return std::abs(std::hypot(flat, std::max<Real>(along, 0)) - d.radius);
    case VOX_SHAPE_CYLINDER:
        if (flat <= d.radius && along <= 0) return -std::max(flat - d.radius, along);
        return std::hypot(std::max<Real>(flat - d.radius, 0), std::max<Real>(along, 0));
    case VOX_SHAPE_BOX: {
        Real beyond[3], most = -std::numeric_limits<Real>::infinity();
        for (std::size_t i = 0; i < 3; ++i)
            most = std::max(most, beyond[i] = std::abs(p[i]) - d.half_size[i]);
        if (most <= 0) return -most;
        for (Real& x : beyond) x = std::max<Real>(x, 0);
        return std::hypot(beyond[0], beyond[1], beyond[2]);
    }
    default: {
        Real least = std::numeric_limits<Real>::infinity();
        for (std::uint32_t t = 0; t < s.triangles.size(); ++t) least = std::min(least, to_one(s, t, p));
        return std::abs(least - d.radius);
    }
    }
}

// Whether |found - sqrt(square) + less| is at most a unit in the last place of `found`.
bool is_within_unit(double found, const Rational& square, double less) {
    const double low = std::nextafter(found, -unlimited), high = std::nextafter(found, unlimited);
    const Rational above = Rational(high) + less, below = Rational(low) + less;
    return above.sign() >= 0 && (above * above - square).sign() >= 0 &&
           (below.sign() <= 0 || (below * below - square).sign() <= 0);
}

void check_last_place(const Sample& s, const Vec3d& p, const ShapePoint& seen) {
    const vox_shape_desc& d = s.desc;
    if (d.kind == VOX_SHAPE_HALF_SPACE) ck_assert(seen.distance == p.z);
    if (d.kind == VOX_SHAPE_SPHERE)
        ck_assert(is_within_unit(seen.distance, squared(p.x) + squared(p.y) + squared(p.z), d.radius));
    if (d.kind != VOX_SHAPE_BOX) return;
    const double at[3] = {p.x, p.y, p.z};
    Rational square = 0, most = Rational(-1) / Rational(1e-300);
    for (int i = 0; i < 3; ++i) {
        const Rational beyond = Rational(std::abs(at[i])) - d.half_size[i];
        if (most < beyond) most = beyond;
        if (beyond.sign() > 0) square = square + beyond * beyond;
    }
    if (seen.is_inside)
        ck_assert(seen.distance == most.rounded() || is_within_unit(-seen.distance, most * most, 0));
    else
        ck_assert_msg(is_within_unit(seen.distance, square, 0), "%.17g", seen.distance);
}

// ---- points ---------------------------------------------------------------------------------------

// What a point sees, if it sees anything. Returns whether it is exactly on the surface, to rounding.
bool check(const Sample& s, const RigidShape& shape, const Vec3d& p, double size, Random& random) {
    ShapePoint seen, again;
    ck_assert(shape.look(p, unlimited, seen));
    const bool is_thick = s.desc.kind == VOX_SHAPE_SHEET && s.desc.radius > 0;
    if (!is_thick)
        ck_assert_msg(seen.is_inside == is_inside(s, p, random),
                      "kind %d at %.17g %.17g %.17g: %d, triangle %u", s.desc.kind, p.x, p.y, p.z,
                      seen.is_inside, seen.element);
    else
        ck_assert(seen.is_inside == (seen.distance <= 0));
    ck_assert(seen.is_inside ? seen.distance <= 0 : seen.distance >= 0);
    const Real true_distance = distance(s, real(p)), off = std::abs(seen.distance) - true_distance;
    ck_assert_msg(std::abs(off) <= 1e-14L * size, "kind %d at %.17g %.17g %.17g: %.17g, off by %.3Lg",
                  s.desc.kind, p.x, p.y, p.z, seen.distance, off);
    check_last_place(s, p, seen);
    // The normal leads to the surface.
    ck_assert(std::abs(length(seen.normal) - 1) < 1e-14);
    const Point on = sum(real(p), -Real(seen.distance), real(seen.normal));
    if (s.triangles.empty()) {
        ck_assert(distance(s, on) < 1e-13L * size);
        ck_assert_uint_eq(seen.element, VOX_NONE);
    } else {
        ck_assert_uint_lt(seen.element, s.triangles.size());
        const Real to_its = std::abs(to_one(s, seen.element, real(p)) - s.desc.radius);
        ck_assert(std::abs(to_its - true_distance) <= 2e-14L * size);
        const Real from_its = to_one(s, seen.element, on) - s.desc.radius;
        ck_assert_msg(std::abs(from_its) < 1e-11L * size, "kind %d: %.3Lg at %.3g", s.desc.kind,
                      from_its / size, seen.distance / size);
    }
    if (!s.triangles.empty() && s.desc.radius == 0 && is_on_triangles(s, p)) ck_assert(seen.distance == 0);
    // Within a reach, and seen from afar.
    for (const double reach : {0.0, 0.5 * seen.distance, seen.distance, 2 * seen.distance}) {
        if (!(reach >= 0)) continue;
        const bool in_reach = shape.look(p, reach, again);
        if (in_reach) ck_assert(seen.distance <= reach);
        if (seen.is_inside || seen.distance < reach - 1e-15 * size) ck_assert(in_reach);
        if (in_reach)
            ck_assert(again.distance == seen.distance && again.element == seen.element &&
                      again.normal.x == seen.normal.x && again.normal.z == seen.normal.z);
        for (const double radius : {0.0, 0.1 * size, size})
            if (in_reach)
                ck_assert(!shape.is_beyond({p.x + 0.57 * radius, p.y - 0.57 * radius, p.z + 0.57 * radius},
                                           radius, reach));
    }
    return true_distance < 1e-15L * size;
}

double on_lattice(Random& random) { return (double(random.below(17)) - 8) / 4; }

// Lattices, where many are on surfaces; anywhere; and a few units in the last place beside.
Vec3d any_point(Random& random, double size) {
    Vec3d p{on_lattice(random), on_lattice(random), on_lattice(random)};
    switch (random.below(4)) {
    case 0:
        p = {4 * random.unit() - 2, 4 * random.unit() - 2, 4 * random.unit() - 2};
        break;
    case 1:
        p.x = std::nextafter(p.x, random.below(2) ? 9 : -9);
        break;
    case 2:
        p.z = std::nextafter(p.z, random.below(2) ? 9 : -9);
        break;
    default:
        break;
    }
    return size * p;
}

double length_of(Random& random) {
    switch (random.below(5)) {
    case 0:
        return 0;
    case 1:
        return random.unit();
    case 2:
        return 1.25; // 0.75, 1, 1.25 is a right triangle
    default:
        return random.below(8) / 4.;
    }
}

// Cubes of a lattice, glued where they meet, and sheared to one side; or any surface with the facets of an
// octahedron, through itself.
void add_surface(Sample& s, Random& random) {
    if (random.below(3) == 0) {
        for (int i = 0; i < 18; ++i) s.points.push_back(on_lattice(random));
        for (std::uint32_t i = 0; i < 8; ++i) {
            const std::uint32_t x = i & 1, y = 2 + (i >> 1 & 1), z = 4 + (i >> 2);
            s.triangles.push_back(((i ^ i >> 1 ^ i >> 2) & 1) ? Triangle{y, x, z} : Triangle{x, y, z});
        }
        double volume = 0;
        for (const Triangle& t : s.triangles)
            volume += determinant(s.point(t[0]), s.point(t[1]), s.point(t[2]));
        if (volume < 0) // inside out
            for (Triangle& t : s.triangles) std::swap(t[0], t[1]);
        return;
    }
    constexpr std::uint32_t cubes = 3, lines = cubes + 1;
    const double shear = random.below(3) / 4.;
    for (std::uint32_t i = 0; i < lines * lines * lines; ++i) {
        const double x = i % lines - 1.5, y = i / lines % lines - 1.5, z = i / (lines * lines) - 1.5;
        for (const double c : {x + shear * y, y, z - shear * x}) s.points.push_back(c);
    }
    bool is_full[lines + 1][lines + 1][lines + 1] = {};
    for (std::uint32_t i = 0; i < cubes * cubes * cubes; ++i)
        is_full[i / 9 + 1][i / 3 % 3 + 1][i % 3 + 1] = random.below(2) != 0;
    is_full[2][2][2] = true;
    for (std::uint32_t i = 0; i < cubes * cubes * cubes; ++i)
        for (std::uint32_t side = 0; side < 6; ++side) {
            std::uint32_t at[3] = {i % 3, i / 3 % 3, i / 9};
            const std::uint32_t axis = side / 2, up = side % 2;
            if (!is_full[at[2] + 1][at[1] + 1][at[0] + 1]) continue;
            std::uint32_t other[3] = {at[0] + 1, at[1] + 1, at[2] + 1};
            other[axis] += up ? 1 : ~0u;
            if (is_full[other[2]][other[1]][other[0]]) continue;
            at[axis] += up;
            std::uint32_t corner[4];
            for (std::uint32_t k = 0; k < 4; ++k) {
                std::uint32_t to[3] = {at[0], at[1], at[2]};
                to[(axis + 1) % 3] += k == 1 || k == 2;
                to[(axis + 2) % 3] += k >= 2;
                corner[k] = to[0] + lines * (to[1] + lines * to[2]);
            }
            if (!up) std::swap(corner[1], corner[3]);
            const std::uint32_t first = random.below(2); // either diagonal
            s.triangles.push_back({corner[first], corner[first + 1], corner[first + 2]});
            s.triangles.push_back({corner[first], corner[first + 2], corner[(first + 3) % 4]});
        }
}

Sample any_sample(vox_shape_kind kind, double size, Random& random) {
    Sample s;
    vox_shape_desc& d = s.desc;
    d.kind = kind;
    if (kind == VOX_SHAPE_SPHERE || kind == VOX_SHAPE_CAPSULE || kind == VOX_SHAPE_CYLINDER)
        d.radius = size * length_of(random);
    if (kind == VOX_SHAPE_CAPSULE || kind == VOX_SHAPE_CYLINDER) d.half_length = size * length_of(random);
    if (kind == VOX_SHAPE_BOX)
        for (double& half : d.half_size) half = size * length_of(random);
    if (kind == VOX_SHAPE_SOLID) add_surface(s, random);
    if (kind == VOX_SHAPE_SHEET) {
        for (int i = 0; i < 24; ++i)
            s.points.push_back(random.below(4) ? on_lattice(random) : 4 * random.unit() - 2);
        for (int i = 0; i < 6; ++i) {
            const std::uint32_t v = random.below(6);
            s.triangles.push_back({v, random.below(4) ? v + 1 : v, v + random.below(3)});
        }
        if (random.below(3) == 0) d.radius = size * length_of(random);
    }
    for (double& x : s.points) x *= size;
    if (kind == VOX_SHAPE_HEIGHTFIELD) {
        d.columns = 2 + random.below(4);
        d.rows = 2 + random.below(4);
        d.spacing[0] = size * (random.below(2) ? 0.25 : 0.1 + random.unit());
        d.spacing[1] = size * (random.below(2) ? 0.5 : 0.1 + random.unit());
        for (std::uint32_t i = 0; i < d.columns * d.rows; ++i)
            s.heights.push_back(size * (random.below(4) ? on_lattice(random) : random.unit()));
    }
    return s;
}

START_TEST(inside_and_distance) {
    const auto kind = static_cast<vox_shape_kind>(_i);
    Random random{static_cast<std::uint64_t>(_i)};
    const bool has_triangles = kind >= VOX_SHAPE_HEIGHTFIELD;
    const std::uint64_t shapes = volume_from("VOX_SHAPES", has_triangles ? 24 : 1000);
    std::uint64_t on_surface = 0;
    for (std::uint64_t i = 0; i < shapes; ++i) {
        const double size = std::ldexp(1, i % 4 == 0 ? 100 : i % 4 == 1 ? -400 : 0);
        Sample s = any_sample(kind, size, random);
        const std::shared_ptr<const RigidShape> shape = s.make();
        ck_assert_int_eq(shape->kind(), kind);
        if (kind == VOX_SHAPE_HEIGHTFIELD) add_cells(s);
        for (int k = 0; k < (has_triangles ? 15 : 100); ++k)
            on_surface += check(s, *shape, any_point(random, size), 4 * size, random);
        // At corners and on edges, to rounding.
        for (std::size_t t = 0; t < s.triangles.size(); t += 5) {
            const Vec3d a = s.point(s.triangles[t][0]), b = s.point(s.triangles[t][1]);
            for (const Vec3d& p : {a, 0.5 * (a + b), a + 0.3 * (b - a)})
                on_surface += check(s, *shape, p, 4 * size, random);
        }
    }
    ck_assert_uint_gt(on_surface, 50);
}
END_TEST

} // namespace

SUITE(shape_points) {
    TCase* tests = add_case(suite, "kinds");
    tcase_add_loop_test(tests, inside_and_distance, VOX_SHAPE_HALF_SPACE, VOX_SHAPE_FIELD);
}
