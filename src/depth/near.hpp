// The triangles near a point, by a tree of boxes eight children wide, in single precision. Nothing here
// decides: what cannot be ruled out goes to the caller, who computes in double.
#pragma once

#include <cstddef>
#include <cstdint>

namespace vox::depth {

inline constexpr std::size_t tree_width = 8;

// Eight triangles: a corner of each, and the edges from there to the other two.
struct alignas(32) TreeLeaf {
    float a[3][tree_width], ab[3][tree_width], ac[3][tree_width];
};

// What bounds each of eight children: a box along three axes of its own, which are orthonormal to rounding.
// In parts of a few hundred triangles, the first is their mean normal: where a surface is nearly flat, such a
// box is a much better bound of the distance than one along the coordinate axes. A child that does not exist
// has an empty box.
struct alignas(32) TreeNode {
    float axis[3][3][tree_width];
    float low[3][tree_width], high[3][tree_width];
};

// A complete tree. Level 0 are the leaves; node i of level l > 0 is nodes[first[l] + i], and its children are
// those of level l - 1 from 8 i on. The last level has one node.
struct TreeView {
    static constexpr std::size_t most_levels = 12; // for 2^32 triangles

    const TreeLeaf* leaves;
    const TreeNode* nodes;
    const std::uint32_t* triangles; // of the lanes of the leaves
    const std::uint32_t* part;      // of the leaves, then of the nodes, or mixed; null: all are of one part
    std::size_t first[most_levels];
    std::size_t count[most_levels]; // of leaves, or of nodes of a level
    std::size_t levels;

    static constexpr std::uint32_t mixed = ~0u; // as the part that is looked for: all of them

    // Whether a leaf or node has triangles of a part.
    bool has(std::uint32_t wanted, std::size_t level, std::size_t index) const noexcept {
        if (wanted == mixed || !part) return true;
        const std::uint32_t found = part[level == 0 ? index : count[0] + first[level] + index];
        return found == wanted || found == mixed;
    }
};

// Makes the nodes from `begin` to `end` of a level from the leaves, and the nodes of the level below.
void refit_nodes(const TreeView& tree, std::size_t level, std::size_t begin, std::size_t end,
                 TreeNode* nodes);


// The receiver of triangles. It returns a new reach, not more than the last one.
using VisitTriangle = float (*)(void* receiver, std::uint32_t triangle);

// Calls visit for the triangles of a part, or all, that may be within `reach` of p, the nearest first as far
// as that is known. The distances compared are rounded: with coordinates up to M in magnitude, p included,
// they are too large by at most 2^-19 M and a factor of 1 + 2^-20, which is for the caller to add to `reach`.
void find_near(const TreeView& tree, std::uint32_t part, const float (&p)[3], float reach,
               VisitTriangle visit, void* receiver);

} // namespace vox::depth
