// A balanced octree of body-centred cells, uniform at the boundary: Labelle and Shewchuk 2007, Sect. 4. Its
// tetrahedra are those of the lattice, halves of them if an edge has a midpoint, and half pyramids and
// quarter pyramids between cells of different size. Their dihedral angles are at least 45 degrees.
#include "io/solids/coarsen.hpp"

#include "io/determinant.hpp"

#include <utility>

namespace vox::io {
namespace {

Node step(const Node& cell, unsigned axis, std::int32_t by) {
    Node moved = cell;
    (axis == 0 ? moved.x : axis == 1 ? moved.y : moved.z) += by;
    return moved;
}

Node parent(const Node& cell) { return {cell.x >> 1, cell.y >> 1, cell.z >> 1}; }

Node centre(std::size_t level, const Node& cell) {
    const auto half = std::int32_t{1} << level;
    return {(2 * cell.x + 1) * half, (2 * cell.y + 1) * half, (2 * cell.z + 1) * half};
}

Node between(const Node& a, const Node& b) { return {(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2}; }

std::int64_t orientation(const std::array<Node, 4>& t) {
    std::array<std::array<std::int64_t, 3>, 3> e{};
    for (std::size_t i = 0; i < 3; ++i)
        e[i] = {t[i + 1].x - t[0].x, t[i + 1].y - t[0].y, t[i + 1].z - t[0].z};
    return determinant(e[0], e[1], e[2]);
}

} // namespace

Octree::Octree(const Frame& frame, const NodeSet& inside, const std::function<bool(const Node&)>& is_inner,
               std::uint32_t levels) {
    if (levels == 0) return;
    std::vector<Run> runs;
    const auto append = [&runs](const Node& cell) {
        if (!runs.empty() && runs.back().y == 2 * cell.y && runs.back().z == 2 * cell.z &&
            runs.back().last == cell.x - 1)
            ++runs.back().last;
        else
            runs.push_back({2 * cell.y, 2 * cell.z, cell.x, cell.x});
    };
    inside.for_each_node([&](std::uint32_t, const Node& node) {
        if (node.y % 2 == 0) return;
        bool all = is_inner(node);
        for (unsigned k = long_neighbours; k < std::size(neighbour_steps) && all; ++k)
            all = is_inner(node + neighbour_steps[k]);
        if (all) append({node.x >> 1, node.y >> 1, node.z >> 1});
    });
    merged_.emplace_back(frame, std::exchange(runs, {}));
    Frame coarse = frame;
    for (std::size_t level = 0; level < levels && merged_[level].size() > 0; ++level) {
        for (std::int32_t& cells : coarse.cells) cells = (cells + 1) / 2;
        merged_[level].for_each_run([&](std::uint32_t, const Run& run) {
            if (run.y % 4 != 0 || run.z % 4 != 0) return;
            // A cell of the next level needs its eight parts and the ring of cells around them.
            for (std::int32_t i = (run.first + 1) / 2; 2 * i + 2 <= run.last; ++i) {
                bool all = 2 * i - 1 >= run.first;
                for (std::int32_t n = 0; n < 64 && all; ++n)
                    all =
                        holds(level, {2 * i - 1 + n % 4, run.y / 2 - 1 + n / 4 % 4, run.z / 2 - 1 + n / 16});
                if (all) append({i, run.y / 4, run.z / 4});
            }
        });
        merged_.emplace_back(coarse, std::exchange(runs, {}));
    }
}

void Octree::for_each_tet(const std::function<void(const std::array<Node, 4>&)>& emit) const {
    const auto emit_positive = [&emit](std::array<Node, 4> tet) {
        if (orientation(tet) < 0) std::swap(tet[2], tet[3]);
        emit(tet);
    };
    const auto leaf_faces = [&](std::size_t level, const Node& cell) {
        const std::int32_t side = std::int32_t{2} << level; // in node coordinates
        const Node apex = centre(level, cell);
        for (unsigned axis = 0; axis < 3; ++axis)
            for (const std::int32_t direction : {-1, 1}) {
                const Node next = step(cell, axis, direction);
                const bool larger = holds(level + 1, parent(next));
                const bool equal = !larger && level > 0 && direction > 0 && is_leaf(level, next);
                if (!larger && !equal) continue;
                // The corners of the face, in cyclic order.
                const unsigned u = (axis + 1) % 3, v = (axis + 2) % 3;
                std::array<Node, 4> corners;
                corners[0] =
                    step({cell.x * side, cell.y * side, cell.z * side}, axis, direction > 0 ? side : 0);
                corners[1] = step(corners[0], u, side);
                corners[2] = step(corners[1], v, side);
                corners[3] = step(corners[0], v, side);
                if (larger) {
                    // The face is split by the diagonal to the centre of the larger cell's face, where four
                    // of these faces meet.
                    const Node far_apex = centre(level + 1, parent(next));
                    for (unsigned c = 0; c < 4; ++c) {
                        const Node& middle = corners[c];
                        const bool on_axis = (axis == 0 || middle.x == far_apex.x) &&
                                             (axis == 1 || middle.y == far_apex.y) &&
                                             (axis == 2 || middle.z == far_apex.z);
                        if (!on_axis) continue;
                        const Node& opposite = corners[(c + 2) % 4];
                        for (const unsigned other : {(c + 1) % 4, (c + 3) % 4}) {
                            emit_positive({apex, middle, opposite, corners[other]});
                            emit_positive({far_apex, middle, opposite, corners[other]});
                        }
                    }
                    continue;
                }
                const Node far_apex = centre(level, next);
                for (unsigned c = 0; c < 4; ++c) {
                    // The edge has a midpoint if a cell across it is smaller.
                    const unsigned across = c % 2 == 0 ? v : u;
                    const std::int32_t away = c == 0 || c == 3 ? -1 : 1;
                    const Node &p = corners[c], &q = corners[(c + 1) % 4];
                    if (holds(level, step(cell, across, away)) && holds(level, step(next, across, away))) {
                        emit_positive({apex, far_apex, p, q});
                    } else {
                        emit_positive({apex, far_apex, p, between(p, q)});
                        emit_positive({apex, far_apex, between(p, q), q});
                    }
                }
            }
    };
    for (std::size_t level = 0; level < merged_.size(); ++level)
        merged_[level].for_each_node([&](std::uint32_t, const Node& node) {
            const Node cell = {node.x >> 1, node.y >> 1, node.z >> 1};
            if (is_leaf(level, cell)) leaf_faces(level, cell);
        });
}

} // namespace vox::io
