// Coordinates and boxes of a tile in 8 bits. Included once for each SIMD target, after hwy/highway.h.
#if defined(VOX_FAST_QUANTISE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOX_FAST_QUANTISE_INL
#undef VOX_FAST_QUANTISE_INL
#else
#define VOX_FAST_QUANTISE_INL
#endif

#include "base/lanes-inl.hpp"
#include "fast/lookup.hpp"
#include "fast/tile-inl.hpp"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vox::fast {
namespace HWY_NAMESPACE {

using Bytes = hn::CappedTag<std::uint8_t, 64>;

// Maps coordinates of a box along one axis to 0 .. 255: (c - origin) * scale, truncated. Both are 0 where
// that could not be computed: then all coordinates map to 0, which is monotone too.
struct Scale {
    float origin, scale;
};

HWY_INLINE Scale MakeScale(float lo, float hi) {
    const float side = hi - lo;
    if (side > 0x1p-100f && side < 0x1p+120f) return {lo, 255.0f / side};
    return {0, 0};
}

HWY_INLINE void Quantise(const float* HWY_RESTRICT values, std::uint32_t count, Scale scale,
                         std::uint8_t* HWY_RESTRICT out) {
    const Floats d;
    const hn::RebindToSigned<Floats> di;
    const hn::Rebind<std::uint8_t, Floats> db;
    const auto origin = hn::Set(d, scale.origin), factor = hn::Set(d, scale.scale);
    for (std::uint32_t i = 0; i < count; i += static_cast<std::uint32_t>(hn::Lanes(d))) {
        const auto q = hn::ConvertTo(di, hn::Mul(hn::Sub(hn::LoadU(d, values + i), origin), factor));
        hn::StoreU(hn::DemoteTo(db, q), db, out + i);
    }
}

using vox::HWY_NAMESPACE::LookUpBytes;

// Indices below 16 stay, others get their top bit set: a lookup gives 0 for them.
HWY_INLINE hn::Vec<Bytes> QuarterIndex(hn::Vec<Bytes> index) {
#if HWY_TARGET == HWY_WASM
    return index; // a lookup gives 0 for all of 16 and more
#else
    const Bytes d;
    const auto biased = hn::Add(index, hn::Set(d, 0x70));
#if HWY_ARCH_X86
    return biased; // pshufb only looks at the top bit and the low four
#else
    return hn::And(biased, hn::Set(d, 0x8f));
#endif
#endif
}

constexpr std::uint32_t few_vertices = 48; // three registers of 16 bytes; most tiles have no more

// A table of bytes, looked up in quarters of 16. The lookup in a quarter gives 0 where the index is in
// another one.
template <std::uint32_t kQuarters>
struct ByteTable {
    hn::Vec<Bytes> quarter[kQuarters];

    HWY_INLINE explicit ByteTable(const std::uint8_t* values) {
        for (std::uint32_t q = 0; q < kQuarters; ++q)
            quarter[q] = hn::LoadDup128(Bytes(), values + std::size_t{16} * q);
    }
    HWY_INLINE hn::Vec<Bytes> operator()(hn::Vec<Bytes> index) const {
        const Bytes d;
        auto found = LookUpBytes(quarter[0], QuarterIndex(index));
        for (std::uint32_t q = 1; q < kQuarters; ++q) {
            const auto in_quarter = hn::Xor(index, hn::Set(d, static_cast<std::uint8_t>(16 * q)));
            found = hn::Or(found, LookUpBytes(quarter[q], QuarterIndex(in_quarter)));
        }
        return found;
    }
};

// Local indices of the corners, and the quantised boxes of the tets; of at most 16 kQuarters vertices.
template <std::uint32_t kQuarters>
HWY_INLINE void QuantiseTets(const std::uint8_t* HWY_RESTRICT corners, LookupScratch& s) {
    const Bytes d;
    for (std::size_t j = 0; j < tile_size; j += hn::Lanes(d)) {
        const auto c0 = hn::LoadU(d, corners + j), c1 = hn::LoadU(d, corners + tile_size + j);
        const auto c2 = hn::LoadU(d, corners + 2 * tile_size + j),
                   c3 = hn::LoadU(d, corners + 3 * tile_size + j);
        hn::StoreInterleaved4(c0, c1, c2, c3, d, reinterpret_cast<std::uint8_t*>(s.corners) + 4 * j);
        for (std::size_t a = 0; a < 3; ++a) {
            const ByteTable<kQuarters> table(s.quantised[a]);
            const auto v0 = table(c0), v1 = table(c1), v2 = table(c2), v3 = table(c3);
            const auto lo = hn::Min(hn::Min(v0, v1), hn::Min(v2, v3)),
                       hi = hn::Max(hn::Max(v0, v1), hn::Max(v2, v3));
            hn::Store(lo, d, s.lo[a] + j);
            hn::Store(hn::Sub(hi, lo), d, s.side[a] + j);
        }
    }
}

HWY_INLINE void QuantiseTile(const std::uint8_t* HWY_RESTRICT corners, const Scale* scales,
                             std::uint32_t vertex_count, LookupScratch& s) {
    Quantise(s.x, vertex_count, scales[0], s.quantised[0]);
    Quantise(s.y, vertex_count, scales[1], s.quantised[1]);
    Quantise(s.z, vertex_count, scales[2], s.quantised[2]);
    if (vertex_count <= few_vertices)
        QuantiseTets<few_vertices / 16>(corners, s);
    else
        QuantiseTets<4>(corners, s);
}

} // namespace HWY_NAMESPACE
} // namespace vox::fast
HWY_AFTER_NAMESPACE();

#endif
