// Boxes that meet no other one, in time that grows with their number alone where most are of about one size
// and far apart.
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "fast/body_pairs.hpp"

#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox::fast {

// Sets met[i] to 1 for each box that overlaps another one, to 0 for the others. Empty boxes overlap nothing.
// Returns false where that would take many tests a box; `met` is undefined then.
bool find_met_boxes(std::span<const Box> boxes, PairBuffers& buffers, Array<std::uint8_t>& met);

} // namespace vox::fast
