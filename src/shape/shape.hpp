// Rigid shapes: floors, tools, terrain. Each is a class, and says of a point in the shape's frame how far
// away it is and on which side.
#pragma once

#include "base/scene.hpp"
#include "exact/meeting_time.hpp"

#include <vox/vox.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <memory_resource>
#include <span>

namespace vox {

// What a point sees of a shape.
struct ShapePoint {
    double distance;       // from the surface; negative inside, and 0 there if it is too small for a double
    bool is_inside;        // or on the surface; decided exactly where vox_shape_desc says so
    Vec3d normal;          // a unit vector out of the shape, at the closest point of the surface
    std::uint32_t element; // the triangle that has the closest point; VOX_NONE without triangles
};

inline constexpr double unlimited = std::numeric_limits<double>::infinity();

struct ShapeFacets;

class RigidShape {
public:
    struct Bounds {
        Vec3d min, max; // may be infinite
    };

    virtual ~RigidShape() = default;

    vox_shape_kind kind() const noexcept { return desc_.kind; }
    // A desc of which make_shape() makes the same shape, with views of its arrays. A heightfield has
    // positions in place of heights.
    const vox_shape_desc& desc() const noexcept { return desc_; }
    const Bounds& bounds() const noexcept { return bounds_; }

    // Returns false if p is further outside than `reach`, which is not negative; `out` is unspecified then.
    virtual bool look(const Vec3d& p, double reach, ShapePoint& out) const = 0;
    // What a look leaves to the next, for points close to each other. The answers do not depend on it.
    struct LookState {
        std::uint32_t near = ~0u; // a triangle that is probably close
        // No surface is as close to this point.
        Vec3d at{0, 0, 0};
        double clear = 0;
        bool is_enclosed = false; // as all points so close to it
    };
    // Looks from at most most_points points. Returns a bit for each.
    static constexpr std::size_t most_points = 8;
    virtual std::uint32_t look(std::span<const Vec3d> points, double reach, LookState& state,
                               ShapePoint* out) const;
    // True only if all points within `radius` of `centre` are outside, and further away than `reach`.
    virtual bool is_beyond(const Vec3d& centre, double radius, double reach) const;
    // A sheet without a radius: what lies on it is on neither side.
    bool is_thin() const noexcept { return desc_.kind == VOX_SHAPE_SHEET && desc_.radius == 0; }
    // When a point that moves in a straight line, and begins outside, first meets the shape: from 0 to 1 and
    // never too late, with what it sees there; no_meeting if it never does. A point that begins on triangles
    // of a thin one does not meet these.
    virtual double meeting(const Vec3d& from, const Vec3d& to, ShapePoint& at) const;
    // Flat sides, which edges of meshes pass through; null for a shape without.
    virtual const ShapeFacets* facets() const noexcept { return nullptr; }

protected:
    // Keeps the numbers of the desc, not the caller's arrays.
    RigidShape(const vox_shape_desc& desc, const Bounds& bounds) noexcept : desc_(desc), bounds_(bounds) {
        desc_.positions = {};
        desc_.triangles = nullptr;
        desc_.heights = nullptr;
        desc_.triangle_count = 0;
    }

    vox_shape_desc desc_;
    Bounds bounds_;
};

// Checks a desc that read_struct() has completed, and copies what it has. Throws INVALID_ARGUMENT,
// INVALID_MESH, NON_FINITE, LIMIT and what the memory throws.
std::shared_ptr<const RigidShape> make_shape(const vox_shape_desc& desc, std::pmr::memory_resource* memory);

// Where a shape is: a rotation, one scale for all axes, and a translation.
class ShapePlace {
public:
    // A matrix of vox_body_set_transform; null: the shape is where it was given.
    explicit ShapePlace(const double* matrix) noexcept;

    // Throws INVALID_ARGUMENT for a matrix that is not of this kind.
    static void check(const double* matrix, const char* name);

    // Matrices of floats, and products of many, are rotations to that.
    static constexpr double tolerance = 1e-5;

    double scale() const noexcept { return scale_; }
    // The least radius that holds what a ball becomes, and a little more.
    double to_shape(double radius) const noexcept { return radius * (1 + 4 * tolerance) / scale_; }
    Vec3d to_shape(const Vec3d& x) const noexcept {
        const Vec3d d{x.x - origin_.x, x.y - origin_.y, x.z - origin_.z};
        return {inverse_ * ((axis_[0].x * d.x + axis_[0].y * d.y) + axis_[0].z * d.z),
                inverse_ * ((axis_[1].x * d.x + axis_[1].y * d.y) + axis_[1].z * d.z),
                inverse_ * ((axis_[2].x * d.x + axis_[2].y * d.y) + axis_[2].z * d.z)};
    }
    // A direction; of unit length again.
    Vec3d to_world(const Vec3d& direction) const noexcept;
    // The box around bounds.
    RigidShape::Bounds to_world(const RigidShape::Bounds& bounds) const noexcept;

private:
    Vec3d axis_[3];
    Vec3d origin_;
    double scale_, inverse_; // 1 / scale^2
};

} // namespace vox
