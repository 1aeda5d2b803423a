// What stage 2 asks of many boxes at once: on which sides of a region they lie, and which of them meet it.
#pragma once

#include "base/boxes.hpp"

#include <cstddef>
#include <cstdint>

namespace vox::fast {

// sides_of() each of the boxes.
void find_sides(const Box* boxes, std::size_t count, const Box& region, std::uint8_t* sides);

// Bit i of the result: boxes[i] overlaps the region. Of at most most_boxes.
inline constexpr std::uint32_t most_boxes = 64;
std::uint64_t find_overlaps(const Box* boxes, std::uint32_t count, const Box& region);

} // namespace vox::fast
