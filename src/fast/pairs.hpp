// Stage 2: which bodies have overlapping boxes.
#pragma once

#include "base/boxes.hpp"

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox::fast {

struct Pair {
    std::uint32_t a, b; // indices of boxes
};

// Buffers kept from step to step.
struct PairBuffers {
    explicit PairBuffers(std::pmr::memory_resource* memory)
        : order(memory), boxes(memory), found(memory), first(memory) {}

    std::pmr::vector<std::uint32_t> order;
    std::pmr::vector<Box> boxes; // in that order
    std::pmr::vector<Pair> found;
    std::pmr::vector<std::uint32_t> first;
};

// Fills `pairs` with all ordered pairs (a, b), a != b, of boxes that overlap, sorted by a, then b. Empty
// boxes overlap nothing.
void find_pairs(std::span<const Box> boxes, PairBuffers& buffers, std::pmr::vector<Pair>& pairs);

} // namespace vox::fast
