// From the lanes of each partner of a tile to the partners of each lane, 64 by 64.
#pragma once

#include <cstddef>
#include <cstdint>

namespace vox {

inline constexpr std::size_t partners_a_block = 64;

// `words`: of 64 partners a block, the lanes of each as bits. Afterwards they are 64 lanes a block, the
// partners of each as bits; counts[lane] grows by their number.
using TurnBlocks = void(std::uint64_t* words, std::size_t blocks, std::uint32_t* counts);

// Writes the partners of each lane to lists[lane], where that is not null; counts[lane] is their number.
// `partners` can be read up to the end of the last block.
using WriteLists = void(const std::uint64_t* words, std::size_t blocks, const std::uint32_t* partners,
                        std::uint32_t* const* lists, const std::uint32_t* counts);

// For the instructions of this machine.
TurnBlocks* turn_blocks() noexcept;
WriteLists* write_lists() noexcept;

} // namespace vox
