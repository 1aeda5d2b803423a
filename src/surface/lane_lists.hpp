// From the lanes of each partner of a tile to the partners of each lane, 64 by 64.
#pragma once

#include <cstddef>
#include <cstdint>

namespace vox {

inline constexpr std::size_t partners_a_block = 64;

// `words`: of 64 partners a block, the lanes of each as bits. Afterwards they are 64 lanes a block, the
// partners of each as bits; counts[lane] grows by their number.
void turn_blocks(std::uint64_t* words, std::size_t blocks, std::uint32_t* counts);

// Writes the partners of each lane to lists[lane], where that is not null; counts[lane] is their number.
// `partners` can be read up to the end of the last block.
void write_lists(const std::uint64_t* words, std::size_t blocks, const std::uint32_t* partners,
                 std::uint32_t* const* lists, const std::uint32_t* counts);

} // namespace vox
