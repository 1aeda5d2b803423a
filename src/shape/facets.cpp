#include "shape/facets.hpp"

#include "base/parallel.hpp"
#include "base/rounding.hpp"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

namespace vox {

ShapeFacets::ShapeFacets(Array<Vec3d>&& given_points, Array<ShapeTriangle>&& given_triangles)
    : points(std::move(given_points)), triangles(std::move(given_triangles)), edges(points.memory()),
      triangle_tree(points.memory()), edge_tree(points.memory()) {
    edges.reserve(3 * triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t u = triangles[t][i], v = triangles[t][(i + 1) % 3];
            if (u != v) edges.push_back({{std::min(u, v), std::max(u, v)}, t});
        }
    const auto ends = [](const Edge& edge) { return std::tie(edge.ends[0], edge.ends[1]); };
    std::sort(edges.begin(), edges.end(), [&](const Edge& a, const Edge& b) {
        return std::tuple(ends(a), a.triangle) < std::tuple(ends(b), b.triangle);
    });
    edges.erase(std::unique(edges.begin(), edges.end(),
                            [&](const Edge& a, const Edge& b) { return ends(a) == ends(b); }),
                edges.end());

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
    for (const Edge& edge : edges) add_box(edge.ends);
    edge_tree.build(boxes, alone);
}

} // namespace vox
