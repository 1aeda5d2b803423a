// Distances from points to a set of triangles.
#pragma once

#include "base/eigen.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace vox::io {

// A bounding volume hierarchy over triangles, built by median splits.
class TriangleTree {
public:
    // `positions`: 3 a vertex, borrowed; `triangles`: 3 indices each. At least one triangle.
    TriangleTree(const double* positions, std::vector<std::uint32_t> triangles);

    // Squared distance to the nearest triangle. If that is at most `enough`, any number up to `enough` may be
    // returned.
    double squared_distance(const Eigen::Vector3d& p, double enough) const;

private:
    struct Node {
        Eigen::AlignedBox3d box;
        std::uint32_t first, count; // triangles; with count 0, the children are this node + 1 and `first`
    };

    Eigen::Vector3d corner(std::uint32_t vertex) const;
    void build(std::uint32_t first, std::uint32_t count);

    const double* positions_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    std::vector<Node> nodes_;
};

} // namespace vox::io
