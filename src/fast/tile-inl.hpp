// Shared by stages that work on whole tiles: loading their vertices into registers, and determinants.
// Included once for each SIMD target, after hwy/highway.h.
#if defined(VOX_FAST_TILE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOX_FAST_TILE_INL
#undef VOX_FAST_TILE_INL
#else
#define VOX_FAST_TILE_INL
#endif

#include "fast/lookup.hpp"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vox::fast {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Four = hn::FixedTag<float, 4>;
using Floats = hn::CappedTag<float, 16>;
using Words = hn::RebindToUnsigned<Floats>;

// x, y, z of a vertex and one float more, which is the x of the next vertex. Not for the last vertex of the
// mesh.
HWY_INLINE hn::Vec<Four> LoadVertex(const float* positions, std::uint32_t v) {
    return hn::LoadU(Four(), positions + std::size_t{v} * 3);
}

// Loads the last vertex without reading past it.
HWY_INLINE hn::Vec<Four> LoadLastVertex(const float* positions, std::uint32_t v) {
    const float* p = positions + std::size_t{v} * 3;
    alignas(16) const float copy[4] = {p[0], p[1], p[2], 0};
    return hn::Load(Four(), copy);
}

// Either of them, as a type, so that calls are inlined wherever it is passed on to.
template <bool kHoldsLastVertex>
struct VertexLoader {
    HWY_INLINE hn::Vec<Four> operator()(const float* positions, std::uint32_t v) const {
        if constexpr (kHoldsLastVertex)
            return LoadLastVertex(positions, v);
        else
            return LoadVertex(positions, v);
    }
};

template <class Load>
HWY_INLINE void BoxOf(const float* positions, const std::uint32_t* vertices, std::uint32_t padded, Load load,
                      Box& box) {
    const Four d;
    auto lo0 = load(positions, vertices[0]), lo1 = load(positions, vertices[1]);
    auto hi0 = lo0, hi1 = lo1;
    for (std::uint32_t i = 2; i < padded; i += 2) {
        const auto p = load(positions, vertices[i]), q = load(positions, vertices[i + 1]);
        lo0 = hn::Min(lo0, p);
        hi0 = hn::Max(hi0, p);
        lo1 = hn::Min(lo1, q);
        hi1 = hn::Max(hi1, q);
    }
    hn::Store(hn::Min(lo0, lo1), d, box.lo);
    hn::Store(hn::Max(hi0, hi1), d, box.hi);
}

// Four positions, in each block of four lanes, as a structure of arrays.
template <class D, class Vec = hn::Vec<D>>
HWY_INLINE void Transpose(D d, Vec p0, Vec p1, Vec p2, Vec p3, Vec* xyz) {
    const auto xy02 = hn::InterleaveLower(d, p0, p2), xy13 = hn::InterleaveLower(d, p1, p3);
    const auto z02 = hn::InterleaveUpper(d, p0, p2), z13 = hn::InterleaveUpper(d, p1, p3);
    xyz[0] = hn::InterleaveLower(d, xy02, xy13);
    xyz[1] = hn::InterleaveUpper(d, xy02, xy13);
    xyz[2] = hn::InterleaveLower(d, z02, z13);
}

HWY_INLINE void StoreTransposed(hn::Vec<Four> p0, hn::Vec<Four> p1, hn::Vec<Four> p2, hn::Vec<Four> p3,
                                float* x, float* y, float* z) {
    const Four d;
    hn::Vec<Four> xyz[3];
    Transpose(d, p0, p1, p2, p3, xyz);
    hn::Store(xyz[0], d, x);
    hn::Store(xyz[1], d, y);
    hn::Store(xyz[2], d, z);
}

// Loads the tile's vertices as a structure of arrays, and makes their box unless kBox is false.
template <bool kBox, class Load>
HWY_INLINE void LoadTile(const float* positions, const std::uint32_t* vertices, std::uint32_t padded,
                         Load load, TileVertices& s, Box& box) {
    const Four d;
    auto lo = hn::Set(d, float_infinity), hi = hn::Set(d, -float_infinity);
    for (std::uint32_t i = 0; i < padded; i += 4) {
        const auto p0 = load(positions, vertices[i]), p1 = load(positions, vertices[i + 1]);
        const auto p2 = load(positions, vertices[i + 2]), p3 = load(positions, vertices[i + 3]);
        if constexpr (kBox) {
            lo = hn::Min(lo, hn::Min(hn::Min(p0, p1), hn::Min(p2, p3)));
            hi = hn::Max(hi, hn::Max(hn::Max(p0, p1), hn::Max(p2, p3)));
        }
        StoreTransposed(p0, p1, p2, p3, s.x + i, s.y + i, s.z + i);
    }
    for (std::uint32_t i = padded; i % 16; i += 4) { // fill the last register with a valid vertex
        hn::Store(hn::Set(d, s.x[0]), d, s.x + i);
        hn::Store(hn::Set(d, s.y[0]), d, s.y + i);
        hn::Store(hn::Set(d, s.z[0]), d, s.z + i);
    }
    if constexpr (!kBox) return;
    hn::Store(lo, d, box.lo);
    hn::Store(hi, d, box.hi);
}

template <bool kBox = true>
HWY_INLINE void LoadTile(const Tiles& tiles, const float* positions, const Tile& tile, TileVertices& s,
                         Box& box) {
    const std::uint32_t* vertices = tiles.vertices.data() + tile.first_vertex;
    const std::uint32_t padded = (tile.vertex_count + 3u) & ~3u;
    if (tile.holds_last_vertex)
        LoadTile<kBox>(positions, vertices, padded, LoadLastVertex, s, box);
    else
        LoadTile<kBox>(positions, vertices, padded, LoadVertex, s, box);
}

// A table of 64 floats, looked up by lane.
#if HWY_TARGET == HWY_AVX3
struct Table {
    __m512 part[4];
    explicit Table(const float* values) {
        for (int i = 0; i < 4; ++i) part[i] = _mm512_load_ps(values + 16 * i);
    }
    HWY_INLINE hn::Vec<Floats> operator()(hn::Vec<Words> index) const {
        const __mmask16 upper = _mm512_test_epi32_mask(index.raw, _mm512_set1_epi32(32));
        return hn::Vec<Floats>{_mm512_mask_blend_ps(upper,
                                                    _mm512_permutex2var_ps(part[0], index.raw, part[1]),
                                                    _mm512_permutex2var_ps(part[2], index.raw, part[3]))};
    }
};

// A table of words.
struct WordTable {
    Table floats;
    explicit WordTable(const std::uint32_t* values) : floats(reinterpret_cast<const float*>(values)) {}
    HWY_INLINE hn::Vec<Words> operator()(hn::Vec<Words> index) const {
        return hn::BitCast(Words(), floats(index));
    }
};
#endif

using V = hn::Vec<Floats>;

// The four floats at(i) as a structure of arrays, those of at(i) in lane i, without the last one.
template <class At>
HWY_INLINE void LoadLanes(At at, V* xyz) {
    const auto block_of = [&](std::size_t i) HWY_ATTR { // i, and four, eight, twelve lanes on
#if HWY_MAX_BYTES >= 64
        const hn::FixedTag<float, 8> d8;
        return hn::Combine(Floats(), hn::Combine(d8, at(i + 12), at(i + 8)),
                           hn::Combine(d8, at(i + 4), at(i)));
#elif HWY_MAX_BYTES >= 32
        return hn::Combine(Floats(), at(i + 4), at(i));
#else
        return at(i);
#endif
    };
    Transpose(Floats(), block_of(0), block_of(1), block_of(2), block_of(3), xyz);
}

HWY_INLINE V Difference(V a, V b, V c, V d) { return hn::Sub(hn::Mul(a, b), hn::Mul(c, d)); }

HWY_INLINE void Cross(const V* a, const V* b, V* out) {
    out[0] = Difference(a[1], b[2], a[2], b[1]);
    out[1] = Difference(a[2], b[0], a[0], b[2]);
    out[2] = Difference(a[0], b[1], a[1], b[0]);
}

HWY_INLINE V Dot(const V* a, const V* b) {
    return hn::Add(hn::Add(hn::Mul(a[0], b[0]), hn::Mul(a[1], b[1])), hn::Mul(a[2], b[2]));
}

// A bound on errors by underflow for tets with a box of these sides; infinite when some product could
// overflow.
HWY_INLINE float Underflow(float x, float y, float z) {
    const float sums = (x + y + z) + 4 * (x * y + y * z + z * x) + 1;
    const float largest = x * y * z * 64;
    return sums < float_infinity && largest < float_infinity ? sums * 0x1p-120f : float_infinity;
}

// The constants of the filter for tets in `box`: see the top of narrow-inl.hpp.
struct FilterConstants {
    float underflow;
    float rounding[3]; // six times the error of coordinates along each axis; 0 where the floats are exact
};

HWY_INLINE FilterConstants MakeConstants(const Box& box, bool rounded) {
    float side[3], rounding[3] = {};
    for (int a = 0; a < 3; ++a) {
        side[a] = box.hi[a] - box.lo[a];
        if (!rounded) continue;
        const float largest = -box.lo[a] > box.hi[a] ? -box.lo[a] : box.hi[a]; // magnitude in the box
        rounding[a] = largest * (6 * 1.125f * 0x1p-23f);
        side[a] += largest;
    }
    return {Underflow(side[0], side[1], side[2]), {rounding[0], rounding[1], rounding[2]}};
}

// The summand of the filter for rounded coordinates. `side` has the sides of the tet's box.
HWY_INLINE V RoundingError(const V* side, const float* rounding) {
    const Floats d;
    V e[3], s[3];
    for (int a = 0; a < 3; ++a) {
        e[a] = hn::Set(d, rounding[a]);
        s[a] = hn::Add(side[a], e[a]);
    }
    return hn::Add(hn::Mul(e[0], hn::Mul(s[1], s[2])),
                   hn::Mul(s[0], hn::Add(hn::Mul(e[1], s[2]), hn::Mul(s[1], e[2]))));
}

} // namespace HWY_NAMESPACE
} // namespace vox::fast
HWY_AFTER_NAMESPACE();

#endif
