// Pairs of boxes that overlap: those of bodies, for the broad phase and the reference engine's cost model.
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "base/scene.hpp"
#include "fast/step.hpp"

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox::fast {

struct Pair {
    std::uint32_t a, b; // indices of boxes
};

// Which pairs are wanted: where there are bodies, those that may collide (mesh/filter.hpp) and of which one
// has tets. With `of`, which is what the step knows of them, one must have moved, too.
struct PairRules {
    std::span<const Body> bodies{};
    std::span<const StepBody> of{};

    bool has_moved(std::uint32_t body) const noexcept { return of.empty() || of[body].moved; }
};

// A box by ranks: an axis at a time, the low corners of all boxes are numbered in ascending order, and a high
// corner has the number of the last low corner that is not above it. Of two boxes that overlap along an axis,
// exactly one has the low corner of the other between its own two.
struct RankedBox {
    std::uint32_t lo[3], hi[3];
    std::uint32_t box;
    std::uint32_t rule; // index of the class of bodies that the filters treat alike
};

// Buffers kept from step to step.
struct PairBuffers {
    explicit PairBuffers(std::pmr::memory_resource* memory)
        : order(memory), boxes(memory), corners(memory), found(memory), first(memory), ranked(memory),
          inner(memory), outer(memory) {}

    Array<std::uint32_t> order; // boxes that are not empty, along the axis of the sweep
    Array<Box> boxes;           // in that order
    Array<std::uint64_t> corners;
    Array<Pair> found;
    Array<std::uint32_t> first;
    Array<RankedBox> ranked, inner, outer; // of scenes for which the sweep does not do
    std::uint64_t looks = 0;               // at a pair, or at a box to divide them, in the last call
};

// Fills `pairs` with all ordered pairs (a, b), a != b, of boxes that overlap and are wanted either way,
// sorted by a, then b. Empty boxes overlap nothing. Of n boxes, takes O(n log^3 n) and what the wanted pairs
// take, but for pairs of boxes that overlap and that more than most_rule_classes kinds of filters, or
// exceptions, exclude: these are tested one by one. Memory is taken for boxes and for wanted pairs alone.
void find_pairs(std::span<const Box> boxes, const PairRules& rules, PairBuffers& buffers, Array<Pair>& pairs);
inline constexpr std::size_t most_rule_classes = 32;

} // namespace vox::fast
