// The arithmetic of corner_volumes() (predicates.hpp) for many points at once, operation by operation, with
// the same bits. Points that need exact arithmetic are left to that function.
#include "exact/point_location.hpp"

#include "base/simd.hpp"
#include "base/vectors.hpp"

#undef VOX_SOURCE
#define VOX_SOURCE "exact/point_location.cpp"
#include "base/each_target.hpp"

#include "base/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace vox {
namespace HWY_NAMESPACE {

#if HWY_HAVE_FLOAT64

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, 8>;
using D = hn::Vec<Doubles>;

struct MinorOf {
    D value, magnitude;
};

HWY_INLINE MinorOf Minor(const D* u, const D* v) {
    const D left = hn::Mul(u[0], v[1]), right = hn::Mul(v[0], u[1]);
    return {hn::Sub(left, right), hn::Add(hn::Abs(left), hn::Abs(right))};
}

HWY_INLINE void Determinant(D uz, const MinorOf& vw, D vz, const MinorOf& uw, D wz, const MinorOf& uv,
                            D& volume, D& error) {
    constexpr double epsilon = 0x1p-53;
    constexpr double bound = (7.0 + 56.0 * epsilon) * epsilon;
    const D permanent =
        hn::Add(hn::Add(hn::Mul(hn::Abs(uz), vw.magnitude), hn::Mul(hn::Abs(vz), uw.magnitude)),
                hn::Mul(hn::Abs(wz), uv.magnitude));
    volume = hn::Add(hn::Sub(hn::Mul(uz, vw.value), hn::Mul(vz, uw.value)), hn::Mul(wz, uv.value));
    error = hn::Mul(hn::Set(Doubles(), bound), permanent);
}

struct VolumesOf {
    D volume[4], error[4]; // without underflow_error

    HWY_INLINE VolumesOf() {} // gcc's implicit one is not compiled for these instructions: an error on Arm
};

// corner_volumes() of the points from i on; `e` are the corners relative to them.
HWY_INLINE VolumesOf CornerVolumes(const PointBlock& block, std::size_t i, D (&e)[4][3]) {
    for (int a = 0; a < 3; ++a) {
        const D p = hn::Load(Doubles(), block.point[a] + i);
        for (int c = 0; c < 4; ++c) e[c][a] = hn::Sub(hn::Load(Doubles(), block.corner[c][a] + i), p);
    }
    const D *u = e[0], *v = e[1], *w = e[2], *x = e[3];
    const MinorOf uv = Minor(u, v), uw = Minor(u, w), ux = Minor(u, x);
    const MinorOf vw = Minor(v, w), vx = Minor(v, x), wx = Minor(w, x);
    VolumesOf of;
    Determinant(v[2], wx, w[2], vx, x[2], vw, of.volume[0], of.error[0]);
    Determinant(u[2], wx, w[2], ux, x[2], uw, of.volume[1], of.error[1]);
    Determinant(u[2], vx, v[2], ux, x[2], uv, of.volume[2], of.error[2]);
    Determinant(u[2], vw, v[2], uw, w[2], uv, of.volume[3], of.error[3]);
    of.volume[1] = hn::Neg(of.volume[1]);
    of.volume[3] = hn::Neg(of.volume[3]);
    return of;
}

// locate_in_solid() for points that need no exact arithmetic.
HWY_INLINE CertainLocations Locations(const PointBlock& block, std::size_t count, VolumeBlock& volumes) {
    const Doubles d;
    const D zero = hn::Zero(d);
    CertainLocations certain;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        D e[4][3];
        const VolumesOf of = CornerVolumes(block, i, e);
        auto positive = hn::Gt(zero, zero), negative = positive, all_positive = hn::Eq(zero, zero),
             all_negative = all_positive, at_corner = positive;
        for (int c = 0; c < 4; ++c) {
            const D error = hn::Add(of.error[c], hn::Set(d, underflow_error));
            hn::Store(of.volume[c], d, volumes.volume[c] + i);
            hn::Store(error, d, volumes.error[c] + i);
            const auto above = hn::Gt(of.volume[c], error), below = hn::Gt(hn::Neg(of.volume[c]), error);
            positive = hn::Or(positive, above);
            negative = hn::Or(negative, below);
            all_positive = hn::And(all_positive, above);
            all_negative = hn::And(all_negative, below);
            const auto same = [&](int axis) HWY_ATTR { return hn::Eq(e[c][axis], zero); };
            at_corner = hn::Or(at_corner, hn::And(hn::And(same(0), same(1)), same(2)));
        }
        certain.outside |= BitsOfMask(d, hn::And(positive, negative)) << i;
        certain.interior |= BitsOfMask(d, hn::Or(all_positive, all_negative)) << i;
        // The volumes that the corner is part of are zero, exactly. So the certain one is the fourth.
        certain.boundary |= BitsOfMask(d, hn::And(at_corner, hn::Or(positive, negative))) << i;
    }
    return certain;
}

#else // without registers of doubles, every point is left to predicates.hpp

CertainLocations Locations(const PointBlock& block, std::size_t count, VolumeBlock& volumes) {
    for (std::size_t i = 0; i < count; ++i) {
        Vec3d at[5];
        for (int c = 0; c < 5; ++c) {
            const double(&from)[3][point_block] = c < 4 ? block.corner[c] : block.point;
            at[c] = {from[0][i], from[1][i], from[2][i]};
        }
        const auto of = corner_volumes(at[4], at[0], at[1], at[2], at[3]);
        for (std::size_t c = 0; c < 4; ++c) {
            volumes.volume[c][i] = of[c].volume;
            volumes.error[c][i] = of[c].error;
        }
    }
    return {};
}

#endif

CertainLocations Locate(const PointBlock& block, std::size_t count, VolumeBlock& volumes) {
    return Locations(block, count, volumes);
}

} // namespace HWY_NAMESPACE
} // namespace vox
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {

CertainLocations locate(const PointBlock& block, std::size_t count, VolumeBlock& volumes) {
    return VOX_SIMD_DISPATCH(Locate)(block, count, volumes);
}

} // namespace vox
#endif
