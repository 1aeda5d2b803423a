// The body-centred cubic lattice for isosurface stuffing, and sparse sets of its points.
//
// Coordinates are integers in units of half a cell. A lattice point has three even coordinates (a corner of
// the cubic cells) or three odd ones (a centre of a cell). It has fourteen neighbours, six along the axes at
// distance 2 (long edges) and eight along the cubes' diagonals at distance sqrt(3) (short edges).
#pragma once

#include "base/eigen.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vox::io {

struct Node {
    std::int32_t x, y, z;
};

// Neighbour k is at neighbour_steps[k], and neighbour k ^ 1 opposite to it. k / 2 is the direction, of which
// 0, 1 and 2 are the axes.
inline constexpr Node neighbour_steps[] = {{2, 0, 0},  {-2, 0, 0},  {0, 2, 0},    {0, -2, 0}, {0, 0, 2},
                                           {0, 0, -2}, {1, 1, 1},   {-1, -1, -1}, {1, 1, -1}, {-1, -1, 1},
                                           {1, -1, 1}, {-1, 1, -1}, {1, -1, -1},  {-1, 1, 1}};
inline constexpr unsigned long_neighbours = 6; // the first six, at the end of long edges

constexpr Node operator+(const Node& a, const Node& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

// The lattice's position in space, and how many cells it has.
struct Frame {
    std::array<double, 3> origin{}; // position of node (0, 0, 0)
    double half_cell = 0;
    std::array<std::int32_t, 3> cells{}; // nodes run from 0 to 2 * cells

    std::array<double, 3> position(double x, double y, double z) const {
        return {origin[0] + x * half_cell, origin[1] + y * half_cell, origin[2] + z * half_cell};
    }
};

// The longest possible side of a lattice, in cells.
inline constexpr std::int32_t max_cells = 4096;

// A lattice of cells with edge `cell`, centred on the box, with a margin of two cells on each side. Throws
// LIMIT if the box is longer than max_cells cells along an axis.
Frame make_frame(const Eigen::AlignedBox3d& box, double cell);

// The nodes (2 * first + parity, y, z) to (2 * last + parity, y, z), where parity is that of y and of z.
struct Run {
    std::int32_t y, z;
    std::int32_t first, last;
};

// A set of nodes stored as runs along x. Nodes are numbered 0 to size - 1, row by row. Memory is proportional
// to the number of rows and runs.
class NodeSet {
public:
    static constexpr std::uint32_t none = 0xffffffffu;

    NodeSet() = default;
    // The union of the runs. Throws LIMIT if it would contain more than 2^32 - 2 nodes.
    NodeSet(const Frame& frame, std::vector<Run> runs);

    std::uint32_t size() const { return size_; }

    std::uint32_t find(const Node& node) const {
        const std::int32_t parity = node.y & 1;
        const std::int32_t y = node.y >> 1, z = node.z >> 1, i = node.x >> 1;
        if (static_cast<std::uint32_t>(y) >= static_cast<std::uint32_t>(rows_y_) ||
            static_cast<std::uint32_t>(z) >= static_cast<std::uint32_t>(rows_z_))
            return none;
        const std::size_t row = row_of(parity, y, z);
        for (std::uint32_t r = row_start_[row]; r < row_start_[row + 1]; ++r) {
            const Span& span = spans_[r];
            if (i < span.first) return none;
            if (i <= span.last) return span.number + static_cast<std::uint32_t>(i - span.first);
        }
        return none;
    }

    // Calls visit(number of the first node, run) for every run, in the order of the numbers.
    template <class Visit>
    void for_each_run(Visit&& visit) const {
        for (std::size_t row = 0; row + 1 < row_start_.size(); ++row)
            for (std::uint32_t r = row_start_[row]; r < row_start_[row + 1]; ++r) {
                const auto in_parity =
                    row % (static_cast<std::size_t>(rows_y_) * static_cast<std::size_t>(rows_z_));
                const std::int32_t parity = in_parity == row ? 0 : 1;
                const auto y = static_cast<std::int32_t>(in_parity % static_cast<std::size_t>(rows_y_));
                const auto z = static_cast<std::int32_t>(in_parity / static_cast<std::size_t>(rows_y_));
                visit(spans_[r].number, Run{2 * y + parity, 2 * z + parity, spans_[r].first, spans_[r].last});
            }
    }

    // Calls visit(number, node) for every node, in the order of the numbers.
    template <class Visit>
    void for_each_node(Visit&& visit) const {
        for_each_run([&](std::uint32_t number, const Run& run) {
            for (std::int32_t i = run.first; i <= run.last; ++i, ++number)
                visit(number, Node{2 * i + (run.y & 1), run.y, run.z});
        });
    }

private:
    struct Span {
        std::int32_t first, last;
        std::uint32_t number; // of the first node
    };

    std::size_t row_of(std::int32_t parity, std::int32_t y, std::int32_t z) const {
        return (static_cast<std::size_t>(parity) * static_cast<std::size_t>(rows_z_) +
                static_cast<std::size_t>(z)) *
                   static_cast<std::size_t>(rows_y_) +
               static_cast<std::size_t>(y);
    }

    std::int32_t rows_y_ = 0, rows_z_ = 0; // numbers of rows of one parity
    std::uint32_t size_ = 0;
    std::vector<std::uint32_t> row_start_;
    std::vector<Span> spans_;
};

// The nodes together with all their neighbours.
NodeSet with_neighbours(const Frame& frame, const NodeSet& nodes);

} // namespace vox::io
