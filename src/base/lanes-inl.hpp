// Operations on lanes that are one instruction in WebAssembly, but a loop or a detour through memory in
// Highway 1.0.3. Elsewhere they are Highway's. Included once for each SIMD target, after hwy/highway.h.
#if defined(VOX_BASE_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOX_BASE_LANES_INL
#undef VOX_BASE_LANES_INL
#else
#define VOX_BASE_LANES_INL
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace vox {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_WASM

// A bit for each lane of a whole register, that of the first lane lowest.
template <class D>
HWY_INLINE std::uint64_t BitsOfMask(D, hn::Mask<D> mask) {
    using T = hn::TFromD<D>;
    static_assert(hn::MaxLanes(D()) * sizeof(T) == 16 && sizeof(T) <= 4);
    if (sizeof(T) == 1) return wasm_i8x16_bitmask(mask.raw);
    return sizeof(T) == 2 ? wasm_i16x8_bitmask(mask.raw) : wasm_i32x4_bitmask(mask.raw);
}

template <class D>
HWY_INLINE std::size_t LanesOfMask(D d, hn::Mask<D> mask) { // their number
    return hwy::PopCount(BitsOfMask(d, mask));
}

template <class D>
HWY_INLINE bool NoneOfMask(D, hn::Mask<D> mask) {
    return !wasm_v128_any_true(mask.raw);
}

// table[index] where index < 16, 0 where index has its top bit set.
template <class Bytes>
HWY_INLINE Bytes LookUpBytes(Bytes table, Bytes index) {
    return Bytes{wasm_i8x16_swizzle(table.raw, index.raw)};
}

// Indices of lanes in a register, for LookUpLanes.
template <class D>
struct LaneIndices {
    static_assert(sizeof(hn::TFromD<D>) == 4);
    hn::Vec<hn::RebindToUnsigned<D>> bytes;

    HWY_INLINE explicit LaneIndices(hn::Vec<hn::RebindToUnsigned<D>> lanes)
        : bytes(hn::Add(hn::Mul(lanes, hn::Set(hn::RebindToUnsigned<D>(), 0x04040404u)),
                        hn::Set(hn::RebindToUnsigned<D>(), 0x03020100u))) {}
};
template <class D>
HWY_INLINE hn::Vec<D> LookUpLanes(D, hn::Vec<D> v, const LaneIndices<D>& indices) {
    return hn::Vec<D>{wasm_i8x16_swizzle(v.raw, indices.bytes.raw)};
}

#else

template <class D>
HWY_INLINE std::uint64_t BitsOfMask(D d, hn::Mask<D> mask) {
    std::uint64_t found = 0;
    alignas(8) std::uint8_t bits[8];
    hn::StoreMaskBits(d, mask, bits);
    std::memcpy(&found, bits, (hn::MaxLanes(d) + 7) / 8);
    return found;
}

template <class D>
HWY_INLINE std::size_t LanesOfMask(D d, hn::Mask<D> mask) {
    return hn::CountTrue(d, mask);
}

template <class D>
HWY_INLINE bool NoneOfMask(D d, hn::Mask<D> mask) {
    return hn::AllFalse(d, mask);
}

template <class Bytes>
HWY_INLINE Bytes LookUpBytes(Bytes table, Bytes index) {
    return hn::TableLookupBytesOr0(table, index);
}

template <class D>
struct LaneIndices {
    decltype(hn::IndicesFromVec(D(), hn::Zero(hn::RebindToSigned<D>()))) of;

    HWY_INLINE explicit LaneIndices(hn::Vec<hn::RebindToUnsigned<D>> lanes)
        : of(hn::IndicesFromVec(D(), hn::BitCast(hn::RebindToSigned<D>(), lanes))) {}
};
template <class D>
HWY_INLINE hn::Vec<D> LookUpLanes(D, hn::Vec<D> v, const LaneIndices<D>& indices) {
    return hn::TableLookupLanes(v, indices.of);
}

#endif

} // namespace HWY_NAMESPACE
} // namespace vox
HWY_AFTER_NAMESPACE();

#endif
