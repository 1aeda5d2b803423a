// Stage 1: one pass over all positions. All that is read of a body that is far from every other.
#pragma once

#include "box.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace vox::fast {

// Writes the box of each of the blocks [first[i], first[i + 1]) of packed positions to `boxes`, and the box
// of them together to `all`. Reads no other positions. Returns false when one is not finite; the boxes mean
// nothing then.
bool stream_boxes(const float* positions, std::span<const std::uint32_t> first, Box* boxes, Box& all);

} // namespace vox::fast
