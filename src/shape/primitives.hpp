// Convex shapes with a formula for the distance. Whether a point is inside is decided exactly, for its place
// in the shape's frame.
#pragma once

#include "shape/facets.hpp"
#include "shape/shape.hpp"

#include <memory_resource>

namespace vox {

// z <= 0. The distance is exact.
class HalfSpace final : public RigidShape {
public:
    HalfSpace() noexcept;
    bool look(const Vec3d& p, double reach, ShapePoint& out) const override;
};

// The points within `radius` of the segment from (0, 0, -half_length) to (0, 0, half_length); of a sphere, of
// the origin.
class Capsule final : public RigidShape {
public:
    Capsule(vox_shape_kind kind, double radius, double half_length) noexcept;
    bool look(const Vec3d& p, double reach, ShapePoint& out) const override;

private:
    double radius_, half_length_;
};

// Around the z axis, from -half_length to half_length.
class Cylinder final : public RigidShape {
public:
    Cylinder(double radius, double half_length) noexcept;
    bool look(const Vec3d& p, double reach, ShapePoint& out) const override;

private:
    double radius_, half_length_;
};

class BoxShape final : public RigidShape {
public:
    BoxShape(const Vec3d& half_size, std::pmr::memory_resource* memory);
    bool look(const Vec3d& p, double reach, ShapePoint& out) const override;
    const ShapeFacets* facets() const noexcept override { return &facets_; }

private:
    Vec3d half_size_;
    ShapeFacets facets_; // corner i + 2 j + 4 k, two triangles a side
};

// A distance that the caller computes.
class Field final : public RigidShape {
public:
    using Evaluate = void(const double* points, std::uint64_t count, double* distances, double* gradients,
                          void* user);

    Field(Evaluate* evaluate, void* user, const Vec3d& half_size) noexcept;
    bool look(const Vec3d& p, double reach, ShapePoint& out) const override {
        return look({&p, 1}, reach, &out) != 0;
    }
    std::uint32_t look(std::span<const Vec3d> points, double reach, ShapePoint* out) const override;
    double meeting(const Vec3d& from, const Vec3d& to, ShapePoint& at) const override;

private:
    Evaluate* evaluate_;
    void* user_;
};

} // namespace vox
