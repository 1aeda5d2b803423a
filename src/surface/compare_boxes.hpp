// The boxes of a tile of features, all 64 compared with one at once.
#pragma once

#include <cstddef>
#include <cstdint>

namespace vox {

// `tile` is 6 * 64 floats, as in FeatureTiles::boxes. Bit k of masks[i]: lane k overlaps box i, whose six numbers are
// `stride` floats apart, low x, y, z, then high x, y, z. Bit k of close[i]: but by no more than `close_by` along some axis.
// Empty lanes have any bits.
using CompareBoxes = void(const float* tile, const float* const* boxes, std::size_t stride, std::size_t count,
                          float close_by, std::uint64_t* masks, std::uint64_t* close);

// For the instructions of this machine.
CompareBoxes* compare_boxes() noexcept;

} // namespace vox
