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

// The boxes of eight children. A child that does not exist has an empty one.
struct alignas(32) TreeNode {
    float low[3][tree_width], high[3][tree_width];
    std::uint32_t first_child; // its number
};

// A complete tree. Leaves and nodes are numbered, leaves first, then level after level up to the root, which
// comes last and is a node.
struct TreeView {
    static constexpr std::size_t most_levels = 12; // for 2^32 triangles

    const TreeLeaf* leaves;
    const TreeNode* nodes;          // number leaf_count + i is nodes[i]
    const std::uint32_t* triangles; // of the lanes of the leaves
    const std::uint32_t* part;      // by number, of the triangles there, or mixed; null: all are of one part
    std::uint32_t leaf_count, node_count;

    static constexpr std::uint32_t mixed = ~0u; // as the part that is looked for: all of them

    // True if a leaf or node has triangles of a part.
    bool has(std::uint32_t wanted, std::uint32_t number) const noexcept {
        return wanted == mixed || !part || part[number] == wanted || part[number] == mixed;
    }
};

// Nodes of one level, or some of them: their children are next to each other.
struct TreeLevel {
    std::size_t first, count;              // in nodes
    std::uint32_t first_child, last_child; // numbers
};

// Makes the nodes of a level from `begin` to `end` from the leaves, and from the nodes below.
void refit_nodes(const TreeView& tree, const TreeLevel& level, std::size_t begin, std::size_t end,
                 TreeNode* nodes);

// The receiver of triangles. It returns a new reach, not more than the last one.
using VisitTriangle = float (*)(void* receiver, std::uint32_t triangle);

// Calls visit for the triangles of a part, or all, that may be within `reach` of p. Where that is infinite,
// it begins with some that are near. The distances compared are rounded: with coordinates up to M in
// magnitude, p included, they are too large by at most 2^-19 M and a factor of 1 + 2^-20, which is for the
// caller to add to `reach`.
void find_near(const TreeView& tree, std::uint32_t part, const float (&p)[3], float reach,
               VisitTriangle visit, void* receiver);

// Visits the nearest boxes first: slower, but better where the known reach is much too long.
void find_nearest_first(const TreeView& tree, std::uint32_t part, const float (&p)[3], float reach,
                        VisitTriangle visit, void* receiver);

} // namespace vox::depth
