// The search of a tree of boxes, nearest first. The boxes are in single precision, rounded
// outwards, so that they contain the doubles that they bound.
#pragma once

#include "base/boxes.hpp"
#include "base/scene.hpp"

#include <cstddef>
#include <limits>
#include <span>
#include <utility>

namespace vox {

// Calls visit(leaf) for each leaf whose bound(box) is at most `most`, which visit() may lower; the nearer
// child comes first. bound() is infinite for an empty box. The tree is a complete binary one, with the root 1
// and the children 2 i and 2 i + 1 of i.
template <class Bound, class Visit>
void visit_nearest_first(std::span<const Box3f> tree, const double& most, Bound&& bound, Visit&& visit) {
    struct Entry {
        std::size_t node;
        double bound;
    };
    Entry stack[64]; // at most two a level
    std::size_t size = 0;
    const auto put = [&](const Entry& entry) {
        if (entry.bound <= most && entry.bound < std::numeric_limits<double>::infinity())
            stack[size++] = entry;
    };
    put({1, bound(tree[1])});
    while (size > 0) {
        const Entry entry = stack[--size];
        if (!(entry.bound <= most)) continue; // `most` was lowered in between
        if (entry.node >= tree.size() / 2) {
            visit(entry.node - tree.size() / 2);
            continue;
        }
        Entry near{2 * entry.node, bound(tree[2 * entry.node])};
        Entry far{near.node + 1, bound(tree[near.node + 1])};
        if (far.bound < near.bound) std::swap(near, far);
        put(far);
        put(near);
    }
}

} // namespace vox
