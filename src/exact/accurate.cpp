#include "exact/accurate.hpp"

#include "base/simd.hpp"

#include <array>

#undef VOX_SOURCE
#define VOX_SOURCE "exact/accurate.cpp"
#include "base/each_target.hpp"

#include "base/lanes-inl.hpp"
#include "exact/double_double-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace vox {
namespace HWY_NAMESPACE {

#if HWY_HAVE_FLOAT64

// Volumes and areas below it may lose digits.
constexpr double least_accurate = 0x1p-800;

HWY_INLINE void LoadPoint(const double (&from)[3][point_block], std::size_t i, WideDouble (&to)[3]) {
    for (int axis = 0; axis < 3; ++axis) to[axis] = hn::Load(WideDoubles(), from[axis] + i);
}

struct TwofoldMinor {
    Twofold value;
    WideDouble magnitude;
};

HWY_INLINE TwofoldMinor AccurateMinor(const TwofoldPoint& u, const TwofoldPoint& v) {
    const Twofold left = u.x * v.y, right = v.x * u.y;
    return {left - right, hn::Add(hn::Abs(left.high), hn::Abs(right.high))};
}

// Expanded like determinant() in predicates.hpp. `most` becomes at least the sum of the terms' magnitudes:
// the result is off by less than 2^-98 of it.
HWY_INLINE Twofold AccurateDeterminant(const Twofold& uz, const TwofoldMinor& vw, const Twofold& vz,
                                       const TwofoldMinor& uw, const Twofold& wz, const TwofoldMinor& uv,
                                       WideDouble& most) {
    const WideDouble permanent =
        hn::Add(hn::Add(hn::Mul(hn::Abs(uz.high), vw.magnitude), hn::Mul(hn::Abs(vz.high), uw.magnitude)),
                hn::Mul(hn::Abs(wz.high), uv.magnitude));
    most = hn::Max(most, permanent);
    return uz * vw.value - vz * uw.value + wz * uv.value;
}

// Returns a bit for each point that needs exact arithmetic.
std::uint64_t WeighAccurately(const PointBlock& block, std::size_t count, bool clamped,
                              AccurateWeights& out) {
    const WideDoubles d;
    const WideDouble zero = hn::Zero(d), one = hn::Set(d, 1.0);
    std::uint64_t uncertain = 0;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        WideDouble p[3], corner[3];
        TwofoldPoint e[4];
        LoadPoint(block.point, i, p);
        for (int c = 0; c < 4; ++c) {
            LoadPoint(block.corner[c], i, corner);
            e[c] = Between(p, corner);
        }
        const TwofoldPoint &u = e[0], &v = e[1], &w = e[2], &x = e[3];
        const TwofoldMinor uv = AccurateMinor(u, v), uw = AccurateMinor(u, w), ux = AccurateMinor(u, x);
        const TwofoldMinor vw = AccurateMinor(v, w), vx = AccurateMinor(v, x), wx = AccurateMinor(w, x);
        WideDouble most = zero;
        const Twofold volume[4] = {AccurateDeterminant(v.z, wx, w.z, vx, x.z, vw, most),
                                   -AccurateDeterminant(u.z, wx, w.z, ux, x.z, uw, most),
                                   AccurateDeterminant(u.z, vx, v.z, ux, x.z, uv, most),
                                   -AccurateDeterminant(u.z, vw, v.z, uw, w.z, uv, most)};
        const Twofold total = volume[0] + volume[1] + (volume[2] + volume[3]);
        const WideDouble size = hn::Abs(total.high);
        const auto certain = hn::And(hn::Gt(size, hn::Mul(hn::Set(d, 0x1p-40), most)),
                                     hn::Gt(size, hn::Set(d, least_accurate)));
        if (!hn::AllTrue(d, certain)) uncertain |= BitsOfMask(d, hn::Not(certain)) << i;
        for (int c = 0; c < 4; ++c) {
            WideDouble weight = (volume[c] / total).high;
            if (clamped) weight = hn::IfThenElse(hn::Gt(weight, zero), hn::Min(weight, one), zero);
            hn::Store(weight, d, out.weight[c] + i);
        }
    }
    return uncertain;
}

// The closest point of an edge: how far along it, and its squared distance.
HWY_INLINE void ClosestOnEdge(const TwofoldPoint& way, const TwofoldPoint& edge, Twofold& along,
                              Twofold& squared) {
    const WideDoubles d;
    const WideDouble zero = hn::Zero(d), one = hn::Set(d, 1.0);
    along = Dot(way, edge) / Dot(edge, edge);
    const auto before = hn::Not(hn::Gt(along.high, zero)), after = hn::Ge(along.high, one);
    along.high = hn::IfThenElse(before, zero, hn::IfThenElse(after, one, along.high));
    along.low = hn::IfThenElse(hn::Or(before, after), zero, along.low);
    const TwofoldPoint rest = {way.x - along * edge.x, way.y - along * edge.y, way.z - along * edge.z};
    squared = Dot(rest, rest);
}

std::uint64_t WeighClosest(const PointBlock& block, std::size_t count, AccurateWeights& out) {
    const WideDoubles d;
    const WideDouble zero = hn::Zero(d), one = hn::Set(d, 1.0), least = hn::Set(d, least_accurate);
    std::uint64_t uncertain = 0;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        WideDouble p[3], corner[3][3];
        LoadPoint(block.point, i, p);
        for (int c = 0; c < 3; ++c) LoadPoint(block.corner[c], i, corner[c]);
        const TwofoldPoint u = Between(corner[0], corner[1]), v = Between(corner[0], corner[2]),
                           way = Between(corner[0], p), normal = Cross(u, v);
        const Twofold area = Dot(normal, normal), uu = Dot(u, u), vv = Dot(v, v);
        const TwofoldPoint across = Between(corner[1], corner[2]);
        const WideDouble third = Dot(across, across).high;
        const WideDouble longest = hn::Max(hn::Max(uu.high, vv.high), third);
        const WideDouble shortest = hn::Min(hn::Min(uu.high, vv.high), third);
        const WideDouble thin = hn::Mul(hn::Set(d, 0x1p-40), hn::Mul(longest, longest));
        const WideDouble far = hn::Mul(hn::Set(d, 0x1p-80), Dot(way, way).high);
        const auto certain = hn::And(hn::And(hn::Gt(area.high, thin), hn::Gt(shortest, far)),
                                     hn::Gt(hn::Min(area.high, shortest), least));
        if (!hn::AllTrue(d, certain)) uncertain |= BitsOfMask(d, hn::Not(certain)) << i;
        const Twofold unit = {one, zero};
        const Twofold at_1 = Dot(Cross(way, v), normal) / area, at_2 = Dot(Cross(u, way), normal) / area;
        const Twofold at_0 = unit - at_1 - at_2;
        WideDouble weight[3] = {at_0.high, at_1.high, at_2.high};
        const auto above = hn::Ge(hn::Min(weight[0], hn::Min(weight[1], weight[2])), zero);
        // Beside the triangle the closest point is on an edge.
        const TwofoldPoint edge[3] = {u, across, v}, from[3] = {way, Between(corner[1], p), way};
        constexpr int begin[3] = {0, 1, 0}, end[3] = {1, 2, 2};
        Twofold nearest = unit;
        for (int n = 0; n < 3; ++n) {
            Twofold along, squared;
            ClosestOnEdge(from[n], edge[n], along, squared);
            const auto lower =
                hn::Or(hn::Lt(squared.high, nearest.high),
                       hn::And(hn::Eq(squared.high, nearest.high), hn::Lt(squared.low, nearest.low)));
            const auto better = n == 0 ? hn::Not(above) : hn::AndNot(above, lower);
            nearest.high = hn::IfThenElse(better, squared.high, nearest.high);
            nearest.low = hn::IfThenElse(better, squared.low, nearest.low);
            weight[begin[n]] = hn::IfThenElse(better, (unit - along).high, weight[begin[n]]);
            weight[end[n]] = hn::IfThenElse(better, along.high, weight[end[n]]);
            weight[3 - begin[n] - end[n]] = hn::IfThenElse(better, zero, weight[3 - begin[n] - end[n]]);
        }
        for (int c = 0; c < 3; ++c) hn::Store(weight[c], d, out.weight[c] + i);
    }
    return uncertain;
}

HWY_INLINE WideDouble SizeOfProducts(const TwofoldPoint& a, const TwofoldPoint& b, const TwofoldPoint& c) {
    const auto size = [](const Twofold& x, const Twofold& y, const Twofold& z)
                          HWY_ATTR { return hn::Abs(hn::Mul(x.high, hn::Mul(y.high, z.high))); };
    const WideDouble x = hn::Add(size(a.x, b.y, c.z), size(a.x, b.z, c.y)),
                     y = hn::Add(size(a.y, b.z, c.x), size(a.y, b.x, c.z)),
                     z = hn::Add(size(a.z, b.x, c.y), size(a.z, b.y, c.x));
    return hn::Add(hn::Add(x, y), z);
}

// Returns a bit for each crossing whose rounding is not certain.
std::uint64_t CrossPlanes(const PointBlock& block, std::size_t count, Crossings& out) {
    const WideDoubles d;
    const WideDouble least = hn::Set(d, least_accurate);
    std::uint64_t uncertain = 0;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        WideDouble from[3], corner[4][3];
        LoadPoint(block.point, i, from);
        for (int c = 0; c < 4; ++c) LoadPoint(block.corner[c], i, corner[c]);
        const TwofoldPoint u = Between(corner[0], corner[1]), v = Between(corner[0], corner[2]),
                           before = Between(from, corner[0]), way = Between(from, corner[3]),
                           normal = Cross(u, v);
        const Twofold over = Dot(before, normal), under = Dot(way, normal), place = over / under;
        // Each volume is off by less than 2^-98 of the size of its products.
        const WideDouble relative = hn::Add(hn::Div(SizeOfProducts(before, u, v), hn::Abs(over.high)),
                                            hn::Div(SizeOfProducts(way, u, v), hn::Abs(under.high)));
        const WideDouble error = hn::Mul(hn::Mul(hn::Set(d, 0x1p-96), relative), hn::Abs(place.high));
        const auto certain =
            hn::And(hn::And(hn::Eq(hn::Add(place.high, hn::Add(place.low, error)), place.high),
                            hn::Eq(hn::Add(place.high, hn::Sub(place.low, error)), place.high)),
                    hn::Gt(hn::Min(hn::Abs(over.high), hn::Abs(under.high)), least));
        if (!hn::AllTrue(d, certain)) uncertain |= BitsOfMask(d, hn::Not(certain)) << i;
        hn::Store(place.high, d, out.t + i);
    }
    return uncertain;
}

#else // without registers of doubles, every point is left to exact arithmetic

std::uint64_t WeighAccurately(const PointBlock&, std::size_t, bool, AccurateWeights&) {
    return ~std::uint64_t{0};
}
std::uint64_t WeighClosest(const PointBlock&, std::size_t, AccurateWeights&) { return ~std::uint64_t{0}; }

std::uint64_t CrossPlanes(const PointBlock&, std::size_t, Crossings&) { return ~std::uint64_t{0}; }

#endif

} // namespace HWY_NAMESPACE
} // namespace vox
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {

void weigh_accurately(const PointBlock& block, std::size_t count, bool clamped, AccurateWeights& out) {
    const auto exactly = [&out](std::size_t i, const Vec3d& p, const Vec3d(&c)[4]) {
        const std::array<double, 4> weights = exact_weights(p, c[0], c[1], c[2], c[3]);
        for (std::size_t n = 0; n < 4; ++n) out.weight[n][i] = weights[n];
    };
    for_uncertain(VOX_SIMD_DISPATCH(WeighAccurately)(block, count, clamped, out), block, count, exactly);
}

void cross_planes(const PointBlock& block, std::size_t count, Crossings& out) {
    const auto exactly = [&out](std::size_t i, const Vec3d& from, const Vec3d(&c)[4]) {
        out.t[i] = exact_crossing(from, c[3], c[0], c[1], c[2]);
    };
    for_uncertain(VOX_SIMD_DISPATCH(CrossPlanes)(block, count, out), block, count, exactly);
}

std::uint64_t weigh_closest(const PointBlock& block, std::size_t count, AccurateWeights& out) {
    return VOX_SIMD_DISPATCH(WeighClosest)(block, count, out);
}

} // namespace vox
#endif
