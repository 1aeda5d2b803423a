// Makes larger tetrahedra away from the boundary: finds the lattice cells that may be merged, and the
// tetrahedra of merged cells.
#pragma once

#include "io/solids/lattice.hpp"

#include <functional>
#include <vector>

namespace vox::io {

// An octree over the lattice's cells, stored as the cells of each level that are leaves or parts of larger
// cells. Leaves that touch, even at a corner, differ by at most one level.
class Octree {
public:
    Octree() = default;
    // `is_inner(node)` says whether a node is strictly inside and was not moved. Cells of which all nodes are
    // inner may be merged, at most `levels` times.
    Octree(const Frame& frame, const NodeSet& inside, const std::function<bool(const Node&)>& is_inner,
           std::uint32_t levels);

    // Whether the lattice cell with this centre was merged into a larger one.
    bool is_merged(const Node& centre) const {
        return merged_.size() > 1 && holds(1, {centre.x >> 2, centre.y >> 2, centre.z >> 2});
    }

    // Calls emit for the tetrahedra of merged cells and for those between merged and other cells. All their
    // nodes are inner, and their volumes positive.
    void for_each_tet(const std::function<void(const std::array<Node, 4>&)>& emit) const;

private:
    // Whether cell (x, y, z) of `level` is a leaf or part of a larger cell.
    bool holds(std::size_t level, const Node& cell) const {
        return level < merged_.size() && cell.x >= 0 && cell.y >= 0 && cell.z >= 0 &&
               merged_[level].find({2 * cell.x, 2 * cell.y, 2 * cell.z}) != NodeSet::none;
    }
    bool is_leaf(std::size_t level, const Node& cell) const {
        return holds(level, cell) && !holds(level + 1, {cell.x >> 1, cell.y >> 1, cell.z >> 1});
    }

    std::vector<NodeSet> merged_; // the cells of each level, as nodes with even coordinates
};

} // namespace vox::io
