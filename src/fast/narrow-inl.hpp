// The last part of the lookup of a tile: it decides pairs of candidates and tets in single precision with a
// bound on the rounding errors. What that leaves open is decided exactly by the receiver of the findings
// (decide.hpp). Included once for each SIMD target, after hwy/highway.h.
//
// The float filter. Let p be in the closed box of tet abcd, w the sides of that box (rounded up by at most
// one relative u = 2^-24), and W = w_x w_y w_z. All of b-a, c-a, d-a, p-a are within w component by
// component, each with a relative error of at most u. Each of D = det(b-a, c-a, d-a) and the three volumes
// with p in place of one corner is a sum of six products of three such differences; through three
// differences, two products, one inner and at most two outer sums each product collects at most eight
// relative errors u, so the result is off by at most 6 W ((1+u)^8 - 1) < 48.1 u W. The fourth volume, D minus
// the three, adds the four errors and three roundings of sums of at most 12, 18 and 24 W: below 247 u W. So a
// volume beyond 256 u W has the sign of the exact one (N. J. Higham, Accuracy and Stability of Numerical
// Algorithms, 2002, ch. 3). Products that underflow are off by at most 2^-126 (2^-150 unless results are
// flushed to zero), once more multiplied by a side: a constant for the tile covers them, which is infinite
// when some product could overflow, and then nothing is certain.
//
// Positions that are rounded to floats (scene.hpp) are off by at most u M along an axis, where M is the
// largest magnitude of a rounded coordinate in the tile's box, or by 2^-150. So a difference is off by e = 2
// u M (1 + 2 u), and the volume of the true points from that of the rounded ones, each a sum of six products
// of three differences, by at most six times (w_x + e_x) (w_y + e_y) (w_z + e_z) - W <= e_x s_y s_z + s_x e_y
// s_z + s_x s_y e_z, s = w + e. The bound has that as one more summand, with 6 e (and a little more, for
// roundings) in place of e.
//
// The volumes add up to D. If two of them have strictly opposite signs, p is outside; if all four have one
// strict sign, p is inside.
#if defined(VOX_FAST_NARROW_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOX_FAST_NARROW_INL
#undef VOX_FAST_NARROW_INL
#else
#define VOX_FAST_NARROW_INL
#endif

#include "base/compress-inl.hpp"
#include "base/lanes-inl.hpp"
#include "fast/lookup.hpp"
#include "fast/tile-inl.hpp"

#include <hwy/highway.h>

#ifndef VOX_FAST_NARROW_ONCE
#define VOX_FAST_NARROW_ONCE
namespace vox::fast {

// Out of line and compiled once, so it may call functions that are not compiled for the target.
void hand_over(LookupScratch& scratch, Findings& out);

} // namespace vox::fast
#endif

HWY_BEFORE_NAMESPACE();
namespace vox::fast {
namespace HWY_NAMESPACE {

// The coordinates of the corners of some tets, one tet in each lane.
#if HWY_TARGET == HWY_AVX3
// In tables of floats in registers.
class Corners {
public:
    struct Tets {
        hn::Vec<Words> corners;
    };

    static void Prepare(LookupScratch&, std::uint32_t) {} // once the tile's vertices are in scratch
    explicit Corners(const LookupScratch& s)
        : table_{Table(s.x), Table(s.y), Table(s.z)}, corners_(s.corners) {}
    HWY_INLINE Tets operator[](const std::uint32_t* pairs) const {
        return {corners_(hn::And(hn::LoadU(Words(), pairs), hn::Set(Words(), 63)))};
    }
    template <int kCorner>
    HWY_INLINE void Load(const Tets& tets, V* out) const {
        const auto index = hn::And(hn::ShiftRight<8 * kCorner>(tets.corners), hn::Set(Words(), 255));
        for (int a = 0; a < 3; ++a) out[a] = table_[a](index);
    }

private:
    Table table_[3];
    WordTable corners_;
};
#else
// Loaded vertex by vertex and transposed. With AVX2, a scene in half overlap takes 0.89 of the time that it
// took with permutations of tables in registers.
class Corners {
public:
    struct Tets {
        const std::uint32_t* pairs;
    };

    static void Prepare(LookupScratch& s, std::uint32_t vertex_count) {
        const Floats d;
        for (std::uint32_t i = 0; i < vertex_count; i += static_cast<std::uint32_t>(hn::Lanes(d)))
            hn::StoreInterleaved4(hn::Load(d, s.x + i), hn::Load(d, s.y + i), hn::Load(d, s.z + i),
                                  hn::Zero(d), d, s.xyz + 4 * i);
    }
    explicit Corners(const LookupScratch& s)
        : xyz_(s.xyz), corners_(reinterpret_cast<const std::uint8_t*>(s.corners)) {}
    HWY_INLINE Tets operator[](const std::uint32_t* pairs) const { return {pairs}; }
    template <int kCorner>
    HWY_INLINE void Load(const Tets& tets, V* out) const {
        const auto vertex = [&](std::size_t i) HWY_ATTR {
            const std::size_t v = corners_[4 * (tets.pairs[i] & 63) + kCorner];
#if HWY_TARGET == HWY_AVX2
            const std::size_t v4 = corners_[4 * (tets.pairs[i + 4] & 63) + kCorner];
            return hn::Combine(Floats(), hn::Load(Four(), xyz_ + 4 * v4), hn::Load(Four(), xyz_ + 4 * v));
#else
            return hn::Load(Four(), xyz_ + 4 * v);
#endif
        };
        Transpose(Floats(), vertex(0), vertex(1), vertex(2), vertex(3), out);
    }

private:
    const float* xyz_;
    const std::uint8_t* corners_;
};
#endif

using vox::HWY_NAMESPACE::Compressor, vox::HWY_NAMESPACE::LaneIndices, vox::HWY_NAMESPACE::LanesOfMask,
    vox::HWY_NAMESPACE::LookUpLanes, vox::HWY_NAMESPACE::NoneOfMask;

constexpr std::uint32_t certain_pair = 1u << 31; // a bit that is not set in pairs

// What findings call the tets of a tile: by `index`, or first, first + 1, ... where that is null.
struct TetNames {
    const std::uint32_t* index;
    std::uint32_t first;
};

// Decides `count` pairs.
template <bool kRounded>
HWY_NOINLINE void Narrow(const TetNames& tets, LookupScratch& s, std::uint32_t count,
                         const FilterConstants& constants, Findings& out) {
    const Floats d;
    const Words du;
    const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
    const Corners corners(s);
    const float* candidates[3] = {s.candidate_x, s.candidate_y, s.candidate_z};
    for (std::uint32_t i = 0; i < lanes; ++i) s.pairs[count + i] = s.pairs[count - 1]; // whole registers
    std::uint32_t kept_count = 0;
    for (std::uint32_t i = 0; i < count; i += lanes) {
        const auto pair = hn::LoadU(du, s.pairs + i);
        // Pairs are sorted by candidate and each candidate has some, so the candidates of a register are
        // consecutive.
        const std::uint32_t first = s.pairs[i] >> 6;
        const LaneIndices<Floats> candidate(hn::Sub(hn::ShiftRight<6>(pair), hn::Set(du, first)));
        const auto tets_of = corners[s.pairs + i];
        V va[3], vb[3], vc[3], vd[3];
        corners.Load<0>(tets_of, va);
        corners.Load<1>(tets_of, vb);
        corners.Load<2>(tets_of, vc);
        corners.Load<3>(tets_of, vd);
        V e1[3], e2[3], e3[3], q[3], side[3], volume = hn::Set(d, 256 * 0x1p-24f);
        auto inside = hn::FirstN(d, count - i);
        for (int a = 0; a < 3; ++a) {
            const V p = LookUpLanes(d, hn::LoadU(d, candidates[a] + first), candidate);
            const V lo = hn::Min(hn::Min(va[a], vb[a]), hn::Min(vc[a], vd[a])),
                    hi = hn::Max(hn::Max(va[a], vb[a]), hn::Max(vc[a], vd[a]));
            inside = hn::And(inside, hn::And(hn::Ge(p, lo), hn::Le(p, hi)));
            side[a] = hn::Sub(hi, lo);
            volume = hn::Mul(volume, side[a]);
            e1[a] = hn::Sub(vb[a], va[a]);
            e2[a] = hn::Sub(vc[a], va[a]);
            e3[a] = hn::Sub(vd[a], va[a]);
            q[a] = hn::Sub(p, va[a]);
        }
        if (NoneOfMask(d, inside)) continue;
        s.counters.candidates += LanesOfMask(d, inside);
        V n[3], m[3];
        Cross(e2, e3, n);
        Cross(e1, q, m);
        const V u1 = Dot(q, n), u2 = Dot(e3, m), u3 = hn::Neg(Dot(e2, m));
        const V u0 = hn::Sub(hn::Sub(hn::Sub(Dot(e1, n), u1), u2), u3);
        V bound = hn::Add(volume, hn::Set(d, constants.underflow));
        if constexpr (kRounded) bound = hn::Add(bound, RoundingError(side, constants.rounding));
        const V least = hn::Min(hn::Min(u0, u1), hn::Min(u2, u3));
        const V most = hn::Max(hn::Max(u0, u1), hn::Max(u2, u3));
        const auto positive = hn::Gt(least, bound), negative = hn::Lt(most, hn::Neg(bound));
        const auto outside = hn::And(hn::Lt(least, hn::Neg(bound)), hn::Gt(most, bound));
        const auto certain = hn::Or(positive, negative);
        const Compressor kept(hn::AndNot(outside, inside));
        const auto marked =
            hn::Or(pair, hn::IfThenElseZero(hn::RebindMask(du, certain), hn::Set(du, certain_pair)));
        hn::StoreU(kept(marked), du, s.pairs + kept_count); // overwrites only pairs that were read
        kept_count += kept.count();
    }
    for (std::uint32_t i = 0; i < kept_count; ++i) {
        const std::uint32_t pair = s.pairs[i] & ~certain_pair;
        const std::uint32_t place = pair >> 6, tet = pair & 63, f = s.finding_count++;
        // Written as a whole, as bit fields set one by one are slow to read back.
        s.findings[f] = {s.candidate_body[s.meeting[place]], s.candidate_id[s.meeting[place]],
                         (tets.index ? tets.index[tet] : tets.first + tet) & 0x7fffffffu,
                         (s.pairs[i] & certain_pair) != 0};
        if (s.finding_count == LookupScratch::most_findings) hand_over(s, out);
    }
}

} // namespace HWY_NAMESPACE
} // namespace vox::fast
HWY_AFTER_NAMESPACE();

#endif
