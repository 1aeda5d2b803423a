// Shapes of triangles.
#pragma once

#include "base/array.hpp"
#include "depth/closest.hpp"
#include "mesh/topology.hpp"
#include "shape/facets.hpp"
#include "shape/shape.hpp"

#include <cstdint>
#include <memory_resource>

namespace vox {

class TriangleShape : public RigidShape {
public:
    bool look(const Vec3d& p, double reach, ShapePoint& out) const final {
        LookState state;
        return look(p, reach, state, out);
    }
    std::uint32_t look(std::span<const Vec3d> points, double reach, LookState& state,
                       ShapePoint* out) const final;
    bool is_beyond(const Vec3d& centre, double radius, double reach) const final;
    double meeting(const Vec3d& from, const Vec3d& to, ShapePoint& at) const final;
    const ShapeFacets* facets() const noexcept final { return &facets_; }

protected:
    // The triangles are part of the shape, and so is what is within `radius` of them.
    TriangleShape(const vox_shape_desc& desc, Array<Vec3d>&& points, Array<ShapeTriangle>&& triangles,
                  double radius);

    // Whether p, which is not on a triangle, is in what the triangles enclose.
    virtual bool encloses(const Vec3d& p) const = 0;
    bool is_on(const Vec3d& p, std::uint32_t triangle) const noexcept;
    bool is_on_surface(const Vec3d& p) const;
    const Vec3d& corner(const ShapeTriangle& triangle, std::size_t i) const noexcept {
        return facets_.corner(triangle, i);
    }

    ShapeFacets facets_;
    double radius_, extent_;          // the latter bounds the distance of any two points of the triangles
    Topology topology_;               // the triangles alone
    depth::SurfaceTree closest_tree_; // over all of them

private:
    bool look(const Vec3d& p, double reach, LookState& state, ShapePoint& out) const;
    bool is_far(const Vec3d& p, double reach) const noexcept;
    void look_at(const Vec3d& p, std::uint32_t triangle, bool is_enclosed, ShapePoint& out) const noexcept;
};

// Thin: encloses nothing.
class Sheet final : public TriangleShape {
public:
    Sheet(const vox_shape_desc& desc, Array<Vec3d>&& points, Array<ShapeTriangle>&& triangles)
        : TriangleShape(desc, std::move(points), std::move(triangles), desc.radius) {}

private:
    bool encloses(const Vec3d&) const override { return false; }
};

// What a closed surface goes around, decided exactly: the surface is part of it.
class ClosedSurface final : public TriangleShape {
public:
    // Throws INVALID_MESH unless the surface is closed.
    ClosedSurface(const vox_shape_desc& desc, Array<Vec3d>&& points, Array<ShapeTriangle>&& triangles);

private:
    bool encloses(const Vec3d& p) const override;
};

// Terrain: each cell of a lattice is two triangles, and what is below them is inside, decided exactly.
class Heightfield final : public TriangleShape {
public:
    Heightfield(const vox_shape_desc& desc, Array<Vec3d>&& points);

private:
    bool encloses(const Vec3d& p) const override;
};

} // namespace vox
