// Moves the lanes of a mask to the front. Included once for each SIMD target, after hwy/highway.h.
//
// Where registers are shorter than 512 bits, hn::Compress looks up its shuffles in a table too, but gcc 12
// copies that table to the stack in each call.
#if defined(VOX_BASE_COMPRESS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOX_BASE_COMPRESS_INL
#undef VOX_BASE_COMPRESS_INL
#else
#define VOX_BASE_COMPRESS_INL
#endif

#include "base/lanes-inl.hpp"

#include <hwy/highway.h>

#ifndef VOX_BASE_COMPRESS_ONCE
#define VOX_BASE_COMPRESS_ONCE
#include <cstdint>

namespace vox {

// For each set of eight lanes: the lanes in it, in order, then the others.
inline constexpr struct CompressTable {
    std::uint8_t lane[256][8]{};

    constexpr CompressTable() {
        for (unsigned mask = 0; mask < 256; ++mask)
            for (unsigned wanted = 2, n = 0; wanted-- > 0;)
                for (unsigned i = 0; i < 8; ++i)
                    if ((mask >> i & 1) == wanted) lane[mask][n++] = static_cast<std::uint8_t>(i);
    }
} compress_table;

// The table for sets of four lanes of four bytes, in bytes.
inline constexpr struct CompressBytesTable {
    alignas(16) std::uint8_t byte[16][16]{};

    constexpr CompressBytesTable() {
        for (unsigned mask = 0; mask < 16; ++mask)
            for (unsigned i = 0; i < 16; ++i)
                byte[mask][i] = static_cast<std::uint8_t>(4 * compress_table.lane[mask][i / 4] + i % 4);
    }
} compress_bytes_table;

} // namespace vox
#endif

HWY_BEFORE_NAMESPACE();
namespace vox {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// One mask for several registers of floats or 32-bit words. In the result, the lanes after those of the mask
// are undefined.
class Compressor {
public:
    using Floats = hn::CappedTag<float, 16>;
    using Words = hn::RebindToUnsigned<Floats>;

#if HWY_MAX_BYTES >= 64
    HWY_INLINE explicit Compressor(hn::Mask<Floats> mask)
        : mask_(mask), count_(static_cast<std::uint32_t>(hn::CountTrue(Floats(), mask))) {}
    // The lanes whose bits are set.
    HWY_INLINE explicit Compressor(std::uint32_t bits)
        : count_(static_cast<std::uint32_t>(hwy::PopCount(bits))) {
        const auto short_bits = static_cast<std::uint16_t>(bits);
        mask_ = hn::LoadMaskBits(Floats(), reinterpret_cast<const std::uint8_t*>(&short_bits));
    }
#else
    HWY_INLINE explicit Compressor(hn::Mask<Floats> mask)
        : Compressor(static_cast<std::uint32_t>(BitsOfMask(Floats(), mask))) {}
    HWY_INLINE explicit Compressor(std::uint32_t bits)
        : count_(static_cast<std::uint32_t>(hwy::PopCount(bits))) {
#if HWY_TARGET == HWY_WASM
        bytes_ = hn::Load(Bytes(), compress_bytes_table.byte[bits]);
#else
        const hn::Rebind<std::uint8_t, Floats> db;
        lanes_ = hn::PromoteTo(Words(), hn::LoadU(db, compress_table.lane[bits]));
#endif
    }
#endif

    HWY_INLINE hn::Vec<Floats> operator()(hn::Vec<Floats> v) const {
#if HWY_MAX_BYTES >= 64
        return hn::Compress(v, mask_);
#elif HWY_TARGET == HWY_WASM
        return hn::BitCast(Floats(), LookUpBytes(hn::BitCast(Bytes(), v), bytes_));
#else
        return hn::TableLookupLanes(v, hn::IndicesFromVec(Floats(), lanes_));
#endif
    }
    HWY_INLINE hn::Vec<Words> operator()(hn::Vec<Words> v) const {
        return hn::BitCast(Words(), (*this)(hn::BitCast(Floats(), v)));
    }
    HWY_INLINE std::uint32_t count() const { return count_; }

private:
#if HWY_MAX_BYTES >= 64
    hn::Mask<Floats> mask_;
#elif HWY_TARGET == HWY_WASM
    using Bytes = hn::Repartition<std::uint8_t, Floats>;
    hn::Vec<Bytes> bytes_;
#else
    hn::Vec<Words> lanes_;
#endif
    std::uint32_t count_;
};

} // namespace HWY_NAMESPACE
} // namespace vox
HWY_AFTER_NAMESPACE();

#endif
