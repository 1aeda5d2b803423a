// Finds the closest point of a triangle by the regions of its plane: Ericson, "Real-time collision
// detection", 2005, Sect. 5.1.5.
#include "io/solids/distance.hpp"

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

} // namespace

TriangleTree::TriangleTree(const double* positions, std::vector<std::uint32_t> triangles)
    : positions_(positions), triangles_(triangles.size() / 3) {
    for (std::size_t i = 0; i < 3 * triangles_.size(); ++i) triangles_[i / 3][i % 3] = triangles[i];
    nodes_.reserve(triangles_.size());
    build(0, static_cast<std::uint32_t>(triangles_.size()));
}

Vector3d TriangleTree::corner(std::uint32_t vertex) const {
    return Vector3d(positions_ + 3 * std::size_t{vertex});
}

void TriangleTree::build(std::uint32_t first, std::uint32_t count) {
    Eigen::AlignedBox3d box;
    for (std::uint32_t t = first; t < first + count; ++t)
        for (const std::uint32_t v : triangles_[t]) box.extend(corner(v));
    const std::size_t self = nodes_.size();
    nodes_.push_back({box, first, count});
    if (count <= 4) return;
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    const auto middle = [&](const std::array<std::uint32_t, 3>& t) {
        double sum = 0;
        for (const std::uint32_t v : t) sum += corner(v)[axis];
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

double TriangleTree::squared_distance(const Vector3d& p, double enough) const {
    double best = std::numeric_limits<double>::infinity();
    // Median splits of fewer than 2^32 triangles are at most 32 levels deep, and one node waits on each
    // level.
    std::array<std::uint32_t, 64> waiting{};
    std::size_t count = 0;
    waiting[count++] = 0;
    while (count > 0 && best > enough) {
        const std::uint32_t n = waiting[--count];
        const Node& node = nodes_[n];
        if (node.box.squaredExteriorDistance(p) >= best) continue;
        if (node.count > 0) {
            for (std::uint32_t t = node.first; t < node.first + node.count; ++t)
                best = std::min(best, squared_distance_to_triangle(p, corner(triangles_[t][0]),
                                                                   corner(triangles_[t][1]),
                                                                   corner(triangles_[t][2])));
            continue;
        }
        std::uint32_t near = n + 1, far = node.first;
        if (nodes_[far].box.squaredExteriorDistance(p) < nodes_[near].box.squaredExteriorDistance(p))
            std::swap(near, far);
        waiting[count++] = far;
        waiting[count++] = near;
    }
    return best;
}

} // namespace vox::io
