// The first stage: one pass over all positions. Of a body that is far from all others nothing else is read.
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "base/scene.hpp"
#include "fast/step.hpp"

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox::fast {

// Writes the floats nearest to the exact positions [first, last), less `origin`, packed to out + 3 * first
// and so on. A coordinate that no finite float is nearest to gives NaN; one that is only too far from the
// origin gives the largest float.
void round_positions(const Positions& positions, const Vec3d& origin, std::uint32_t first, std::uint32_t last,
                     float* out);

// Writes the box of each of the blocks [first[i], first[i + 1]) of packed positions to `boxes`, those of each
// group_blocks of them to `groups`, and the box of them together to `all`. Reads no other positions. Returns
// false when one is not finite; the boxes are undefined then.
bool stream_boxes(const float* positions, std::span<const std::uint32_t> first, Box* boxes, Box* groups,
                  Box& all);

// Buffers of stream(), kept from step to step.
struct StreamBuffers {
    explicit StreamBuffers(std::pmr::memory_resource* memory)
        : piece_boxes(memory), piece_moved(memory), packed(memory) {}

    Array<Box> piece_boxes; // of Step::block_pieces
    Array<std::uint8_t> piece_moved;
    Array<float> packed; // of bodies of which nothing is kept
};

// Packs positions, makes the boxes of bodies and blocks, and finds out which of the bodies that have
// LastPositions moved. Throws Error(NON_FINITE) naming mesh and vertex. Positions that are packed are good
// until `buffers` or the LastPositions change.
void stream(Step& step, StepBoxes& boxes, StreamBuffers& buffers);

} // namespace vox::fast
