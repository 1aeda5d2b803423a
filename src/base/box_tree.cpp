#include "base/box_tree.hpp"

#include "base/median_splits.hpp"
#include "base/room.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

namespace {

// The centre of one side of a box; 0 if the side is infinite.
float centre(float lo, float hi) noexcept {
    const float middle = 0.5f * lo + 0.5f * hi;
    return std::isfinite(middle) ? middle : 0;
}

} // namespace

void BoxTree::reserve(std::size_t items) {
    reserve_growing(boxes_, 2 * items);
    reserve_growing(items_, items);
    reserve_growing(centres_, items);
}

bool BoxTree::take(std::span<const Box3f> boxes) {
    centres_.clear();
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        const Box3f& box = boxes[i];
        if (is_empty(box)) continue;
        centres_.push_back(
            {{centre(box.min.x, box.max.x), centre(box.min.y, box.max.y), centre(box.min.z, box.max.z)}, i});
    }
    items_.resize(centres_.size());
    boxes_.resize(2 * centres_.size());
    return !centres_.empty();
}

// Returns the number of parts, which are still to be split.
std::size_t BoxTree::split_top(std::array<Part, most_parts>& parts) noexcept {
    std::size_t count = 0;
    const auto split_one = [&](const auto& self, const Part& part) -> void {
        if (part.node >= most_parts || is_leaf(part.node)) {
            parts[count++] = part;
            return;
        }
        const std::size_t left = halve(part);
        self(self, {2 * part.node, part.centres.first(left)});
        self(self, {2 * part.node + 1, part.centres.subspan(left)});
    };
    split_one(split_one, {1, centres_});
    return count;
}

// Leaves are on two levels, since nodes are numbered without gaps.
std::size_t BoxTree::leaves_below(std::size_t node) const noexcept {
    const std::size_t leaves = items_.size();
    std::size_t first = node, last = node; // below `node`, on one level
    while (2 * first < leaves) {
        first = 2 * first;
        last = 2 * last + 1;
    }
    const std::size_t inner = first < leaves ? std::min(last + 1, leaves) - first : 0;
    return (last + 1 - first - inner) + 2 * inner;
}

// Moves the centres of the left child of a node to the front, and returns their number.
std::size_t BoxTree::halve(const Part& part) const noexcept {
    const auto& [node, centres] = part;
    const std::size_t left = leaves_below(2 * node);
    const int axis = longest_axis(centres);
    std::nth_element(centres.begin(), centres.begin() + static_cast<std::ptrdiff_t>(left), centres.end(),
                     [axis](const Centre& x, const Centre& y) { return x.at[axis] < y.at[axis]; });
    return left;
}

void BoxTree::join(std::size_t node) noexcept {
    boxes_[node] = boxes_[2 * node];
    extend(boxes_[node], boxes_[2 * node + 1]);
}

void BoxTree::join_top() noexcept {
    for (std::size_t node = std::min(most_parts, items_.size()) - 1; node > 0; --node) join(node);
}

void BoxTree::split(const Part& part, std::span<const Box3f> boxes) noexcept {
    const auto& [node, centres] = part;
    if (is_leaf(node)) {
        const std::uint32_t item = centres[0].item;
        boxes_[node] = boxes[item];
        items_[node - items_.size()] = item;
        return;
    }
    const std::size_t left = halve(part);
    split({2 * node, centres.first(left)}, boxes);
    split({2 * node + 1, centres.subspan(left)}, boxes);
    join(node);
}

} // namespace vox
