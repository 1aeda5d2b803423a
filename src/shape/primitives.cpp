#include "shape/primitives.hpp"

#include "base/error.hpp"
#include "base/vectors.hpp"
#include "exact/facet_normal.hpp"
#include "exact/predicates.hpp"
#include "exact/sphere.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace vox {

namespace {

// Sets whether a point is inside, with which its distance agrees. Returns whether it is in reach.
bool decide(bool is_inside, double distance, double reach, ShapePoint& out) noexcept {
    out.is_inside = is_inside;
    out.distance = is_inside ? std::min(distance, 0.0) : std::max(distance, 0.0);
    out.element = VOX_NONE;
    return out.distance <= reach;
}

// The direction of v, or `otherwise` for zero.
Vec3d direction(const Vec3d& v, const Vec3d& otherwise) noexcept {
    const Vec3d unit = normalised(scaled(v));
    return unit.x == 0 && unit.y == 0 && unit.z == 0 ? otherwise : unit;
}

// The box of half_size.
RigidShape::Bounds around(const vox_shape_desc& desc) noexcept {
    const Vec3d half = vector_of(desc.half_size);
    return {-1.0 * half, half};
}

double sign_of(double x) noexcept { return x < 0 ? -1 : 1; }

} // namespace

// ---- half-space -----------------------------------------------------------------------------------

HalfSpace::HalfSpace(const vox_shape_desc& desc) noexcept
    : PointByPoint(desc, {{-unlimited, -unlimited, -unlimited}, {unlimited, unlimited, 0}}) {}

bool HalfSpace::look(const Vec3d& p, double reach, ShapePoint& out) const {
    out.normal = {0, 0, 1};
    return decide(p.z <= 0, p.z, reach, out);
}

// ---- sphere and capsule ---------------------------------------------------------------------------

Capsule::Capsule(const vox_shape_desc& desc) noexcept : PointByPoint(desc, {}) {
    if (kind() == VOX_SHAPE_SPHERE) desc_.half_length = 0;
    const double across = desc.radius, along = desc_.half_length + across;
    bounds_ = {{-across, -across, -along}, {across, across, along}};
}

bool Capsule::look(const Vec3d& p, double reach, ShapePoint& out) const {
    const Vec3d centre{0, 0, std::clamp(p.z, -desc_.half_length, desc_.half_length)}, way = p - centre;
    const double far = length(way) * (1 - 0x1p-40) - desc_.radius;
    if (far > reach) return false;
    out.normal = direction(way, desc_.half_length > 0 ? Vec3d{1, 0, 0} : Vec3d{0, 0, 1});
    return decide(side_of_sphere(p, centre, desc_.radius) <= 0, distance_to_sphere(way, desc_.radius), reach,
                  out);
}

// ---- cylinder and box -----------------------------------------------------------------------------

Cylinder::Cylinder(const vox_shape_desc& desc) noexcept
    : PointByPoint(desc, {{-desc.radius, -desc.radius, -desc.half_length},
                          {desc.radius, desc.radius, desc.half_length}}) {}

bool Cylinder::look(const Vec3d& p, double reach, ShapePoint& out) const {
    const Vec3d flat{p.x, p.y, 0}, end{0, 0, sign_of(p.z)}, side = direction(flat, {1, 0, 0});
    const double across = distance_to_sphere(flat, desc_.radius), along = std::abs(p.z) - desc_.half_length;
    const bool is_inside = side_of_sphere(flat, {0, 0, 0}, desc_.radius) <= 0 && along <= 0;
    if (is_inside) {
        out.normal = across >= along ? side : end;
        return decide(true, std::max(across, along), reach, out);
    }
    const Vec3d way{std::max(across, 0.0), std::max(along, 0.0), 0};
    const Vec3d normal = direction(way, {1, 0, 0});
    out.normal = normal.x * side + normal.y * end;
    return decide(false, Stretch(way).length, reach, out);
}

namespace {

ShapeFacets box_facets(const Vec3d& half, std::pmr::memory_resource* memory) {
    Array<Vec3d> points(memory);
    points.reserve(8);
    for (int i = 0; i < 8; ++i)
        points.push_back({i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
    return {std::move(points), Array<ShapeTriangle>({{0, 2, 3},
                                                     {0, 3, 1},
                                                     {4, 5, 7},
                                                     {4, 7, 6},
                                                     {0, 1, 5},
                                                     {0, 5, 4},
                                                     {2, 6, 7},
                                                     {2, 7, 3},
                                                     {0, 4, 6},
                                                     {0, 6, 2},
                                                     {1, 3, 7},
                                                     {1, 7, 5}},
                                                    memory)};
}

} // namespace

BoxShape::BoxShape(const vox_shape_desc& desc, std::pmr::memory_resource* memory)
    : PointByPoint(desc, around(desc)), facets_(box_facets(bounds().max, memory)) {}

bool BoxShape::look(const Vec3d& p, double reach, ShapePoint& out) const {
    const double at[3] = {p.x, p.y, p.z}, (&half)[3] = desc_.half_size;
    double beyond[3], normal[3] = {};
    int nearest = 0;
    for (int i = 0; i < 3; ++i) {
        beyond[i] = std::abs(at[i]) - half[i];
        if (beyond[i] > beyond[nearest]) nearest = i;
    }
    if (beyond[nearest] > reach) return false;
    if (beyond[nearest] <= 0) {
        normal[nearest] = sign_of(at[nearest]);
        out.normal = vector_of(normal);
        return decide(true, beyond[nearest], reach, out);
    }
    for (int i = 0; i < 3; ++i) normal[i] = beyond[i] > 0 ? sign_of(at[i]) * beyond[i] : 0;
    out.normal = Stretch(vector_of(normal)).direction;
    return decide(false, distance_to_box(p, bounds().max), reach, out);
}

// ---- field ----------------------------------------------------------------------------------------

Field::Field(const vox_shape_desc& desc) noexcept : RigidShape(desc, around(desc)) {}

std::uint32_t Field::look(std::span<const Vec3d> points, double reach, LookState&, ShapePoint* out) const {
    std::array<double, 3 * most_points> at{}, gradients{};
    std::array<double, most_points> distances{};
    for (std::size_t i = 0; i < points.size(); ++i) {
        at[3 * i] = points[i].x, at[3 * i + 1] = points[i].y, at[3 * i + 2] = points[i].z;
    }
    desc_.field(at.data(), points.size(), distances.data(), gradients.data(), desc_.field_user);
    std::uint32_t found = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3d gradient{gradients[3 * i], gradients[3 * i + 1], gradients[3 * i + 2]};
        if (std::isnan(distances[i]) || !std::isfinite(dot(gradient, {1, 1, 1})))
            throw Error(VOX_ERROR_NON_FINITE,
                        format("the field of a shape has distance %g and gradient (%g, %g, %g) at (%g, %g, "
                               "%g) in its frame",
                               distances[i], gradient.x, gradient.y, gradient.z, points[i].x, points[i].y,
                               points[i].z));
        out[i].normal = direction(gradient, {0, 0, 1});
        if (decide(distances[i] <= 0, distances[i], reach, out[i])) found |= 1u << i;
    }
    return found;
}

// Nothing is known of a field but that the surface is no closer than the distance (J. C. Hart, Sphere
// tracing, The Visual Computer 12, 1996).
double Field::meeting(const Vec3d& from, const Vec3d& to, ShapePoint& at) const {
    constexpr int most_spheres = 2048; // a way that grazes takes so many, and counts as meeting
    const Vec3d way = to - from;
    const double all = length(way),
                 close = 0x1p-46 * std::max(largest_coordinate(from), largest_coordinate(to));
    double time = 0;
    for (int sphere = 0; sphere < most_spheres; ++sphere) {
        const Vec3d p = from + time * way;
        (void)look(p, unlimited, at);
        if (!(at.distance > close) && dot(at.normal, way) < 0) return time;
        const double free = std::max(at.distance, close); // where it begins at the surface, too, and leaves
        if (!(time * all + free < all)) return no_meeting;
        time += free / all;
    }
    return time;
}

} // namespace vox
