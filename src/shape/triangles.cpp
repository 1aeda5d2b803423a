#include "shape/triangles.hpp"

#include "base/entry_bound.hpp"
#include "base/error.hpp"
#include "base/vectors.hpp"
#include "exact/closest_point.hpp"
#include "exact/crossing.hpp"
#include "exact/facet_normal.hpp"
#include "exact/predicates.hpp"
#include "shape/meeting.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vox {

namespace {

RigidShape::Bounds bounds_of(std::span<const Vec3d> points, double radius) noexcept {
    RigidShape::Bounds bounds{{unlimited, unlimited, unlimited}, {-unlimited, -unlimited, -unlimited}};
    for (const Vec3d& p : points) bounds = {min(bounds.min, p), max(bounds.max, p)};
    const Vec3d reach{radius, radius, radius};
    return {bounds.min - reach, bounds.max + reach};
}

// A unit vector at right angles to the direction of v; along z for zero.
Vec3d across(const Vec3d& v) noexcept {
    const Vec3d d = scaled(v);
    const Vec3d unit = normalised(std::abs(d.x) < std::abs(d.z) ? Vec3d{0, d.z, -d.y} : Vec3d{-d.y, d.x, 0});
    return length(unit) > 0 ? unit : Vec3d{0, 0, 1};
}

} // namespace

TriangleShape::TriangleShape(const vox_shape_desc& desc, Array<Vec3d>&& points,
                             Array<ShapeTriangle>&& triangles, double radius)
    : RigidShape(desc, bounds_of(points, radius)), facets_(std::move(points), std::move(triangles)),
      radius_(radius), extent_(length(bounds_.max - bounds_.min)), topology_(facets_.triangles.memory()),
      closest_tree_(facets_.triangles.memory()) {
    desc_.positions = vox_double_positions(&facets_.points.data()->x, facets_.points.size());
    desc_.triangles = facets_.triangles.data()->data();
    desc_.triangle_count = facets_.triangles.size();
    topology_.triangles.reserve(facets_.triangles.size());
    for (const auto& [a, b, c] : facets_.triangles) topology_.triangles.push_back({{a, b, c}, a});
    const Positions positions{reinterpret_cast<const std::byte*>(facets_.points.data()), sizeof(Vec3d), true};
    closest_tree_.update({&topology_, {}, positions}, false, nullptr);
}

// ---- what a point sees ----------------------------------------------------------------------------

// One triangle, with `radius_` around it. Its distance is negative for a point that is enclosed.
void TriangleShape::look_at(const Vec3d& p, std::uint32_t triangle, bool is_enclosed,
                            ShapePoint& out) const noexcept {
    const ShapeTriangle& t = facets_.triangles[triangle];
    const Vec3d &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
    const SeenPoint seen = closest_seen_from(p, a, b, c);
    const Stretch way(seen.way);
    out.distance = is_enclosed ? -way.length : way.length - radius_;
    out.normal = is_enclosed ? way.direction : -1.0 * way.direction;
    out.element = triangle;
    // So close that rounding errors would turn the way: across the triangle. On its edges that is as good as
    // any other direction, but not as good as the way, if that is not quite as short.
    const double reach =
        std::max({largest_coordinate(a - p), largest_coordinate(b - p), largest_coordinate(c - p)});
    const auto& [of_a, of_b, of_c] = seen.at.weight;
    if (way.length > (of_a > 0 && of_b > 0 && of_c > 0 ? 0x1p-20 : 0x1p-40) * reach) return;
    std::uint64_t exact_tests = 0;
    const Vec3d normal = triangle_normal(a, b, c);
    const bool is_behind = !is_enclosed && orientation(a, b, c, p, exact_tests) < 0;
    if (length(normal) > 0)
        out.normal = is_behind ? -1.0 * normal : normal;
    else if (!(way.length > 0x1p-48 * reach))
        out.normal = across(largest_coordinate(b - a) > 0 ? b - a : c - a);
}

std::uint32_t TriangleShape::look(std::span<const Vec3d> points, double reach, LookState& state,
                                  ShapePoint* out) const {
    std::uint32_t found = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        found |= std::uint32_t{look(points[i], reach, state, out[i])} << i;
    return found;
}

// No triangle is between points that are closer to each other than to all triangles: then they are on the
// same side, unless terrain ends between them, and not on the surface. Distances are off by far less than is
// left for that.
bool TriangleShape::look(const Vec3d& p, double reach, LookState& state, ShapePoint& out) const {
    const Vec3d from_last = p - state.at;
    const bool is_clear = dot(from_last, from_last) < state.clear * state.clear;
    const bool is_enclosed = is_clear && kind() != VOX_SHAPE_HEIGHTFIELD ? state.is_enclosed : encloses(p),
               is_on = !is_clear && radius_ == 0 && is_on_surface(p);
    if (!is_enclosed && !is_on && (reach + radius_ == 0 || is_far(p, reach))) return false;
    depth::SearchState search;
    search.near = state.near;
    depth::Closest closest;
    if (!closest_tree_.find(p, depth::SurfaceTree::no_vertex, search, closest)) return false;
    look_at(p, closest.at.triangle, is_enclosed, out);
    constexpr double rounding = 0x1p-20;
    const double length = std::sqrt(closest.squared);
    state = {search.near, p, std::max(0.0, length - rounding * (length + extent_)), is_enclosed};
    out.is_inside = is_enclosed || is_on || (radius_ > 0 && out.distance <= 0);
    if (is_on) out.distance = 0;
    return out.distance <= reach;
}

// Whether p is further than `reach` from the bounds, which costs less than a search.
bool TriangleShape::is_far(const Vec3d& p, double reach) const noexcept {
    const Vec3d way = p - min(max(p, bounds_.min), bounds_.max);
    const double far = (reach + 0x1p-48 * largest_coordinate(p)) * (1 + 0x1p-40);
    return dot(way, way) > far * far;
}

// Without a triangle near, all points above and below the bounds are inside if one is: terrain has no
// triangles at its border.
bool TriangleShape::is_beyond(const Vec3d& centre, double radius, double reach) const {
    const double far = (radius + reach + radius_) * (1 + 0x1p-40);
    bool is_near = false;
    facets_.triangle_tree.visit_accepted(
        [&](const Box3f& box) { return !is_near && squared_distance_bound(centre, box) <= far * far; },
        [&](std::uint32_t) { is_near = true; });
    const Vec3d nearest = min(max(centre, bounds_.min), bounds_.max);
    return !is_near && !encloses({nearest.x, nearest.y, centre.z});
}

double TriangleShape::meeting(const Vec3d& from, const Vec3d& to, ShapePoint& at) const {
    const EntryBound enters(from, to);
    const auto grow = static_cast<float>(radius_ * 1.0001);
    double earliest = 1;
    std::uint32_t first = VOX_NONE;
    facets_.triangle_tree.visit_nearest_first(
        earliest,
        [&](Box3f box) {
            box.min = {box.min.x - grow, box.min.y - grow, box.min.z - grow};
            box.max = {box.max.x + grow, box.max.y + grow, box.max.z + grow};
            return enters(box);
        },
        [&](std::uint32_t triangle) {
            ShapePoint seen;
            const double time = convex_meeting(
                from, to, [&](const Vec3d& p, ShapePoint& out) { look_at(p, triangle, false, out); }, seen);
            if (time > earliest || (time == earliest && first < triangle)) return;
            if (is_thin() && is_on(from, triangle)) return;
            earliest = time;
            first = triangle;
            at = seen;
        });
    return first == VOX_NONE ? no_meeting : earliest;
}

bool TriangleShape::is_on(const Vec3d& p, std::uint32_t triangle) const noexcept {
    const ShapeTriangle& t = facets_.triangles[triangle];
    const Vec3d &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
    std::uint64_t exact_tests = 0;
    return orientation(a, b, c, p, exact_tests) == 0 &&
           find_crossing(p, p, a, b, c, exact_tests).kind != CrossingKind::none;
}

bool TriangleShape::is_on_surface(const Vec3d& p) const {
    bool found = false;
    facets_.triangle_tree.visit_accepted(
        [&](const Box3f& box) { return !found && contains(box, p); },
        [&](std::uint32_t triangle) { found = found || is_on(p, triangle); });
    return found;
}

// ---- solid ----------------------------------------------------------------------------------------

namespace {

// On which side of the line from u to v, seen from above, p is: 1 for left. A point on the line is moved by
// far less than anything, along x, and along y by far less than that. 0 only for u above v.
int side_from_above(const Vec3d& u, const Vec3d& v, const Vec3d& p, std::uint64_t& exact_tests) noexcept {
    const int side = orientation({u.x, u.y, 0}, {v.x, v.y, 0}, {p.x, p.y, 0}, {u.x, u.y, 1}, exact_tests);
    if (side != 0) return side;
    if (u.y != v.y) return u.y > v.y ? 1 : -1;
    return (v.x > u.x) - (v.x < u.x);
}

// Every edge belongs to as many triangles one way as the other way.
void check_closed(std::span<const ShapeTriangle> triangles, std::pmr::memory_resource* memory) {
    const Array<TriangleSide> sides = sorted_sides(triangles, memory);
    for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
        const auto& [low, high] = sides[i].ends;
        int up = 0;
        for (end = i; end < sides.size() && sides[end].ends[0] == low && sides[end].ends[1] == high; ++end)
            up += sides[end].is_up ? 1 : -1;
        if (up == 0) continue;
        throw Error(VOX_ERROR_INVALID_MESH,
                    end - i == 1
                        ? format("edge (%u, %u) of triangle %u has no other triangle: a SOLID has to be "
                                 "closed, a SHEET need not be",
                                 low, high, sides[i].triangle)
                        : format("edge (%u, %u) runs the same way in triangles %u and %u: the triangles of a "
                                 "SOLID have to be counter-clockwise as seen from outside",
                                 low, high, sides[i].triangle, sides[i + 1].triangle));
    }
}

} // namespace

ClosedSurface::ClosedSurface(const vox_shape_desc& desc, Array<Vec3d>&& points,
                             Array<ShapeTriangle>&& triangles)
    : TriangleShape(desc, std::move(points), std::move(triangles), 0) {
    check_closed(facets_.triangles, facets_.triangles.memory());
    double volume = 0, size = 0; // six times
    for (const auto& [a, b, c] : facets_.triangles) {
        const Vec3d& from = facets_.points[facets_.triangles[0][0]];
        const double part =
            determinant(facets_.points[a] - from, facets_.points[b] - from, facets_.points[c] - from);
        volume += part;
        size += std::abs(part);
    }
    if (volume < -1e-9 * size)
        throw Error(VOX_ERROR_INVALID_MESH, format("the volume is %g: the triangles of a SOLID have to be "
                                                   "counter-clockwise as seen from outside",
                                                   volume / 6));
}

// How often the surface goes around p: its triangles above p, each with the sign of the side that it shows
// (P. Heckbert, ed., Graphics Gems IV, 1994, has the test in the plane). Points on edges are moved alike for
// all triangles (H. Edelsbrunner, E. P. Mücke, Simulation of simplicity, ACM Trans. Graphics 9, 1990).
bool ClosedSurface::encloses(const Vec3d& p) const {
    if (!(p.x >= bounds_.min.x && p.y >= bounds_.min.y && p.z >= bounds_.min.z && p.x <= bounds_.max.x &&
          p.y <= bounds_.max.y && p.z <= bounds_.max.z))
        return false;
    int turns = 0;
    std::uint64_t exact_tests = 0;
    facets_.triangle_tree.visit_accepted(
        [&](const Box3f& box) {
            return double{box.min.x} <= p.x && p.x <= double{box.max.x} && double{box.min.y} <= p.y &&
                   p.y <= double{box.max.y} && p.z <= double{box.max.z};
        },
        [&](std::uint32_t triangle) {
            const ShapeTriangle& t = facets_.triangles[triangle];
            const Vec3d &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
            const int of_ab = side_from_above(a, b, p, exact_tests);
            if (of_ab == 0 || side_from_above(b, c, p, exact_tests) != of_ab ||
                side_from_above(c, a, p, exact_tests) != of_ab)
                return;
            if (orientation(a, b, c, p, exact_tests) == -of_ab) turns += of_ab;
        });
    return turns != 0;
}

// ---- heightfield ----------------------------------------------------------------------------------

namespace {

Array<ShapeTriangle> lattice(std::uint32_t columns, std::uint32_t rows, std::pmr::memory_resource* memory) {
    Array<ShapeTriangle> triangles(memory);
    triangles.reserve(2 * (std::size_t{columns} - 1) * (rows - 1));
    for (std::uint32_t row = 0; row + 1 < rows; ++row)
        for (std::uint32_t column = 0; column + 1 < columns; ++column) {
            const std::uint32_t at = row * columns + column, above = at + columns;
            triangles.push_back({at, at + 1, above + 1});
            triangles.push_back({at, above + 1, above});
        }
    return triangles;
}

} // namespace

Heightfield::Heightfield(const vox_shape_desc& desc, Array<Vec3d>&& points)
    : TriangleShape(desc, std::move(points), lattice(desc.columns, desc.rows, points.memory()), 0) {
    desc_.triangles = nullptr; // which are made of the heights
    desc_.triangle_count = 0;
    bounds_.min.z = -unlimited;
}

bool Heightfield::encloses(const Vec3d& p) const {
    if (!(p.x >= bounds_.min.x && p.y >= bounds_.min.y && p.x <= bounds_.max.x && p.y <= bounds_.max.y &&
          p.z <= bounds_.max.z))
        return false;
    // The last line of the lattice that is not beyond p; lines are rounded.
    const auto cell = [](double x, std::uint32_t lines, const auto& line) {
        std::uint32_t low = 0, high = lines - 1;
        while (high - low > 1) {
            const std::uint32_t middle = low + (high - low) / 2;
            (line(middle) <= x ? low : high) = middle;
        }
        return low;
    };
    const std::uint32_t column =
                            cell(p.x, desc_.columns, [&](std::uint32_t i) { return facets_.points[i].x; }),
                        row = cell(p.y, desc_.rows, [&](std::uint32_t i) {
                            return facets_.points[i * std::size_t{desc_.columns}].y;
                        });
    const std::size_t first = 2 * (row * (std::size_t{desc_.columns} - 1) + column);
    const ShapeTriangle& lower = facets_.triangles[first];
    const Vec3d &a = corner(lower, 0), &c = corner(lower, 2);
    std::uint64_t exact_tests = 0;
    const bool is_left =
        orientation({a.x, a.y, 0}, {c.x, c.y, 0}, {p.x, p.y, 0}, {a.x, a.y, 1}, exact_tests) > 0;
    const ShapeTriangle& t = facets_.triangles[first + is_left];
    return orientation(corner(t, 0), corner(t, 1), corner(t, 2), p, exact_tests) <= 0;
}

} // namespace vox
