// What quanta decide. Let q(x) be a number x in quanta: 8 + (x - low) / quantum, clamped to 0 ... 32767 and
// rounded. Each step is monotone, so q(x) > q(y) proves x > y: boxes that are apart in quanta are apart.
//
// For the other side, let q(x) - q(y) >= 6, where x is the upper side of one box, y the lower side of
// another, and one of the two boxes is in the tile. Before the last rounding, which moves each of them by at
// most 1/2, they differ by 5 or more; the difference and the product, in floats, moved each of them by less
// than 32767 * 2^-22 < 0.01. A quantum is at least close_by / 4, so x - y > 4.9 quanta > close_by, if neither
// was clamped. Clamping only brings x and y closer to each other here: it could raise x if x were below 0, or
// lower y if y were above 32767, but the tile's own numbers are from 8 to 32760, and then the difference
// would be negative.
#include "surface/lanes.hpp"
#include "base/boxes.hpp"
#include "base/prefetch.hpp"
#include "base/simd.hpp"

#undef VOX_SOURCE
#define VOX_SOURCE "surface/lanes.cpp"
#include "base/each_target.hpp"

#include "base/compress-inl.hpp"
#include "base/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace vox {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Quanta = hn::CappedTag<std::int16_t, 32>;
using QV = hn::Vec<Quanta>;

constexpr float least_quantum = 0x1p-126f;
constexpr float endless = 0x1p120f; // a length with which floats could overflow
constexpr float units = 0x1p23f;    // from here to twice as much, a float's lowest bits are its integer

void Quantise(const float* HWY_RESTRICT boxes, const QuantisedTile& tile, QuantisedSides& HWY_RESTRICT out) {
    const hn::CappedTag<float, 16> d;
    const hn::RebindToSigned<decltype(d)> di;
    const hn::Rebind<std::int16_t, decltype(d)> d16;
    const auto most = hn::Set(d, most_quanta), below = hn::Set(d, quanta_below), unit = hn::Set(d, units);
    for (std::size_t side = 0; side < 6; ++side) {
        const auto low = hn::Set(d, tile.low[side % 3]), per_quantum = hn::Set(d, tile.per_quantum[side % 3]);
        for (std::size_t k = 0; k < lanes_a_tile; k += hn::Lanes(d)) {
            const auto x = hn::LoadU(d, boxes + side * lanes_a_tile + k);
            const auto q = hn::Add(hn::Mul(hn::Sub(x, low), per_quantum), below);
            const auto clamped = hn::Min(hn::Max(q, hn::Zero(d)), most);
            const auto bits = hn::BitCast(di, hn::Add(clamped, unit));
            hn::StoreU(hn::DemoteTo(d16, hn::Sub(bits, hn::BitCast(di, unit))), d16, out[side] + k);
        }
    }
}

// Quantises one number.
HWY_INLINE std::int16_t QuantiseNumber(float x, float low, float per_quantum) {
    const float q = (x - low) * per_quantum + quanta_below, above = q > 0 ? q : 0;
    return static_cast<std::int16_t>((above < most_quanta ? above : most_quanta) + units - units);
}

void QuantiseOwn(const float* HWY_RESTRICT boxes, const float* HWY_RESTRICT low,
                 const float* HWY_RESTRICT high, float close_by, QuantisedTile& out) {
    out.always_open = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        const float side = high[a] - low[a];
        if (side < endless && close_by < endless) {
            const float by_side = side / quanta_a_side, by_order = close_by / 4;
            const float quantum = by_side > by_order ? by_side : by_order;
            out.low[a] = low[a];
            out.per_quantum[a] = 1 / (quantum > least_quantum ? quantum : least_quantum);
        } else { // quanta have the order of floats, and nothing else
            out.low[a] = 0;
            out.per_quantum[a] = least_quantum;
            out.always_open = ~std::uint64_t{0};
        }
        out.lowest[a] = QuantiseNumber(low[a], out.low[a], out.per_quantum[a]);
        out.highest[a] = QuantiseNumber(high[a], out.low[a], out.per_quantum[a]);
    }
    Quantise(boxes, out, out.sides);
}

std::size_t CompareQuantised(const QuantisedTile& HWY_RESTRICT tile, std::uint64_t asked,
                             const QuantisedSides& HWY_RESTRICT other, std::uint64_t wanted,
                             TileOverlaps& HWY_RESTRICT out) {
    const Quanta d;
    constexpr std::size_t lanes = hn::MaxLanes(Quanta()), registers = lanes_a_tile / lanes;
    const hn::RebindToUnsigned<Quanta> du;
    const auto apart = hn::Set(d, std::int16_t{-1});
    const auto least_certain = hn::Set(d, std::int16_t{most_quanta_open + 1});
    QV own[6][registers];
    for (std::size_t side = 0; side < 6; ++side)
        for (std::size_t r = 0; r < registers; ++r) own[side][r] = hn::Load(d, tile.sides[side] + r * lanes);
    std::uint64_t near = 0; // those that overlap the tile's box
    for (std::size_t r = 0; r < registers; ++r) {
        auto least = hn::Zero(d);
        for (std::size_t a = 0; a < 3; ++a) {
            const auto to_low = hn::Sub(hn::LoadU(d, other[a + 3] + r * lanes), hn::Set(d, tile.lowest[a]));
            const auto to_high = hn::Sub(hn::Set(d, tile.highest[a]), hn::LoadU(d, other[a] + r * lanes));
            least = hn::Min(least, hn::Min(to_low, to_high));
        }
        near |= BitsOfMask(d, hn::Gt(least, apart)) << r * lanes;
    }
    near &= wanted;
    out.compared = hwy::PopCount(near);
    std::size_t found = 0;
    for (std::uint64_t left = near; left != 0; left &= left - 1) {
        const auto lane = static_cast<std::size_t>(hwy::Num0BitsBelowLS1Bit_Nonzero64(left));
        const auto lx = hn::Set(d, other[0][lane]), ly = hn::Set(d, other[1][lane]),
                   lz = hn::Set(d, other[2][lane]), hx = hn::Set(d, other[3][lane]),
                   hy = hn::Set(d, other[4][lane]), hz = hn::Set(d, other[5][lane]);
        std::uint64_t overlapping = 0, open = tile.always_open;
        QV reach[registers]; // by how many quanta the boxes reach into each other
        auto least_reach = hn::Set(du, std::uint16_t{0xffff}); // negative ones count as large
        for (std::size_t r = 0; r < registers; ++r) {
            const auto x = hn::Min(hn::Sub(hx, own[0][r]), hn::Sub(own[3][r], lx));
            const auto y = hn::Min(hn::Sub(hy, own[1][r]), hn::Sub(own[4][r], ly));
            const auto z = hn::Min(hn::Sub(hz, own[2][r]), hn::Sub(own[5][r], lz));
            reach[r] = hn::Min(x, hn::Min(y, z));
            overlapping |= BitsOfMask(d, hn::Gt(reach[r], apart)) << r * lanes;
            least_reach = hn::Min(least_reach, hn::BitCast(du, reach[r]));
        }
        if (!hn::AllTrue(du, hn::Gt(least_reach, hn::Set(du, std::uint16_t{most_quanta_open})))) // seldom
            for (std::size_t r = 0; r < registers; ++r)
                open |= BitsOfMask(d, hn::Lt(reach[r], least_certain)) << r * lanes;
        overlapping &= asked;
        out.lanes[found] = overlapping;
        out.open[found] = overlapping & open;
        out.others[found] = static_cast<std::uint8_t>(lane);
        found += overlapping != 0;
    }
    return found;
}

FloatOverlaps CompareBox(const float* HWY_RESTRICT boxes, const float* HWY_RESTRICT box, float close_by) {
    const hn::CappedTag<float, 16> d;
    constexpr std::size_t n = lanes_a_tile;
    const auto zero = hn::Zero(d), most_close = hn::Set(d, close_by);
    std::uint64_t overlapping = 0, close = 0;
    for (std::size_t k = 0; k < n; k += hn::Lanes(d)) {
        auto reach = hn::Set(d, float_infinity); // the sign of a difference is exact
        for (std::size_t a = 0; a < 3; ++a) {
            const auto above = hn::Sub(hn::Set(d, box[(a + 3) * n]), hn::LoadU(d, boxes + a * n + k));
            const auto below = hn::Sub(hn::LoadU(d, boxes + (a + 3) * n + k), hn::Set(d, box[a * n]));
            reach = hn::Min(reach, hn::Min(above, below));
        }
        overlapping |= BitsOfMask(d, hn::Ge(reach, zero)) << k;
        close |= BitsOfMask(d, hn::Le(reach, most_close)) << k;
    }
    return {overlapping, overlapping & close};
}

// Bit i of word k and bit k of word i change places: by halves, quarters and so on (H. S. Warren, Hacker's
// Delight, ch. 7).
template <unsigned kWidth>
HWY_INLINE void ExchangeParts(std::uint64_t* HWY_RESTRICT words, std::uint64_t low) {
    for (unsigned part = 0; part < partners_a_block; part += 2 * kWidth)
        for (unsigned k = part; k < part + kWidth; ++k) {
            const std::uint64_t changed = (words[k] >> kWidth ^ words[k + kWidth]) & low;
            words[k] ^= changed << kWidth;
            words[k + kWidth] ^= changed;
        }
}

void Turn(std::uint64_t* HWY_RESTRICT words, std::size_t blocks, std::uint32_t* HWY_RESTRICT counts) {
    for (; blocks > 0; --blocks, words += partners_a_block) {
        ExchangeParts<32>(words, 0x00000000ffffffff);
        ExchangeParts<16>(words, 0x0000ffff0000ffff);
        ExchangeParts<8>(words, 0x00ff00ff00ff00ff);
        ExchangeParts<4>(words, 0x0f0f0f0f0f0f0f0f);
        ExchangeParts<2>(words, 0x3333333333333333);
        ExchangeParts<1>(words, 0x5555555555555555);
        for (std::size_t lane = 0; lane < partners_a_block; ++lane)
            counts[lane] += static_cast<std::uint32_t>(hwy::PopCount(words[lane]));
    }
}

// The partners of one lane, whose words lie 64 apart.
HWY_INLINE void WriteList(const std::uint64_t* HWY_RESTRICT words, std::size_t blocks,
                          const std::uint32_t* HWY_RESTRICT partners, std::uint32_t* HWY_RESTRICT out,
                          std::size_t count) {
    const Compressor::Words d;
    constexpr std::size_t lanes = hn::MaxLanes(Compressor::Words());
    [[maybe_unused]] std::uint32_t* const end = out + count;
    for (; blocks > 0; --blocks, words += partners_a_block, partners += partners_a_block) {
        std::uint64_t word = *words;
        const std::uint32_t* next = partners;
#if HWY_MAX_BYTES >= 64
        for (; word != 0; next += lanes, word >>= lanes) {
            const Compressor compress(static_cast<std::uint16_t>(word));
            hn::BlendedStore(compress(hn::LoadU(d, next)), hn::FirstN(d, compress.count()), d, out);
            out += compress.count();
        }
#else
        // The next partners overwrite what is stored beyond these.
        for (; word != 0 && static_cast<std::size_t>(end - out) >= lanes; next += lanes, word >>= lanes) {
            const Compressor compress(static_cast<std::uint32_t>(word & ((1u << lanes) - 1)));
            hn::StoreU(compress(hn::LoadU(d, next)), d, out);
            out += compress.count();
        }
        for (; word != 0; word &= word - 1) *out++ = next[hwy::Num0BitsBelowLS1Bit_Nonzero64(word)];
#endif
    }
}

void Write(const std::uint64_t* HWY_RESTRICT words, std::size_t blocks,
           const std::uint32_t* HWY_RESTRICT partners, std::uint32_t* const* HWY_RESTRICT lists,
           const std::uint32_t* HWY_RESTRICT counts) {
    for (std::size_t lane = 0; lane < partners_a_block; ++lane) // they lie anywhere
        if (lists[lane]) prefetch(lists[lane]);
    for (std::size_t lane = 0; lane < partners_a_block; ++lane)
        if (lists[lane]) WriteList(words + lane, blocks, partners, lists[lane], counts[lane]);
}

} // namespace HWY_NAMESPACE
} // namespace vox
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {

void quantise_tile(const float* boxes, const float* low, const float* high, float close_by,
                   QuantisedTile& out) {
    VOX_SIMD_DISPATCH(QuantiseOwn)(boxes, low, high, close_by, out);
}

void quantise_sides(const float* boxes, const QuantisedTile& tile, QuantisedSides& out) {
    VOX_SIMD_DISPATCH(Quantise)(boxes, tile, out);
}

std::size_t compare_tiles(const QuantisedTile& tile, std::uint64_t asked, const QuantisedSides& other,
                          std::uint64_t wanted, TileOverlaps& out) {
    return VOX_SIMD_DISPATCH(CompareQuantised)(tile, asked, other, wanted, out);
}

FloatOverlaps compare_floats(const float* boxes, const float* box, float close_by) {
    return VOX_SIMD_DISPATCH(CompareBox)(boxes, box, close_by);
}

void turn_blocks(std::uint64_t* words, std::size_t blocks, std::uint32_t* counts) {
    VOX_SIMD_DISPATCH(Turn)(words, blocks, counts);
}

void write_lists(const std::uint64_t* words, std::size_t blocks, const std::uint32_t* partners,
                 std::uint32_t* const* lists, const std::uint32_t* counts) {
    VOX_SIMD_DISPATCH(Write)(words, blocks, partners, lists, counts);
}

} // namespace vox
#endif
