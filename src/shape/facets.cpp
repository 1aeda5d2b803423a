#include "shape/facets.hpp"

#include "base/parallel.hpp"
#include "base/rounding.hpp"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

namespace vox {

Array<TriangleSide> sorted_sides(std::span<const ShapeTriangle> triangles,
                                 std::pmr::memory_resource* memory) {
    Array<TriangleSide> sides(memory);
    sides.reserve(3 * triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t u = triangles[t][i], v = triangles[t][(i + 1) % 3];
            if (u != v) sides.push_back({{std::min(u, v), std::max(u, v)}, t, u < v});
        }
    std::sort(sides.begin(), sides.end(), [](const TriangleSide& a, const TriangleSide& b) {
        return std::tie(a.ends[0], a.ends[1], a.triangle) < std::tie(b.ends[0], b.ends[1], b.triangle);
    });
    return sides;
}

ShapeFacets::ShapeFacets(Array<Vec3d>&& given_points, Array<ShapeTriangle>&& given_triangles)
    : points(std::move(given_points)), triangles(std::move(given_triangles)),
      edges(sorted_sides(triangles, points.memory())), triangle_tree(points.memory()),
      edge_tree(points.memory()) {
    const auto same = [](const TriangleSide& a, const TriangleSide& b) {
        return a.ends[0] == b.ends[0] && a.ends[1] == b.ends[1];
    };
    edges.erase(std::unique(edges.begin(), edges.end(), same), edges.end());

    Workers alone({}, 0);
    Array<Box3f> boxes(points.memory());
    const auto add_box = [&](std::span<const std::uint32_t> corners) {
        Box3f& box = boxes.emplace_back(rounded_box(points[corners[0]]));
        for (const std::uint32_t corner : corners) extend(box, rounded_box(points[corner]));
    };
    boxes.reserve(std::max(triangles.size(), edges.size()));
    for (const ShapeTriangle& triangle : triangles) add_box(triangle);
    triangle_tree.build(boxes, alone);
    boxes.clear();
    for (const TriangleSide& edge : edges) add_box(edge.ends);
    edge_tree.build(boxes, alone);
}

} // namespace vox
