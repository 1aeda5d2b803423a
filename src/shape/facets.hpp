// Triangles of a shape and their edges, with trees over their boxes.
#pragma once

#include "base/array.hpp"
#include "base/box_tree.hpp"
#include "base/scene.hpp"

#include <array>
#include <cstdint>
#include <memory_resource>

namespace vox {

using ShapeTriangle = std::array<std::uint32_t, 3>;

struct ShapeFacets {
    // Throws what the memory throws.
    ShapeFacets(Array<Vec3d>&& points, Array<ShapeTriangle>&& triangles);

    struct Edge {
        std::uint32_t ends[2];  // the lower first
        std::uint32_t triangle; // the lowest that has it
    };
    Array<Vec3d> points;
    Array<ShapeTriangle> triangles;
    Array<Edge> edges; // each once, by their ends
    BoxTree triangle_tree, edge_tree;

    const Vec3d& corner(const ShapeTriangle& triangle, std::size_t i) const noexcept {
        return points[triangle[i]];
    }
};

} // namespace vox
