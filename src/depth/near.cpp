// Branch and bound, nearest first (Roussopoulos, Kelley, Vincent, "Nearest neighbor queries", SIGMOD 1995),
// with the eight children of a node in the lanes of a register (Wald, Benthin, Boulos, "Getting rid of
// packets", IEEE Symposium on Interactive Ray Tracing 2008).
//
// A triangle is ruled out by a plane. Let g be any vector from a point of the triangle to p: no point of the
// triangle is nearer to p than the least of g (p - v) / |g| over its corners v. For the closest point that is
// the distance itself, and for a point that rounding made a poor choice it is still a lower bound. So the
// closest point may be computed without care (Ericson, Real-Time Collision Detection, 2005, Sect. 5.1.5).
//
// The rounding of the bounds. Positions, and the sums and products of three terms in g (p - v), are each off
// by a few u M |g|, u = 2^-24, less than 2^-19 M |g| together.
#include "depth/near.hpp"

#include "base/simd.hpp"

#include <limits>
#include <utility>

#undef VOX_SOURCE
#define VOX_SOURCE "depth/near.cpp"
#include "base/each_target.hpp"

#include "base/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace vox::depth {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, tree_width>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

struct V3 {
    V x, y, z;
};

HWY_INLINE V3 Load3(const float (*from)[tree_width], std::size_t lane) {
    const D d;
    return {hn::Load(d, from[0] + lane), hn::Load(d, from[1] + lane), hn::Load(d, from[2] + lane)};
}
HWY_INLINE V3 Set3(const float* p) {
    const D d;
    return {hn::Set(d, p[0]), hn::Set(d, p[1]), hn::Set(d, p[2])};
}
HWY_INLINE V3 Sub3(const V3& a, const V3& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE V3 Scale3(V s, const V3& a) { return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)}; }
HWY_INLINE V Dot3(const V3& a, const V3& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE V Difference(V a, V b, V c, V d) { return hn::Sub(hn::Mul(a, b), hn::Mul(c, d)); }

HWY_INLINE unsigned Bits(M mask) { return static_cast<unsigned>(vox::HWY_NAMESPACE::BitsOfMask(D(), mask)); }

// ---- search -----------------------------------------------------------------------------------------

// For each triangle of a leaf, g and the bound g (p - v), and the bits of those that are not ruled out.
struct Bounds {
    alignas(32) float bound[tree_width], squared[tree_width];
};

// True if a triangle is not farther than `reach`; true where the numbers are not comparable.
HWY_INLINE bool MayBeNear(float bound, float squared, float reach) {
    return !(bound > 0 && bound * bound > reach * reach * squared);
}

HWY_INLINE unsigned BoundTriangles(const TreeLeaf& leaf, const V3& p, float reach, Bounds& out) {
    const D d;
    const V zero = hn::Zero(d), one = hn::Set(d, 1.0f), squared_reach = hn::Set(d, reach * reach);
    unsigned near = 0;
    for (std::size_t lane = 0; lane < tree_width; lane += hn::Lanes(d)) {
        const V3 ab = Load3(leaf.ab, lane), ac = Load3(leaf.ac, lane), ap = Sub3(p, Load3(leaf.a, lane));
        const V abab = Dot3(ab, ab), abac = Dot3(ab, ac), acac = Dot3(ac, ac);
        const V d1 = Dot3(ab, ap), d2 = Dot3(ac, ap);
        const V d3 = hn::Sub(d1, abab), d4 = hn::Sub(d2, abac);
        const V d5 = hn::Sub(d1, abac), d6 = hn::Sub(d2, acac);
        const V vc = Difference(d1, d4, d3, d2), vb = Difference(d5, d2, d1, d6),
                va = Difference(d3, d6, d5, d4);
        const V e1 = hn::Sub(d4, d3), e2 = hn::Sub(d5, d6);
        // Weights of b and c, times `whole`: inside, then on an edge, then at a corner.
        V whole = hn::Add(va, hn::Add(vb, vc)), b = vb, c = vc;
        const auto set = [&](M where, V new_b, V new_c, V new_whole) HWY_ATTR {
            b = hn::IfThenElse(where, new_b, b);
            c = hn::IfThenElse(where, new_c, c);
            whole = hn::IfThenElse(where, new_whole, whole);
        };
        const auto both = [](M x, M y) HWY_ATTR { return hn::And(x, y); };
        set(both(hn::Le(va, zero), both(hn::Ge(e1, zero), hn::Ge(e2, zero))), e2, e1, hn::Add(e1, e2));
        set(both(hn::Le(vb, zero), both(hn::Ge(d2, zero), hn::Le(d6, zero))), zero, d2, hn::Sub(d2, d6));
        set(both(hn::Ge(d6, zero), hn::Le(d5, d6)), zero, one, one);
        set(both(hn::Le(vc, zero), both(hn::Ge(d1, zero), hn::Le(d3, zero))), d1, zero, hn::Sub(d1, d3));
        set(both(hn::Ge(d3, zero), hn::Le(d4, d3)), one, zero, one);
        set(both(hn::Le(d1, zero), hn::Le(d2, zero)), zero, zero, one);
        const V3 g = Sub3(Sub3(ap, Scale3(hn::Div(b, whole), ab)), Scale3(hn::Div(c, whole), ac));
        const V squared = Dot3(g, g);
        const V bound = hn::Sub(Dot3(g, ap), hn::Max(zero, hn::Max(Dot3(g, ab), Dot3(g, ac))));
        hn::Store(bound, d, out.bound + lane);
        hn::Store(squared, d, out.squared + lane);
        const M far =
            both(hn::Gt(bound, zero), hn::Gt(hn::Mul(bound, bound), hn::Mul(squared_reach, squared)));
        near |= Bits(hn::Not(far)) << lane;
    }
    return near;
}

// A lower bound of the squared distance to each child of a node, and the bits of those within reach.
HWY_INLINE unsigned BoundChildren(const TreeNode& node, const V3& p, float reach, float* squared) {
    const D d;
    const V zero = hn::Zero(d), squared_reach = hn::Set(d, reach * reach);
    const V infinite = hn::Set(d, std::numeric_limits<float>::infinity());
    const V at[3] = {p.x, p.y, p.z};
    unsigned near = 0;
    for (std::size_t lane = 0; lane < tree_width; lane += hn::Lanes(d)) {
        const auto beyond = [&](std::size_t k) HWY_ATTR {
            return hn::Max(zero, hn::Max(hn::Sub(hn::Load(d, node.low[k] + lane), at[k]),
                                         hn::Sub(at[k], hn::Load(d, node.high[k] + lane))));
        };
        const V3 out = {beyond(0), beyond(1), beyond(2)};
        const V bound = Dot3(out, out);
        hn::Store(bound, d, squared + lane);
        const M is_near = hn::And(hn::Le(bound, squared_reach), hn::Lt(bound, infinite));
        near |= Bits(is_near) << lane;
    }
    return near;
}

HWY_INLINE unsigned LowestBit(unsigned bits) {
    return static_cast<unsigned>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
}

// Visits the triangles of a leaf, at first the one that seems to be the nearest.
HWY_INLINE float VisitLeaf(const TreeLeaf& leaf, const std::uint32_t* triangles, const V3& p, float reach,
                           VisitTriangle visit, void* receiver) {
    Bounds at;
    unsigned near = BoundTriangles(leaf, p, reach, at);
    while (near != 0) {
        unsigned best = LowestBit(near);
        for (unsigned rest = near & (near - 1); rest != 0; rest &= rest - 1)
            if (at.squared[LowestBit(rest)] < at.squared[best]) best = LowestBit(rest);
        near &= ~(1u << best);
        reach = visit(receiver, triangles[best]);
        for (unsigned rest = near; rest != 0; rest &= rest - 1) {
            const unsigned lane = LowestBit(rest);
            if (!MayBeNear(at.bound[lane], at.squared[lane], reach)) near &= ~(1u << lane);
        }
    }
    return reach;
}

// A leaf or node, and a lower bound of the squared distance to it.
struct Far {
    std::uint32_t number;
    float squared;
};

// Appends the children whose bits are set. Writes up to tree_width of them.
HWY_INLINE std::size_t Append(unsigned near, std::uint32_t first, const float* squared, Far* out) {
    std::size_t count = 0;
    for (unsigned child = 0; child < tree_width; ++child) { // without branches
        out[count] = {first + child, squared[child]};
        count += near >> child & 1;
    }
    return count;
}

HWY_INLINE unsigned OfPart(const TreeView& tree, std::uint32_t part, std::uint32_t first, unsigned near) {
    for (unsigned rest = near; rest != 0; rest &= rest - 1)
        if (!tree.has(part, first + LowestBit(rest))) near &= ~(rest & (0u - rest));
    return near;
}

// The leaf that one comes to by always taking the nearest child.
HWY_INLINE std::uint32_t NearestLeaf(const TreeView& tree, std::uint32_t part, const V3& p, float reach) {
    std::uint32_t number = tree.leaf_count + tree.node_count - 1;
    while (number >= tree.leaf_count) {
        alignas(32) float squared[tree_width];
        const TreeNode& node = tree.nodes[number - tree.leaf_count];
        unsigned near = BoundChildren(node, p, reach, squared);
        if (tree.part) near = OfPart(tree, part, node.first_child, near);
        if (near == 0) return tree.leaf_count;
        unsigned best = LowestBit(near);
        for (near &= near - 1; near != 0; near &= near - 1)
            if (squared[LowestBit(near)] < squared[best]) best = LowestBit(near);
        number = node.first_child + best;
    }
    return number;
}

void FindNear(const TreeView& tree, std::uint32_t part, const float* point, float reach, VisitTriangle visit,
              void* receiver) {
    const V3 p = Set3(point);
    const auto visit_leaf = [&](std::uint32_t leaf) HWY_ATTR {
        reach = VisitLeaf(tree.leaves[leaf], tree.triangles + leaf * tree_width, p, reach, visit, receiver);
    };
    if (reach == std::numeric_limits<float>::infinity()) {
        const std::uint32_t leaf = NearestLeaf(tree, part, p, reach);
        if (leaf < tree.leaf_count) visit_leaf(leaf);
    }
    // A fair reach is known by now. Leaves wait for each other, so that the nearest one comes first: it may
    // make the others too far.
    constexpr std::size_t most_leaves = 64;
    Far nodes[TreeView::most_levels * tree_width + tree_width], leaves[most_leaves + tree_width];
    std::size_t node_count = 1, leaf_count = 0;
    nodes[0] = {tree.leaf_count + tree.node_count - 1, 0};
    const auto visit_leaves = [&]() HWY_ATTR {
        std::size_t nearest = 0;
        for (std::size_t i = 1; i < leaf_count; ++i)
            if (leaves[i].squared < leaves[nearest].squared) nearest = i;
        if (leaf_count > 0) std::swap(leaves[0], leaves[nearest]);
        for (std::size_t i = 0; i < leaf_count; ++i)
            if (leaves[i].squared <= reach * reach) visit_leaf(leaves[i].number);
        leaf_count = 0;
    };
    while (node_count > 0) {
        const Far at = nodes[--node_count];
        if (at.squared > reach * reach) continue;
        const TreeNode& node = tree.nodes[at.number - tree.leaf_count];
        alignas(32) float squared[tree_width];
        unsigned near = BoundChildren(node, p, reach, squared);
        if (tree.part) near = OfPart(tree, part, node.first_child, near);
        if (node.first_child >= tree.leaf_count) {
            node_count += Append(near, node.first_child, squared, nodes + node_count);
            continue;
        }
        leaf_count += Append(near, node.first_child, squared, leaves + leaf_count);
        if (leaf_count >= most_leaves) visit_leaves();
    }
    visit_leaves();
}

void FindNearestFirst(const TreeView& tree, std::uint32_t part, const float* point, float reach,
                      VisitTriangle visit, void* receiver) {
    struct Entry {
        std::uint32_t number;
        float squared;
    };
    const V3 p = Set3(point);
    Entry stack[TreeView::most_levels * tree_width];
    std::size_t size = 1;
    stack[0] = {tree.leaf_count + tree.node_count - 1, 0};
    while (size > 0) {
        const Entry entry = stack[--size];
        if (entry.squared > reach * reach) continue;
        if (entry.number < tree.leaf_count) {
            reach = VisitLeaf(tree.leaves[entry.number], tree.triangles + entry.number * tree_width, p, reach,
                              visit, receiver);
            continue;
        }
        alignas(32) float squared[tree_width];
        const TreeNode& node = tree.nodes[entry.number - tree.leaf_count];
        unsigned near = BoundChildren(node, p, reach, squared);
        if (tree.part) near = OfPart(tree, part, node.first_child, near);
        const std::size_t first = size; // the farthest
        for (; near != 0; near &= near - 1) {
            const unsigned child = LowestBit(near);
            std::size_t place = size++;
            for (; place > first && stack[place - 1].squared < squared[child]; --place)
                stack[place] = stack[place - 1];
            stack[place] = {node.first_child + child, squared[child]};
        }
    }
}

// ---- refit ------------------------------------------------------------------------------------------

HWY_INLINE float Least(V v) { return hn::GetLane(hn::MinOfLanes(D(), v)); }
HWY_INLINE float Most(V v) { return hn::GetLane(hn::MaxOfLanes(D(), v)); }

// Makes a child of a node have the box of a leaf.
HWY_INLINE void BoxOfLeaf(const TreeLeaf& leaf, TreeNode& node, std::size_t child) {
    const D d;
    for (std::size_t k = 0; k < 3; ++k) {
        V low = hn::Set(d, std::numeric_limits<float>::infinity()), high = hn::Neg(low);
        for (std::size_t lane = 0; lane < tree_width; lane += hn::Lanes(d)) {
            const V a = hn::Load(d, leaf.a[k] + lane), b = hn::Add(a, hn::Load(d, leaf.ab[k] + lane)),
                    c = hn::Add(a, hn::Load(d, leaf.ac[k] + lane));
            low = hn::Min(low, hn::Min(a, hn::Min(b, c)));
            high = hn::Max(high, hn::Max(a, hn::Max(b, c)));
        }
        node.low[k][child] = Least(low);
        node.high[k][child] = Most(high);
    }
}

// Makes a child of a node have the box around all children of another node.
HWY_INLINE void BoxOfNode(const TreeNode& from, TreeNode& node, std::size_t child) {
    const D d;
    for (std::size_t k = 0; k < 3; ++k) {
        V low = hn::Load(d, from.low[k]), high = hn::Load(d, from.high[k]);
        for (std::size_t lane = hn::Lanes(d); lane < tree_width; lane += hn::Lanes(d)) {
            low = hn::Min(low, hn::Load(d, from.low[k] + lane));
            high = hn::Max(high, hn::Load(d, from.high[k] + lane));
        }
        node.low[k][child] = Least(low);
        node.high[k][child] = Most(high);
    }
}

void RefitNodes(const TreeView& tree, const TreeLevel& level, std::size_t begin, std::size_t end,
                TreeNode* nodes) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (std::size_t i = begin; i < end; ++i) {
        TreeNode& node = nodes[level.first + i];
        node.first_child = level.first_child + static_cast<std::uint32_t>(i * tree_width);
        for (std::size_t child = 0; child < tree_width; ++child) {
            const std::uint32_t number = node.first_child + static_cast<std::uint32_t>(child);
            if (number >= level.last_child) {
                for (std::size_t k = 0; k < 3; ++k) {
                    node.low[k][child] = infinity;
                    node.high[k][child] = -infinity;
                }
            } else if (number < tree.leaf_count) {
                BoxOfLeaf(tree.leaves[number], node, child);
            } else {
                BoxOfNode(nodes[number - tree.leaf_count], node, child);
            }
        }
    }
}

} // namespace HWY_NAMESPACE
} // namespace vox::depth
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox::depth {

void refit_nodes(const TreeView& tree, const TreeLevel& level, std::size_t begin, std::size_t end,
                 TreeNode* nodes) {
    VOX_SIMD_DISPATCH(RefitNodes)(tree, level, begin, end, nodes);
}

void find_near(const TreeView& tree, std::uint32_t part, const float (&p)[3], float reach,
               VisitTriangle visit, void* receiver) {
    VOX_SIMD_DISPATCH(FindNear)(tree, part, p, reach, visit, receiver);
}

void find_nearest_first(const TreeView& tree, std::uint32_t part, const float (&p)[3], float reach,
                        VisitTriangle visit, void* receiver) {
    VOX_SIMD_DISPATCH(FindNearestFirst)(tree, part, p, reach, visit, receiver);
}

} // namespace vox::depth
#endif
