// Separating axes that are fixed over the step.
//
// Proof. Let w be any vector, a_i(t) and b_j(t) the corners of two features, each linear in t. For each i and
// j, w . (a_i(t) - b_j(t)) is linear in t, so where it exceeds g at t = 0 and at t = 1, it does so at all
// times between. Points of the features are convex combinations of the corners, so the same holds for all
// pairs of points p and q of them: w . (p - q) > g, and |p - q| > g / |w|. So two features stay further apart
// than d if
//     min_i w . a_i - max_j w . b_j > d |w|    at t = 0 and at t = 1,
// or the same with a and b exchanged at both times. How w was found does not matter: it may be rounded, or be
// nonsense.
//
// Rounding. Let M >= 1 be the largest coordinate in the frame, |w|1 the sum of the magnitudes of w's numbers,
// u = 2^-24. A coordinate is off by less than 1.01 u M: the difference to the middle, in doubles, by 2^-53 of
// itself, and its rounding to a float by u of itself; the scale is a power of two. A product of w with it,
// summed in floats, is off by another 3.01 u M |w|1. So each of two projections is off by less than 4.1 u M
// |w|1, and their difference, rounded once more, by less than 10.3 u M |w|1 < 2^-20.6 M |w|1. The bound that
// is compared with takes 1.125 * 2^-20 M |w|1, whose surplus covers the roundings of the bound's own terms,
// and `apart` is rounded up by 2^-18. Where |w|1 is below 2^-60, underflow could matter, and nothing is
// decided; where something overflows, the comparison with infinity or NaN fails, and the pair stays.
#include "surface/cull.hpp"
#include "base/simd.hpp"
#include "base/vectors.hpp"

#include <algorithm>
#include <cmath>

#undef VOX_SOURCE
#define VOX_SOURCE "surface/cull.cpp"
#include "base/each_target.hpp"

#include "base/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace vox {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using CullFloats = hn::CappedTag<float, 16>;
using CV = hn::Vec<CullFloats>;
using CM = hn::Mask<CullFloats>;

struct CV3 {
    // gcc's implicit constructors are not compiled for these instructions: an error on Arm.
    HWY_INLINE CV3() {}
    HWY_INLINE CV3(CV to_x, CV to_y, CV to_z) : x(to_x), y(to_y), z(to_z) {}

    CV x, y, z;
};

HWY_INLINE CV CSet(float f) { return hn::Set(CullFloats(), f); }
HWY_INLINE CV3 CSub(const CV3& a, const CV3& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE CV3 CAddScaled(const CV3& a, CV s, const CV3& b) { // a + s b
    return {hn::Add(a.x, hn::Mul(s, b.x)), hn::Add(a.y, hn::Mul(s, b.y)), hn::Add(a.z, hn::Mul(s, b.z))};
}
HWY_INLINE CV CDot(const CV3& a, const CV3& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE CV3 CCross(const CV3& a, const CV3& b) {
    return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
            hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
HWY_INLINE CV3 CSelect(CM where, const CV3& yes, const CV3& no) {
    return {hn::IfThenElse(where, yes.x, no.x), hn::IfThenElse(where, yes.y, no.y),
            hn::IfThenElse(where, yes.z, no.z)};
}
// n / d in [0, 1]; 0 where d is not positive.
HWY_INLINE CV CUnit(CV n, CV d) {
    const CV zero = CSet(0), one = CSet(1);
    const CM positive = hn::Gt(d, zero);
    const CV q = hn::Div(n, hn::IfThenElse(positive, d, one));
    return hn::IfThenElse(positive, hn::Min(hn::Max(q, zero), one), zero);
}

// The corners of some lanes, and of the partner, at both times.
template <int kA, int kB>
struct CullPair {
    HWY_INLINE CullPair() {}

    CV3 a[2][kA], b[2][kB];
    CV apart, error; // the bound is apart |w| + error |w|1

    HWY_INLINE CM StayApart(const CV3& w) const {
        const CV absolute = hn::Add(hn::Add(hn::Abs(w.x), hn::Abs(w.y)), hn::Abs(w.z));
        const CV bound = hn::Add(hn::Mul(apart, hn::Sqrt(CDot(w, w))), hn::Mul(error, absolute));
        CV above = CSet(0), below = above; // the lesser of both times
        for (int t = 0; t < 2; ++t) {
            CV least_a = CDot(w, a[t][0]), most_a = least_a, least_b = CDot(w, b[t][0]), most_b = least_b;
            for (int i = 1; i < kA; ++i) {
                const CV p = CDot(w, a[t][i]);
                least_a = hn::Min(least_a, p);
                most_a = hn::Max(most_a, p);
            }
            for (int j = 1; j < kB; ++j) {
                const CV p = CDot(w, b[t][j]);
                least_b = hn::Min(least_b, p);
                most_b = hn::Max(most_b, p);
            }
            const CV over = hn::Sub(least_a, most_b), under = hn::Sub(least_b, most_a);
            above = t == 0 ? over : hn::Min(above, over);
            below = t == 0 ? under : hn::Min(below, under);
        }
        const CM apart_so = hn::Or(hn::Gt(above, bound), hn::Gt(below, bound));
        return hn::And(apart_so, hn::Gt(absolute, CSet(0x1p-60f)));
    }
};

// The way from the closest point of segment q to that of segment p, about (Ericson 2005, Sect. 5.1.9).
HWY_INLINE CV3 BetweenSegments(const CV3& p0, const CV3& p1, const CV3& q0, const CV3& q1) {
    const CV3 d1 = CSub(p1, p0), d2 = CSub(q1, q0), r = CSub(p0, q0);
    const CV a = CDot(d1, d1), e = CDot(d2, d2), b = CDot(d1, d2), c = CDot(d1, r), f = CDot(d2, r);
    CV s = CUnit(hn::Sub(hn::Mul(b, f), hn::Mul(c, e)), hn::Sub(hn::Mul(a, e), hn::Mul(b, b)));
    const CV t = CUnit(hn::Add(hn::Mul(b, s), f), e);
    s = CUnit(hn::Sub(hn::Mul(b, t), c), a);
    return CAddScaled(CAddScaled(r, s, d1), hn::Neg(t), d2);
}

// The way from the closest point of segment q to p.
HWY_INLINE CV3 BetweenPointAndSegment(const CV3& p, const CV3& q0, const CV3& q1) {
    const CV3 d = CSub(q1, q0), r = CSub(p, q0);
    return CAddScaled(r, hn::Neg(CUnit(CDot(d, r), CDot(d, d))), d);
}

// The way from the closest point of triangle q to p, or the normal where p is above the triangle.
HWY_INLINE CV3 BetweenPointAndTriangle(const CV3& p, const CV3* q) {
    const CV3 normal = CCross(CSub(q[1], q[0]), CSub(q[2], q[0]));
    CV3 nearest = CSub(p, q[0]);
    CV squared = CDot(nearest, nearest);
    CM inside = hn::Ge(squared, CSet(0));
    for (int i = 0; i < 3; ++i) {
        const CV3 &from = q[i], &to = q[(i + 1) % 3];
        const CV3 way = BetweenPointAndSegment(p, from, to);
        const CV d = CDot(way, way);
        const CM nearer = hn::Lt(d, squared);
        nearest = CSelect(nearer, way, nearest);
        squared = hn::IfThenElse(nearer, d, squared);
        inside = hn::And(inside, hn::Ge(CDot(CCross(CSub(to, from), CSub(p, from)), normal), CSet(0)));
    }
    return CSelect(inside, normal, nearest);
}

// The middles of all corners, as a direction.
template <int kCorners>
HWY_INLINE CV3 MiddleOf(const CV3* corners) {
    CV3 sum = corners[0];
    for (int i = 1; i < kCorners; ++i) sum = CAddScaled(sum, CSet(1), corners[i]);
    const CV share = CSet(1.0f / static_cast<float>(kCorners));
    return {hn::Mul(sum.x, share), hn::Mul(sum.y, share), hn::Mul(sum.z, share)};
}

// A direction between two features at one time, about that of their closest points.
template <int kA, int kB>
HWY_INLINE CV3 Between(const CV3* a, const CV3* b) {
    if constexpr (kA == 1 && kB == 1)
        return CSub(a[0], b[0]);
    else if constexpr (kA == 2 && kB == 2)
        return BetweenSegments(a[0], a[1], b[0], b[1]);
    else if constexpr (kA == 1 && kB == 2)
        return BetweenPointAndSegment(a[0], b[0], b[1]);
    else if constexpr (kA == 2 && kB == 1)
        return BetweenPointAndSegment(b[0], a[0], a[1]);
    else if constexpr (kA == 1 && kB == 3)
        return BetweenPointAndTriangle(a[0], b);
    else if constexpr (kA == 3 && kB == 1)
        return BetweenPointAndTriangle(b[0], a);
    else
        return CSub(MiddleOf<kA>(a), MiddleOf<kB>(b));
}

// The axes, the most promising one first.
template <int kA, int kB>
struct CullAxes {
    static constexpr int kEdgesA = kA == 3 ? 3 : kA - 1,
                         kEdgesB = kB == 3 ? 3 : kB - 1; // each without a repetition
    static constexpr int kProducts = kEdgesA * kEdgesB, kCount = 3 + kProducts + (kA == 3) + (kB == 3);

    static HWY_INLINE CV3 Normal(const CV3* c) { return CCross(CSub(c[1], c[0]), CSub(c[2], c[0])); }

    static HWY_INLINE CV3 At(int axis, const CullPair<kA, kB>& pair) {
        if (axis < 2) return Between<kA, kB>(pair.a[axis], pair.b[axis]);
        if (axis == 2) { // halfway, for what passes by
            CV3 a[kA], b[kB];
            for (int i = 0; i < kA; ++i) a[i] = CAddScaled(pair.a[0][i], CSet(1), pair.a[1][i]);
            for (int j = 0; j < kB; ++j) b[j] = CAddScaled(pair.b[0][j], CSet(1), pair.b[1][j]);
            return Between<kA, kB>(a, b);
        }
        axis -= 3;
        if constexpr (kProducts > 0) {
            if (axis < kProducts) {
                const int i = axis % kEdgesA, j = axis / kEdgesA;
                return CCross(CSub(pair.a[0][(i + 1) % kA], pair.a[0][i]),
                              CSub(pair.b[0][(j + 1) % kB], pair.b[0][j]));
            }
            axis -= kProducts;
        }
        if constexpr (kA == 3) {
            if (axis == 0 || kB < 3) return Normal(pair.a[0]);
        }
        if constexpr (kB == 3) return Normal(pair.b[0]);
        return pair.a[0][0]; // not reached
    }
};

// Loads lanes in a row, without gathering. The axis is across the relative motion, where the middles come
// closest.
std::uint32_t CullAcross(const CullTile& tile, const CullPartner& vertex, std::uint32_t lanes) {
    const CullFloats d;
    const std::size_t width = hn::Lanes(d);
    CullPair<3, 1> pair;
    pair.apart = CSet(0);
    pair.error = hn::Mul(CSet(vertex.largest), CSet(1.125f * 0x1p-20f));
    for (int t = 0; t < 2; ++t)
        pair.b[t][0] = {CSet(vertex.at[t][0][0]), CSet(vertex.at[t][0][1]), CSet(vertex.at[t][0][2])};
    std::uint32_t kept = 0;
    for (std::size_t first = 0; first < 32 && lanes >> first != 0; first += width) {
        for (int t = 0; t < 2; ++t)
            for (int i = 0; i < 3; ++i)
                pair.a[t][i] = {hn::Load(d, tile.at[t][i][0] + first), hn::Load(d, tile.at[t][i][1] + first),
                                hn::Load(d, tile.at[t][i][2] + first)};
        const CV3 from = CSub(MiddleOf<3>(pair.a[0]), pair.b[0][0]),
                  way = CSub(CSub(MiddleOf<3>(pair.a[1]), pair.b[1][0]), from);
        const CV3 axis = CAddScaled(from, CUnit(hn::Neg(CDot(from, way)), CDot(way, way)), way);
        const std::uint64_t close = ~BitsOfMask(d, pair.StayApart(axis)) & ((std::uint64_t{1} << width) - 1);
        kept |= static_cast<std::uint32_t>(close << first);
    }
    return kept & lanes;
}

// One axis after the other, each with all pairs that are left, so that lanes are full.
template <int kA, int kB>
HWY_INLINE std::size_t CullPairsOf(const CullPairs& pairs) {
    const CullFloats d;
    const hn::RebindToSigned<CullFloats> di;
    const std::size_t width = hn::Lanes(d);
    constexpr int kPartner = sizeof(CullPartner) / sizeof(float);
    const float* const of_partners = &pairs.partners->at[0][0][0];
    CullPair<kA, kB> pair;
    pair.apart = CSet(pairs.apart);
    std::size_t count = pairs.count;
    for (int axis = 0; axis < CullAxes<kA, kB>::kCount && count > 0; ++axis) {
        std::size_t kept = 0;
        for (std::size_t first = 0; first < count; first += width) {
            const std::size_t some = count - first < width ? count - first : width;
            alignas(64) std::int32_t lanes[16], partner[16];
            for (std::size_t i = 0; i < width; ++i) {
                const std::size_t at = i < some ? first + i : first;
                lanes[i] = static_cast<std::int32_t>(pairs.lanes[at]);
                partner[i] = static_cast<std::int32_t>(pairs.partner[at]) * kPartner;
            }
            const auto lane = hn::Load(di, lanes), other = hn::Load(di, partner);
            for (int t = 0; t < 2; ++t) {
                for (int i = 0; i < kA; ++i)
                    pair.a[t][i] = {hn::GatherIndex(d, pairs.tile.at[t][i][0], lane),
                                    hn::GatherIndex(d, pairs.tile.at[t][i][1], lane),
                                    hn::GatherIndex(d, pairs.tile.at[t][i][2], lane)};
                for (int j = 0; j < kB; ++j) {
                    const float* const from = of_partners + (t * 3 + j) * 3;
                    pair.b[t][j] = {hn::GatherIndex(d, from, other), hn::GatherIndex(d, from + 1, other),
                                    hn::GatherIndex(d, from + 2, other)};
                }
            }
            pair.error = hn::Mul(hn::GatherIndex(d, of_partners + 18, other), CSet(1.125f * 0x1p-20f));
            const std::uint64_t gone = BitsOfMask(d, pair.StayApart(CullAxes<kA, kB>::At(axis, pair)));
            for (std::size_t i = 0; i < some; ++i) {
                const std::uint32_t own = pairs.lanes[first + i], their = pairs.partner[first + i];
                pairs.lanes[kept] = own;
                pairs.partner[kept] = their;
                kept += ~gone >> i & 1;
            }
        }
        count = kept;
    }
    return count;
}

std::size_t Cull(const CullPairs& pairs) {
    switch (3 * (pairs.corners - 1) + pairs.partner_corners - 1) {
    case 0:
        return CullPairsOf<1, 1>(pairs);
    case 1:
        return CullPairsOf<1, 2>(pairs);
    case 2:
        return CullPairsOf<1, 3>(pairs);
    case 3:
        return CullPairsOf<2, 1>(pairs);
    case 4:
        return CullPairsOf<2, 2>(pairs);
    case 5:
        return CullPairsOf<2, 3>(pairs);
    case 6:
        return CullPairsOf<3, 1>(pairs);
    case 7:
        return CullPairsOf<3, 2>(pairs);
    default:
        return CullPairsOf<3, 3>(pairs);
    }
}

} // namespace HWY_NAMESPACE
} // namespace vox
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {

namespace {

void put_corners(const CullFrame& frame, std::span<const Vec3d> positions,
                 std::span<const std::uint32_t> corners, std::size_t time, float (*at)[3]) noexcept {
    for (const std::uint32_t v : corners) {
        const Vec3d p = frame.scale * (positions[v] - frame.middle[time]);
        (*at)[0] = static_cast<float>(p.x);
        (*at)[1] = static_cast<float>(p.y);
        (*at)[2] = static_cast<float>(p.z);
        ++at;
    }
}

} // namespace

std::uint32_t cull_across(const CullTile& tile, const CullPartner& vertex, std::uint32_t lanes) {
    return VOX_SIMD_DISPATCH(CullAcross)(tile, vertex, lanes);
}
std::size_t cull_some(const CullPairs& pairs) { return VOX_SIMD_DISPATCH(Cull)(pairs); }

namespace {

struct Sides {
    Vec3d lo, hi;

    Vec3d middle() const noexcept { return 0.5 * lo + 0.5 * hi; }
};

Sides sides_of(std::span<const Vec3d> at, std::span<const std::uint32_t> vertices) noexcept {
    Sides sides{at[vertices[0]], at[vertices[0]]};
    for (const std::uint32_t v : vertices) sides = {min(sides.lo, at[v]), max(sides.hi, at[v])};
    return sides;
}

// With a scale for what is between these sides. None overflows: positions are floats, or about as large, or
// 0.
CullFrame frame_of(const Sides& from, const Sides& to) noexcept {
    CullFrame frame{{from.middle(), to.middle()}, 1};
    double largest = 0;
    for (const Sides* sides : {&from, &to})
        for (const Vec3d& v : {sides->hi - sides->middle(), sides->middle() - sides->lo})
            largest = std::max(largest, largest_coordinate(v));
    if (!(largest > 0)) largest = largest_coordinate(to.lo - from.lo); // a single point
    int exponent = 0;                                                  // of the power of two above it
    if (largest > 0) (void)std::frexp(largest, &exponent);
    frame.scale = std::ldexp(1.0, -std::max(exponent, -1000));
    return frame;
}

} // namespace

CullFrame frame_around(const SurfaceMotion& motion, std::span<const std::uint32_t> vertices) noexcept {
    const Sides from = sides_of(motion.from, vertices), to = sides_of(motion.to, vertices),
                all{min(from.lo, to.lo), max(from.hi, to.hi)};
    return frame_of(all, all);
}

CullFrame frame_along(const SurfaceMotion& motion, std::span<const std::uint32_t> vertices) noexcept {
    return frame_of(sides_of(motion.from, vertices), sides_of(motion.to, vertices));
}

float apart_in(const CullFrame& frame, const SurfaceMotion& motion) noexcept {
    return static_cast<float>(2 * motion.radius * frame.scale) * (1 + 0x1p-18f);
}

void set_lane(const CullFrame& frame, const SurfaceMotion& motion, std::span<const std::uint32_t> corners,
              std::size_t lane, CullTile& tile) noexcept {
    for (std::size_t t = 0; t < 2; ++t) {
        float at[3][3] = {};
        put_corners(frame, t == 0 ? motion.from : motion.to, corners, t, at);
        for (std::size_t c = 0; c < corners.size(); ++c)
            for (std::size_t a = 0; a < 3; ++a) tile.at[t][c][a][lane] = at[c][a];
    }
}

CullPartner partner_in(const CullFrame& frame, const SurfaceMotion& motion,
                       std::span<const std::uint32_t> corners) noexcept {
    CullPartner partner{};
    partner.largest = 1;
    put_corners(frame, motion.from, corners, 0, partner.at[0]);
    put_corners(frame, motion.to, corners, 1, partner.at[1]);
    for (const auto& time : partner.at)
        for (const auto& corner : time)
            for (const float x : corner) partner.largest = std::max(partner.largest, std::abs(x));
    return partner;
}

} // namespace vox
#endif
