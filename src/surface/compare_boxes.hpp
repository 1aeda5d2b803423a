// The boxes of a tile of features, all 64 compared with one at once.
#pragma once

#include <cstddef>
#include <cstdint>

namespace vox {

// `tile` is 6 * 64 floats, as in FeatureTiles::boxes. Bit k of the result: lane k overlaps the box, whose six
// numbers are `stride` floats apart, low x, y, z, then high x, y, z.
using CompareBoxes = void(const float* tile, const float* const* boxes, std::size_t stride, std::size_t count,
                          std::uint64_t* masks);

// For the instructions of this machine.
CompareBoxes* compare_boxes() noexcept;

} // namespace vox
