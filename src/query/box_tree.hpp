// Boxes of a tree over doubles: single precision, rounded outwards, so that a box never misses what it
// bounds; and the walk through such a tree that meets what is nearest first.
#pragma once

#include "base/boxes.hpp"
#include "base/scene.hpp"

#include <cstddef>
#include <limits>
#include <span>
#include <utility>

namespace vox {

// A complete binary tree: the root is 1, the children of i are 2 i and 2 i + 1. Calls visit(leaf) for each
// leaf whose bound(box) is no more than `most`, which visit() may lower, the nearer child first. bound() is
// infinite for an empty box.
template <class Bound, class Visit>
void visit_nearest_first(std::span<const Box3f> tree, const double& most, Bound&& bound,
                         Visit&& visit) noexcept {
    struct Entry {
        std::size_t node;
        double bound;
    };
    Entry stack[64]; // two a level at most
    std::size_t size = 0;
    const auto put = [&](const Entry& entry) {
        if (entry.bound <= most && entry.bound < std::numeric_limits<double>::infinity())
            stack[size++] = entry;
    };
    put({1, bound(tree[1])});
    while (size > 0) {
        const Entry entry = stack[--size];
        if (!(entry.bound <= most)) continue; // any more
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
