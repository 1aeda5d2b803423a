// Convex shapes with a formula for the distance. Whether a point is inside is decided exactly, for its place
// in the shape's frame.
#pragma once

#include "shape/facets.hpp"
#include "shape/shape.hpp"

#include <memory_resource>

namespace vox {

// Looks at several points without a virtual call for each.
template <class Self>
class PointByPoint : public RigidShape {
public:
    std::uint32_t look(std::span<const Vec3d> points, double reach, LookState&, ShapePoint* out) const final {
        std::uint32_t found = 0;
        for (std::size_t i = 0; i < points.size(); ++i)
            found |= std::uint32_t{static_cast<const Self*>(this)->Self::look(points[i], reach, out[i])} << i;
        return found;
    }

protected:
    using RigidShape::RigidShape;
};

// z <= 0. The distance is exact.
class HalfSpace final : public PointByPoint<HalfSpace> {
public:
    explicit HalfSpace(const vox_shape_desc& desc) noexcept;
    using PointByPoint::look;
    bool look(const Vec3d& p, double reach, ShapePoint& out) const override;
};

// The points within `radius` of the segment from (0, 0, -half_length) to (0, 0, half_length); of a sphere, of
// the origin.
class Capsule final : public PointByPoint<Capsule> {
public:
    explicit Capsule(const vox_shape_desc& desc) noexcept;
    using PointByPoint::look;
    bool look(const Vec3d& p, double reach, ShapePoint& out) const override;
};

// Around the z axis, from -half_length to half_length.
class Cylinder final : public PointByPoint<Cylinder> {
public:
    explicit Cylinder(const vox_shape_desc& desc) noexcept;
    using PointByPoint::look;
    bool look(const Vec3d& p, double reach, ShapePoint& out) const override;
};

class BoxShape final : public PointByPoint<BoxShape> {
public:
    BoxShape(const vox_shape_desc& desc, std::pmr::memory_resource* memory);
    using PointByPoint::look;
    bool look(const Vec3d& p, double reach, ShapePoint& out) const override;
    const ShapeFacets* facets() const noexcept override { return &facets_; }

private:
    ShapeFacets facets_; // corner i + 2 j + 4 k, two triangles a side
};

// A distance that the caller computes.
class Field final : public RigidShape {
public:
    explicit Field(const vox_shape_desc& desc) noexcept;
    bool look(const Vec3d& p, double reach, ShapePoint& out) const override {
        LookState state;
        return look({&p, 1}, reach, state, &out) != 0;
    }
    std::uint32_t look(std::span<const Vec3d> points, double reach, LookState&,
                       ShapePoint* out) const override;
    double meeting(const Vec3d& from, const Vec3d& to, ShapePoint& at) const override;
};

} // namespace vox
