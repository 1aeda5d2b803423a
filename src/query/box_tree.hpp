// Boxes of a tree over doubles: single precision, rounded outwards, so that a box never misses what it
// bounds; and the walk through such a tree that meets what is nearest first.
#pragma once

#include "base/scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

namespace vox {

inline Box3f empty_box() noexcept {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    return {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
}

// The largest float that is not above, the smallest that is not below.
inline float round_down(double x) noexcept {
    constexpr float most = std::numeric_limits<float>::max();
    if (x >= double{most}) return most;
    if (x < -double{most}) return -std::numeric_limits<float>::infinity();
    const auto f = static_cast<float>(x);
    return double{f} <= x ? f : std::nextafter(f, -std::numeric_limits<float>::infinity());
}
inline float round_up(double x) noexcept { return -round_down(-x); }

inline void extend(Box3f& box, const Box3f& by) noexcept {
    box.min = {std::min(box.min.x, by.min.x), std::min(box.min.y, by.min.y), std::min(box.min.z, by.min.z)};
    box.max = {std::max(box.max.x, by.max.x), std::max(box.max.y, by.max.y), std::max(box.max.z, by.max.z)};
}

inline void extend(Box3f& box, const Vec3d& p) noexcept {
    extend(box, {{round_down(p.x), round_down(p.y), round_down(p.z)},
                 {round_up(p.x), round_up(p.y), round_up(p.z)}});
}

inline bool overlap(const Box3f& a, const Box3f& b) noexcept {
    return (a.min.x <= b.max.x) & (a.min.y <= b.max.y) & (a.min.z <= b.max.z) & (b.min.x <= a.max.x) &
           (b.min.y <= a.max.y) & (b.min.z <= a.max.z);
}

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
