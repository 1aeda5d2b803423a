// Moves the lanes of a mask to the front. Included once for each SIMD target, after hwy/highway.h.
//
// Where registers are shorter than 512 bits, hn::Compress looks up its shuffles in a table too, but gcc 12
// copies that table to the stack in each call.
#if defined(VOX_FAST_COMPRESS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOX_FAST_COMPRESS_INL
#undef VOX_FAST_COMPRESS_INL
#else
#define VOX_FAST_COMPRESS_INL
#endif

#include <hwy/highway.h>

#ifndef VOX_FAST_COMPRESS_ONCE
#define VOX_FAST_COMPRESS_ONCE
#include <cstdint>

namespace vox::fast {

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

} // namespace vox::fast
#endif

HWY_BEFORE_NAMESPACE();
namespace vox::fast {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// One mask for several registers of floats or 32-bit words. In the result, the lanes after those of the mask
// are undefined.
class Compressor {
public:
    using Floats = hn::CappedTag<float, 16>;
    using Words = hn::RebindToUnsigned<Floats>;

    HWY_INLINE explicit Compressor(hn::Mask<Floats> mask)
#if HWY_MAX_BYTES >= 64
        : mask_(mask), count_(static_cast<std::uint32_t>(hn::CountTrue(Floats(), mask))){}
#else
    {
        const hn::Rebind<std::uint8_t, Floats> db;
        std::uint8_t bits[8] = {};
        hn::StoreMaskBits(Floats(), mask, bits);
        lanes_ = hn::PromoteTo(Words(), hn::LoadU(db, compress_table.lane[bits[0]]));
        count_ = static_cast<std::uint32_t>(hwy::PopCount(bits[0]));
    }
#endif

          HWY_INLINE hn::Vec<Floats>
          operator()(hn::Vec<Floats> v) const {
#if HWY_MAX_BYTES >= 64
        return hn::Compress(v, mask_);
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
#else
    hn::Vec<Words> lanes_;
#endif
    std::uint32_t count_;
};

} // namespace HWY_NAMESPACE
} // namespace vox::fast
HWY_AFTER_NAMESPACE();

#endif
