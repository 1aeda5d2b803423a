// Numbers of twice the digits of a double, as unevaluated sums of two (T. J. Dekker, A floating-point
// technique for extending the available precision, Numerische Mathematik 18, 1971). Included once for each
// SIMD target, after hwy/highway.h. A product is split or, where there are such instructions, fused, which
// gives the same bits, as both are exact.
#if defined(VOX_EXACT_DOUBLE_DOUBLE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOX_EXACT_DOUBLE_DOUBLE_INL
#undef VOX_EXACT_DOUBLE_DOUBLE_INL
#else
#define VOX_EXACT_DOUBLE_DOUBLE_INL
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vox {
namespace HWY_NAMESPACE {

#if HWY_HAVE_FLOAT64

namespace hn = hwy::HWY_NAMESPACE;

using WideDoubles = hn::CappedTag<double, 8>;
using WideDouble = hn::Vec<WideDoubles>;

struct Twofold {
    WideDouble high, low; // |low| is at most half a unit in the last place of `high`
};

HWY_INLINE Twofold ExactSum(WideDouble a, WideDouble b) {
    const WideDouble sum = hn::Add(a, b), part = hn::Sub(sum, a);
    return {sum, hn::Add(hn::Sub(a, hn::Sub(sum, part)), hn::Sub(b, part))};
}
HWY_INLINE Twofold ExactDifference(WideDouble a, WideDouble b) { return ExactSum(a, hn::Neg(b)); }

// For |a| >= |b|.
HWY_INLINE Twofold Joined(WideDouble a, WideDouble b) {
    const WideDouble sum = hn::Add(a, b);
    return {sum, hn::Sub(b, hn::Sub(sum, a))};
}

HWY_INLINE Twofold ExactProduct(WideDouble a, WideDouble b) {
    const WideDouble product = hn::Mul(a, b);
#if HWY_NATIVE_FMA
    return {product, hn::MulSub(a, b, product)};
#else
    const WideDouble splitter = hn::Set(WideDoubles(), 134217729.0); // 2^27 + 1
    const WideDouble of_a = hn::Mul(splitter, a), of_b = hn::Mul(splitter, b);
    const WideDouble a1 = hn::Sub(of_a, hn::Sub(of_a, a)), a2 = hn::Sub(a, a1);
    const WideDouble b1 = hn::Sub(of_b, hn::Sub(of_b, b)), b2 = hn::Sub(b, b1);
    const WideDouble rest =
        hn::Add(hn::Add(hn::Sub(hn::Mul(a1, b1), product), hn::Mul(a1, b2)), hn::Mul(a2, b1));
    return {product, hn::Add(rest, hn::Mul(a2, b2))};
#endif
}

// Off by 2^-104 of |a| + |b|.
HWY_INLINE Twofold operator+(const Twofold& a, const Twofold& b) {
    const Twofold high = ExactSum(a.high, b.high);
    return Joined(high.high, hn::Add(high.low, hn::Add(a.low, b.low)));
}
HWY_INLINE Twofold operator-(const Twofold& a) { return {hn::Neg(a.high), hn::Neg(a.low)}; }
HWY_INLINE Twofold operator-(const Twofold& a, const Twofold& b) { return a + -b; }
// Off by 2^-103 of the product.
HWY_INLINE Twofold operator*(const Twofold& a, const Twofold& b) {
    const Twofold high = ExactProduct(a.high, b.high);
    return Joined(high.high, hn::Add(high.low, hn::Add(hn::Mul(a.high, b.low), hn::Mul(a.low, b.high))));
}
// Off by 2^-100 of the quotient.
HWY_INLINE Twofold operator/(const Twofold& a, const Twofold& b) {
    const WideDouble first = hn::Div(a.high, b.high), zero = hn::Zero(WideDoubles());
    const Twofold rest = a - b * Twofold{first, zero};
    return Joined(first, hn::Div(rest.high, b.high));
}

struct TwofoldPoint {
    Twofold x, y, z;
};

HWY_INLINE Twofold Dot(const TwofoldPoint& a, const TwofoldPoint& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE TwofoldPoint Cross(const TwofoldPoint& a, const TwofoldPoint& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
HWY_INLINE TwofoldPoint Between(const WideDouble (&from)[3], const WideDouble (&to)[3]) {
    return {ExactDifference(to[0], from[0]), ExactDifference(to[1], from[1]),
            ExactDifference(to[2], from[2])};
}

#endif

} // namespace HWY_NAMESPACE
} // namespace vox
HWY_AFTER_NAMESPACE();

#endif
