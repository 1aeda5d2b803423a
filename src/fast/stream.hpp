// Stage 1: one pass over all positions. All that is read of a body that is far from every other.
#pragma once

#include "base/boxes.hpp"
#include "base/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace vox::fast {

// Writes the floats nearest to the exact positions [first, last), less `origin`, packed to out + 3 * first
// and so on. Coordinates without a finite float near them give NaN; those that have one, but too far from the
// origin, the largest float.
void round_positions(const Positions& positions, const Vec3d& origin, std::uint32_t first, std::uint32_t last,
                     float* out);

// Writes the box of each of the blocks [first[i], first[i + 1]) of packed positions to `boxes`, and the box
// of them together to `all`. Reads no other positions. Returns false when one is not finite; the boxes mean
// nothing then.
bool stream_boxes(const float* positions, std::span<const std::uint32_t> first, Box* boxes, Box& all);

// The same, and the boxes around the displacements from `reference`, which are packed positions too, to
// `moves`.
bool stream_boxes(const float* positions, const float* reference, std::span<const std::uint32_t> first,
                  Box* boxes, Box* moves, Box& all);

} // namespace vox::fast
