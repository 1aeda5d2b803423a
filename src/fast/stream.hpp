// Stage 1: one pass over all positions. All that is read of a body that is far from every other.
#pragma once

#include "box.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace vox::fast {

// Writes the box of every 64 consecutive of `count` packed positions to `blocks`, and the box of all to
// `body`. Returns false when one is not finite; the boxes mean nothing then.
bool stream_boxes(const float* positions, std::uint32_t count, Box* blocks, Box& body);

} // namespace vox::fast
