// Finds the closest point of a triangle by the regions of its plane: Ericson, "Real-time collision
// detection", 2005, Sect. 5.1.5.
#include "io/solids/distance.hpp"

#include "base/eigen.hpp"

#include <algorithm>
#include <limits>

namespace vox::io {
namespace {

using Eigen::Vector3d;

double squared_distance_to_triangle(const Vector3d& p, const Vector3d& a, const Vector3d& b,
                                    const Vector3d& c) {
    const Vector3d ab = b - a, ac = c - a, ap = p - a;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap);
    if (d1 <= 0 && d2 <= 0) return ap.squaredNorm();
    const Vector3d bp = p - b;
    const double d3 = ab.dot(bp), d4 = ac.dot(bp);
    if (d3 >= 0 && d4 <= d3) return bp.squaredNorm();
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) return (ap - ab * (d1 / (d1 - d3))).squaredNorm();
    const Vector3d cp = p - c;
    const double d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d6 >= 0 && d5 <= d6) return cp.squaredNorm();
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) return (ap - ac * (d2 / (d2 - d6))).squaredNorm();
    const double va = d3 * d6 - d5 * d4;
    const double along = (d4 - d3) + (d5 - d6);
    if (va <= 0 && d4 >= d3 && d5 >= d6 && along > 0)
        return (bp - (c - b) * ((d4 - d3) / along)).squaredNorm();
    const double sum = va + vb + vc;
    if (!(sum > 0)) return std::min({ap.squaredNorm(), bp.squaredNorm(), cp.squaredNorm()}); // no area
    return (ap - ab * (vb / sum) - ac * (vc / sum)).squaredNorm();
}

double squared_distance_to_box(const std::array<double, 3>& p, const std::array<double, 3>& min,
                               const std::array<double, 3>& max) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double away = std::max({min[k] - p[k], p[k] - max[k], 0.0});
        sum += away * away;
    }
    return sum;
}

} // namespace

TriangleTree::TriangleTree(const double* positions, std::vector<std::uint32_t> triangles)
    : positions_(positions) {
    triangles_.resize(triangles.size() / 3);
    for (std::size_t t = 0; t < triangles_.size(); ++t)
        triangles_[t] = {triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2]};
    nodes_.reserve(triangles_.size());
    build(0, static_cast<std::uint32_t>(triangles_.size()));
}

void TriangleTree::build(std::uint32_t first, std::uint32_t count) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Node node = {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}, first, count};
    for (std::uint32_t t = first; t < first + count; ++t)
        for (const std::uint32_t v : triangles_[t])
            for (std::size_t k = 0; k < 3; ++k) {
                node.min[k] = std::min(node.min[k], positions_[3 * std::size_t{v} + k]);
                node.max[k] = std::max(node.max[k], positions_[3 * std::size_t{v} + k]);
            }
    const std::size_t self = nodes_.size();
    nodes_.push_back(node);
    if (count <= 4) return;
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k)
        if (node.max[k] - node.min[k] > node.max[axis] - node.min[axis]) axis = k;
    const auto middle = [&](const std::array<std::uint32_t, 3>& t) {
        double sum = 0;
        for (const std::uint32_t v : t) sum += positions_[3 * std::size_t{v} + axis];
        return sum;
    };
    const auto begin = triangles_.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count,
                     [&](const auto& a, const auto& b) { return middle(a) < middle(b); });
    build(first, count / 2);
    nodes_[self].first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[self].count = 0;
    build(first + count / 2, count - count / 2);
}

double TriangleTree::squared_distance(const std::array<double, 3>& point, double enough) const {
    const Vector3d p(point[0], point[1], point[2]);
    const auto corner = [&](std::uint32_t v) { return Vector3d(positions_ + 3 * std::size_t{v}); };
    double best = std::numeric_limits<double>::infinity();
    // Median splits of fewer than 2^32 triangles are at most 32 levels deep, and one node waits on each
    // level.
    std::array<std::uint32_t, 64> waiting{};
    std::size_t count = 0;
    waiting[count++] = 0;
    while (count > 0 && best > enough) {
        const std::uint32_t n = waiting[--count];
        const Node& node = nodes_[n];
        if (squared_distance_to_box(point, node.min, node.max) >= best) continue;
        if (node.count > 0) {
            for (std::uint32_t t = node.first; t < node.first + node.count; ++t)
                best = std::min(best, squared_distance_to_triangle(p, corner(triangles_[t][0]),
                                                                   corner(triangles_[t][1]),
                                                                   corner(triangles_[t][2])));
            continue;
        }
        std::uint32_t near = n + 1, far = node.first;
        if (squared_distance_to_box(point, nodes_[far].min, nodes_[far].max) <
            squared_distance_to_box(point, nodes_[near].min, nodes_[near].max))
            std::swap(near, far);
        waiting[count++] = far;
        waiting[count++] = near;
    }
    return best;
}

} // namespace vox::io
