// Stage 1: one pass over all positions. All that is read of a body that is far from every other.
#pragma once

#include "box.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace vox::fast {

// Writes the box of each of the blocks [first[i], first[i + 1]) of `count` packed positions to `boxes`, and
// the box of all to `body`. Returns false when a position is not finite; the boxes mean nothing then.
bool stream_boxes(const float* positions, std::uint32_t count, std::span<const std::uint32_t> first,
                  Box* boxes, Box& body);

} // namespace vox::fast
