// The arithmetic of barycentric() and corner_volumes() (predicates.hpp) for many points at once, operation by
// operation, so that the bits are the same. What needs exact arithmetic is left to those functions.
//
// The tetrahedra and positions of hits are anywhere in memory, and waiting for them takes longer than the
// arithmetic. So each is prefetched some hits before it is needed.
#include "exact/barycentric.hpp"

#include "base/simd.hpp"
#include "exact/predicates.hpp"

#include <algorithm>
#include <bit>
#include <type_traits>

#undef VOX_SOURCE
#define VOX_SOURCE "exact/barycentric.cpp"
#include "base/each_target.hpp"

#include <hwy/cache_control.h>

HWY_BEFORE_NAMESPACE();
namespace vox {
namespace HWY_NAMESPACE {

#if HWY_HAVE_FLOAT64

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, 8>;
using HalfFloats = hn::Rebind<float, Doubles>;
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

HWY_INLINE D LoadDoubles(const float* values) {
    return hn::PromoteTo(Doubles(), hn::LoadU(HalfFloats(), values));
}
HWY_INLINE D LoadDoubles(const double* values) { return hn::LoadU(Doubles(), values); }

struct VolumesOf {
    D volume[4], error[4]; // without underflow_error

    HWY_INLINE VolumesOf() {} // one that gcc makes by itself is not for these instructions: on Arm an error
};

// corner_volumes() of the points from i on; `e` are the corners relative to them.
template <class Coordinate>
HWY_INLINE VolumesOf CornerVolumes(const BarycentricBlock<Coordinate>& block, std::size_t i, D (&e)[4][3]) {
    for (int a = 0; a < 3; ++a) {
        const D p = LoadDoubles(block.point[a] + i);
        for (int c = 0; c < 4; ++c) e[c][a] = hn::Sub(LoadDoubles(block.corner[c][a] + i), p);
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

HWY_INLINE std::uint64_t BitsFrom(hn::Mask<Doubles> mask, std::size_t i) {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(Doubles(), mask, bits);
    return std::uint64_t{bits[0]} << i;
}

// Bit i of the result is set when the weights of point i are uncertain; they are unspecified then. Computes
// whole registers.
template <class Coordinate>
HWY_INLINE std::uint64_t Weights(const BarycentricBlock<Coordinate>& block, std::size_t count,
                                 float* HWY_RESTRICT weights) {
    const Doubles d;
    const HalfFloats df;
    std::uint64_t uncertain = 0;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        D e[4][3];
        const VolumesOf of = CornerVolumes(block, i, e);
        const D v0 = of.volume[0], v1 = of.volume[1], v2 = of.volume[2], v3 = of.volume[3];
        const D total = hn::Add(hn::Add(hn::Add(v0, v1), v2), v3);
        D error = hn::Max(hn::Max(of.error[0], of.error[1]), hn::Max(of.error[2], of.error[3]));
        // With floats no product underflows, and no total other than zero is that small.
        if constexpr (std::is_same_v<Coordinate, double>) error = hn::Add(error, hn::Set(d, underflow_error));
        const auto certain = hn::Lt(error, hn::Mul(hn::Set(d, 0x1p-24), hn::Abs(total)));
        if (!hn::AllTrue(d, certain)) uncertain |= BitsFrom(hn::Not(certain), i);
        const D zero = hn::Zero(d), one = hn::Set(d, 1.0);
        const auto weight = [&](D volume) HWY_ATTR {
            const D t = hn::Div(volume, total);
            // Zero where t is not positive: never -0.
            return hn::DemoteTo(df, hn::IfThenElse(hn::Gt(t, zero), hn::Min(t, one), zero));
        };
        hn::StoreInterleaved4(weight(v0), weight(v1), weight(v2), weight(v3), df, weights + 4 * i);
    }
    return uncertain;
}

// locate_in_solid() as far as no exact arithmetic is needed.
HWY_INLINE CertainLocations Locations(const BarycentricBlock<double>& block, std::size_t count,
                                      VolumeBlock& volumes) {
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
        certain.outside |= BitsFrom(hn::And(positive, negative), i);
        certain.interior |= BitsFrom(hn::Or(all_positive, all_negative), i);
        // The volumes that the corner is part of are zero, exactly. So the certain one is the fourth.
        certain.boundary |= BitsFrom(hn::And(at_corner, hn::Or(positive, negative)), i);
    }
    return certain;
}

#else // without registers of doubles, every point is left to predicates.hpp

template <class Coordinate>
std::uint64_t Weights(const BarycentricBlock<Coordinate>&, std::size_t, float*) {
    return ~std::uint64_t{0};
}

CertainLocations Locations(const BarycentricBlock<double>& block, std::size_t count, VolumeBlock& volumes) {
    for (std::size_t i = 0; i < count; ++i) {
        Vec3d at[5];
        for (int c = 0; c < 5; ++c) {
            const double(&from)[3][barycentric_block] = c < 4 ? block.corner[c] : block.point;
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

std::uint64_t WeightsOfFloats(const BarycentricBlock<float>& block, std::size_t count, float* weights) {
    return Weights(block, count, weights);
}

std::uint64_t WeightsOfDoubles(const BarycentricBlock<double>& block, std::size_t count, float* weights) {
    return Weights(block, count, weights);
}

CertainLocations Locate(const BarycentricBlock<double>& block, std::size_t count, VolumeBlock& volumes) {
    return Locations(block, count, volumes);
}

} // namespace HWY_NAMESPACE
} // namespace vox
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {

std::uint64_t barycentric(const BarycentricBlock<float>& block, std::size_t count, float* weights) {
    return VOX_SIMD_DISPATCH(WeightsOfFloats)(block, count, weights);
}

std::uint64_t barycentric(const BarycentricBlock<double>& block, std::size_t count, float* weights) {
    return VOX_SIMD_DISPATCH(WeightsOfDoubles)(block, count, weights);
}

CertainLocations locate(const BarycentricBlock<double>& block, std::size_t count, VolumeBlock& volumes) {
    return VOX_SIMD_DISPATCH(Locate)(block, count, volumes);
}

namespace {

// The exact position, as floats where the caller's positions are floats.
template <class Coordinate>
auto position(const Positions& positions, std::uint32_t vertex) {
    if constexpr (std::is_same_v<Coordinate, float>)
        return positions.floats(vertex);
    else
        return positions.exact(vertex);
}

template <class Coordinate>
void weights_of_block(std::span<const Body> bodies, std::span<const Hit> hits, std::size_t first,
                      BarycentricWeights& weights) {
    // Far enough ahead to hide the latency of memory, and near enough that nothing is evicted before its use.
    constexpr std::size_t tets_ahead = 48, positions_ahead = 24;
    BarycentricBlock<Coordinate> block;
    const std::size_t count = std::min(barycentric_block, hits.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t h = first + i;
        if (h + tets_ahead < hits.size()) {
            const Hit& later = hits[h + tets_ahead];
            hwy::Prefetch(bodies[later.body_b].tets.data() + later.tet);
        }
        if (h + positions_ahead < hits.size()) {
            const Hit& later = hits[h + positions_ahead];
            const Body &a = bodies[later.body_a], &b = bodies[later.body_b];
            hwy::Prefetch(a.positions.data + later.vertex * a.positions.byte_stride);
            for (const std::uint32_t v : b.tets[later.tet].v)
                hwy::Prefetch(b.positions.data + v * b.positions.byte_stride);
        }
        const Hit& hit = hits[h];
        const Body& b = bodies[hit.body_b];
        const auto p = position<Coordinate>(bodies[hit.body_a].positions, hit.vertex);
        block.point[0][i] = p.x;
        block.point[1][i] = p.y;
        block.point[2][i] = p.z;
        const Tet& tet = b.tets[hit.tet];
        for (std::size_t c = 0; c < 4; ++c) {
            const auto q = position<Coordinate>(b.positions, tet.v[c]);
            block.corner[c][0][i] = q.x;
            block.corner[c][1][i] = q.y;
            block.corner[c][2][i] = q.z;
        }
    }
    // Whole registers are computed, so the last one is filled up.
    for (std::size_t i = count; i % 8; ++i) {
        for (std::size_t a = 0; a < 3; ++a) {
            block.point[a][i] = block.point[a][0];
            for (std::size_t c = 0; c < 4; ++c) block.corner[c][a][i] = block.corner[c][a][0];
        }
    }
    std::uint64_t uncertain = barycentric(block, count, &weights[0][0]) & ~std::uint64_t{0} >> (64 - count);
    for (; uncertain; uncertain &= uncertain - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(uncertain));
        const Hit& hit = hits[first + i];
        const Positions& q = bodies[hit.body_b].positions;
        const Tet& tet = bodies[hit.body_b].tets[hit.tet];
        weights[i] = barycentric<float>(bodies[hit.body_a].positions.exact(hit.vertex), q.exact(tet.v[0]),
                                        q.exact(tet.v[1]), q.exact(tet.v[2]), q.exact(tet.v[3]));
    }
}

} // namespace

void barycentric(std::span<const Body> bodies, bool rounded, std::span<const Hit> hits, std::size_t first,
                 BarycentricWeights& weights) {
    if (rounded)
        weights_of_block<double>(bodies, hits, first, weights);
    else
        weights_of_block<float>(bodies, hits, first, weights);
}

} // namespace vox
#endif
