// Stage 2: which bodies have overlapping boxes.
#pragma once

#include "box.hpp"

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox::fast {

struct Pair {
    std::uint32_t a, b; // indices of boxes
};

// Fills `pairs` with all ordered pairs (a, b), a != b, of boxes that overlap, sorted by a, then b. Empty
// boxes overlap nothing. `order` is a buffer kept from step to step.
void find_pairs(std::span<const Box> boxes, std::pmr::vector<std::uint32_t>& order,
                std::pmr::vector<Pair>& pairs);

} // namespace vox::fast
