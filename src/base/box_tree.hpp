// A tree of boxes, and its search nearest first. The boxes are in single precision, rounded outwards, so that
// they contain the doubles that they bound.
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "base/parallel.hpp"
#include "base/scene.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <span>
#include <utility>

namespace vox {

// A complete binary tree: node 1 is the root, 2 i and 2 i + 1 are the children of i, and the second half are
// the leaves. Each leaf is an item: the index of a box that the tree was built from.
class BoxTree {
public:
    explicit BoxTree(std::pmr::memory_resource* memory) noexcept
        : boxes_(memory), items_(memory), centres_(memory) {}

    // Makes room for so many items, so that build() needs no memory.
    void reserve(std::size_t items);
    // Splits at the median along the longest side of the box around the centres (J. L. Bentley,
    // Multidimensional binary search trees used for associative searching, CACM 18, 1975). Skips empty boxes.
    void build(std::span<const Box3f> boxes) {
        if (take(boxes)) split({1, centres_}, boxes);
    }
    // Enqueues at most one task, and throws what the workers throw; builds the same tree.
    void build(std::span<const Box3f> boxes, Workers& workers) {
        if (!take(boxes)) return;
        // The top of the tree is split here, the parts below it by the workers, if there are enough items.
        constexpr std::size_t least_items = 1024;
        std::array<Part, most_parts> parts;
        const std::size_t count = split_top(parts);
        workers.for_ranges(count, centres_.size() < least_items ? count : 1,
                           [&](std::size_t begin, std::size_t end, std::uint32_t) {
                               for (std::size_t p = begin; p < end; ++p) split(parts[p], boxes);
                           });
        join_top();
    }

    bool is_leaf(std::size_t node) const noexcept { return node >= items_.size(); }
    const Box3f& box(std::size_t node) const noexcept { return boxes_[node]; }
    std::uint32_t item(std::size_t leaf) const noexcept { return items_[leaf - items_.size()]; }

    // Calls visit(item) for each leaf whose bound(box) is at most `most`, which visit() may lower. The child
    // with the lower bound comes first.
    template <class Bound, class Visit>
    void visit_nearest_first(const double& most, Bound&& bound, Visit&& visit) const {
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
        if (items_.empty()) return;
        put({1, bound(boxes_[1])});
        while (size > 0) {
            const Entry entry = stack[--size];
            if (!(entry.bound <= most)) continue; // `most` was lowered meanwhile
            if (is_leaf(entry.node)) {
                visit(item(entry.node));
                continue;
            }
            Entry nearer{2 * entry.node, bound(boxes_[2 * entry.node])};
            Entry farther{nearer.node + 1, bound(boxes_[nearer.node + 1])};
            if (farther.bound < nearer.bound) std::swap(nearer, farther);
            put(farther);
            put(nearer);
        }
    }

    // Calls visit(item) for each leaf for which accepts(box) holds. It must hold for the nodes above, too.
    template <class Accepts, class Visit>
    void visit_accepted(Accepts&& accepts, Visit&& visit, std::size_t node = 1) const {
        if (items_.empty() || !accepts(boxes_[node])) return;
        if (is_leaf(node)) return visit(item(node));
        visit_accepted(accepts, visit, 2 * node);
        visit_accepted(accepts, visit, 2 * node + 1);
    }

private:
    struct Centre {
        float at[3];
        std::uint32_t item;
    };

    struct Part { // a node that is not split yet, and the items below it
        std::size_t node;
        std::span<Centre> centres;
    };

    static constexpr std::size_t most_parts = 16;

    bool take(std::span<const Box3f> boxes); // whether there are items
    std::size_t split_top(std::array<Part, most_parts>& parts) noexcept;
    std::size_t leaves_below(std::size_t node) const noexcept;
    std::size_t halve(const Part& part) const noexcept;
    void join(std::size_t node) noexcept; // its children's boxes
    void join_top() noexcept;
    void split(const Part& part, std::span<const Box3f> boxes) noexcept;

    Array<Box3f> boxes_;         // one a node; the first is not used
    Array<std::uint32_t> items_; // one a leaf
    Array<Centre> centres_;      // for build()
};

} // namespace vox
