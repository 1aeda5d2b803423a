#include "surface/lane_lists.hpp"
#include "base/prefetch.hpp"
#include "base/simd.hpp"

#undef VOX_SOURCE
#define VOX_SOURCE "surface/lane_lists.cpp"
#include "base/each_target.hpp"

#include "base/compress-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace vox {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

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
        // What is stored beyond the partners is overwritten by the next ones.
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

void turn_blocks(std::uint64_t* words, std::size_t blocks, std::uint32_t* counts) {
    VOX_SIMD_DISPATCH(Turn)(words, blocks, counts);
}

void write_lists(const std::uint64_t* words, std::size_t blocks, const std::uint32_t* partners,
                 std::uint32_t* const* lists, const std::uint32_t* counts) {
    VOX_SIMD_DISPATCH(Write)(words, blocks, partners, lists, counts);
}

} // namespace vox
#endif
