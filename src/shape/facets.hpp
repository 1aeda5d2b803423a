// Triangles of a shape and their edges, with trees over their boxes.
#pragma once

#include "base/array.hpp"
#include "base/box_tree.hpp"
#include "base/scene.hpp"

#include <array>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

using ShapeTriangle = std::array<std::uint32_t, 3>;

// A side of a triangle.
struct TriangleSide {
    std::uint32_t ends[2]; // the lower first
    std::uint32_t triangle;
    bool is_up; // runs from the lower one to the higher in the order of the triangle
};

// All sides but those from a vertex to itself, by their ends and then by triangle.
Array<TriangleSide> sorted_sides(std::span<const ShapeTriangle> triangles, std::pmr::memory_resource* memory);

struct ShapeFacets {
    // Throws what the memory throws.
    ShapeFacets(Array<Vec3d>&& points, Array<ShapeTriangle>&& triangles);

    Array<Vec3d> points;
    Array<ShapeTriangle> triangles;
    Array<TriangleSide> edges; // each once, as a side of the lowest triangle that has it
    BoxTree triangle_tree, edge_tree;

    const Vec3d& corner(const ShapeTriangle& triangle, std::size_t i) const noexcept {
        return points[triangle[i]];
    }
};

} // namespace vox
