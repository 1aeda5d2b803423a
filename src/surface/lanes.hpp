// The 64 lanes of a tile of features: their boxes, all compared with those of another tile, and the lists of
// their partners.
#pragma once

#include <cstddef>
#include <cstdint>

namespace vox {

inline constexpr std::size_t lanes_a_tile = 64;

// The boxes of a tile in 15 bits a number: multiples of a quantum along each axis, from a little below the
// box of the tile that others are compared with. Rounding to these keeps the order of numbers, or makes them
// equal.
using QuantisedSides = std::int16_t[6][lanes_a_tile]; // low x, y, z, then high x, y, z of each lane

struct alignas(64) QuantisedTile {
    QuantisedSides sides;
    std::int16_t lowest[3], highest[3]; // of all lanes
    // All bits set if the tile is so large that no order in quanta is certain, else 0.
    std::uint64_t always_open;
    float low[3], per_quantum[3];
};
inline constexpr float quanta_below = 8;      // the box of the tile: for boxes that reach further
inline constexpr float quanta_a_side = 32751; // of it
inline constexpr float most_quanta = 32767;

// Boxes that reach into each other by no more quanta than this are left open: their numbers may be closer to
// each other than `close_by` of quantise_tile().
inline constexpr std::int16_t most_quanta_open = 5;

// The lanes of another tile that overlap some lane of a tile.
struct TileOverlaps {
    std::uint64_t lanes[lanes_a_tile]; // of the tile
    std::uint64_t open[lanes_a_tile];  // those of them that may not
    std::uint8_t others[lanes_a_tile]; // the lane of the other tile, ascending
    std::uint64_t compared;            // lanes of the other tile near enough to be compared
};

// `boxes` is 6 * 64 floats, as in FeatureTiles::boxes, `low` and `high` are the tile's box.
void quantise_tile(const float* boxes, const float* low, const float* high, float close_by,
                   QuantisedTile& out);
// The boxes of another tile in the quanta of `tile`.
void quantise_sides(const float* boxes, const QuantisedTile& tile, QuantisedSides& out);
// Compares the lanes `asked` of a tile with the lanes `wanted` of another one. Returns how many of these
// overlap any.
std::size_t compare_tiles(const QuantisedTile& tile, std::uint64_t asked, const QuantisedSides& other,
                          std::uint64_t wanted, TileOverlaps& out);

// Compares a tile's boxes of floats with one box, whose numbers lie 64 floats apart. Bit k of `lanes`: lane k
// overlaps it; bit k of `close`: but reaches into it by no more than `close_by` along some axis.
struct FloatOverlaps {
    std::uint64_t lanes, close;
};
FloatOverlaps compare_floats(const float* boxes, const float* box, float close_by);

// Lists turn the lanes of each partner of a tile into the partners of each lane, 64 by 64.
inline constexpr std::size_t partners_a_block = 64;

// `words`: of 64 partners a block, the lanes of each as bits. Afterwards they are 64 lanes a block, the
// partners of each as bits; counts[lane] grows by their number.
void turn_blocks(std::uint64_t* words, std::size_t blocks, std::uint32_t* counts);

// Writes the partners of each lane to lists[lane], where that is not null; counts[lane] is their number.
// `partners` can be read up to the end of the last block.
void write_lists(const std::uint64_t* words, std::size_t blocks, const std::uint32_t* partners,
                 std::uint32_t* const* lists, const std::uint32_t* counts);

} // namespace vox
