#include "shape/shape.hpp"

#include "base/error.hpp"
#include "base/vectors.hpp"
#include "shape/meeting.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

std::uint32_t RigidShape::look(std::span<const Vec3d> points, double reach, LookState&,
                               ShapePoint* out) const {
    std::uint32_t found = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        found |= std::uint32_t{look(points[i], reach, out[i])} << i;
    return found;
}

bool RigidShape::is_beyond(const Vec3d& centre, double radius, double reach) const {
    ShapePoint seen;
    return !look(centre, radius + reach, seen);
}

double RigidShape::meeting(const Vec3d& from, const Vec3d& to, ShapePoint& at) const {
    return convex_meeting(
        from, to, [this](const Vec3d& p, ShapePoint& out) { (void)look(p, unlimited, out); }, at);
}

// ---- places ---------------------------------------------------------------------------------------

namespace {

constexpr double least_scale = 0x1p-100, most_scale = 0x1p100;

constexpr double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

Vec3d column(const double* m, int i) noexcept { return {m[i], m[4 + i], m[8 + i]}; }

} // namespace

void ShapePlace::check(const double* m, const char* name) {
    const Vec3d x = column(m, 0), y = column(m, 1), z = column(m, 2);
    const double lengths[3] = {std::hypot(x.x, x.y, x.z), std::hypot(y.x, y.y, y.z),
                               std::hypot(z.x, z.y, z.z)};
    const double scale = lengths[0];
    for (const double one : lengths)
        if (!(one >= least_scale && one <= most_scale && std::abs(one - scale) <= tolerance * scale))
            refuse(
                format("%s scales the axes by %g, %g and %g: a shape needs one scale for all, from %g to %g",
                       name, lengths[0], lengths[1], lengths[2], least_scale, most_scale));
    for (int i = 3; i < 12; i += 4)
        if (std::abs(m[i]) > std::numeric_limits<float>::max())
            refuse(format("%s[%d] is %g, the limit is %g", name, i, m[i],
                          double{std::numeric_limits<float>::max()}));
    const Vec3d a = (1 / lengths[0]) * x, b = (1 / lengths[1]) * y, c = (1 / lengths[2]) * z;
    const double skew = std::max({std::abs(dot(a, b)), std::abs(dot(b, c)), std::abs(dot(c, a))});
    if (skew > tolerance)
        refuse(format("%s turns right angles into others (their cosine is %g): a shape can only be rotated, "
                      "scaled and moved",
                      name, skew));
    if (determinant(a, b, c) < 0)
        refuse(format("%s mirrors (its determinant is %g): a shape can only be rotated, scaled and moved",
                      name, determinant(x, y, z)));
}

ShapePlace::ShapePlace(const double* matrix) noexcept {
    const double* const m = matrix ? matrix : identity;
    for (int i = 0; i < 3; ++i) axis_[i] = column(m, i);
    origin_ = column(m, 3);
    double squared = dot(axis_[0], axis_[0]);
    if (std::abs(squared - 1) <= 2 * tolerance) squared = 1;
    scale_ = std::sqrt(squared);
    inverse_ = 1 / squared;
}

Vec3d ShapePlace::to_world(const Vec3d& d) const noexcept {
    return normalised((1 / scale_) * (d.x * axis_[0] + d.y * axis_[1] + d.z * axis_[2]));
}

// By the inverse of to_shape(), which is not quite the matrix where axes are off.
RigidShape::Bounds ShapePlace::to_world(const RigidShape::Bounds& bounds) const noexcept {
    const double by = 1 / (inverse_ * determinant(axis_[0], axis_[1], axis_[2]));
    const Vec3d x = by * cross(axis_[1], axis_[2]), y = by * cross(axis_[2], axis_[0]),
                z = by * cross(axis_[0], axis_[1]);
    const auto along = [&](const double(&row)[3], double origin, double& low, double& high) {
        const double least[3] = {bounds.min.x, bounds.min.y, bounds.min.z},
                     most[3] = {bounds.max.x, bounds.max.y, bounds.max.z};
        low = high = origin;
        for (int i = 0; i < 3; ++i) {
            if (row[i] == 0) continue; // also times infinity
            low += row[i] * (row[i] > 0 ? least[i] : most[i]);
            high += row[i] * (row[i] > 0 ? most[i] : least[i]);
        }
    };
    RigidShape::Bounds out;
    along({x.x, y.x, z.x}, origin_.x, out.min.x, out.max.x);
    along({x.y, y.y, z.y}, origin_.y, out.min.y, out.max.y);
    along({x.z, y.z, z.z}, origin_.z, out.min.z, out.max.z);
    return out;
}

} // namespace vox
