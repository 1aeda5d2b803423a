#include "grid/box_lanes.hpp"

#include "base/simd.hpp"

#include <algorithm>

#undef VOX_SOURCE
#define VOX_SOURCE "grid/box_lanes.cpp"
#include "base/each_target.hpp"

#include "base/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace vox {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void FindFaces(const Box* HWY_RESTRICT boxes, std::size_t count, const FaceBoxes& faces,
               std::uint32_t face_count, std::uint32_t* HWY_RESTRICT out) {
    const hn::CappedTag<float, 16> d;
    using V = hn::Vec<decltype(d)>;
    const std::uint32_t wanted = face_count < 32 ? (1u << face_count) - 1 : ~0u;
    for (std::size_t i = 0; i < count; ++i) {
        const Box& box = boxes[i];
        const V lo[3] = {hn::Set(d, box.lo[0]), hn::Set(d, box.lo[1]), hn::Set(d, box.lo[2])};
        const V hi[3] = {hn::Set(d, box.hi[0]), hn::Set(d, box.hi[1]), hn::Set(d, box.hi[2])};
        std::uint64_t met = 0;
        for (std::size_t k = 0; k < face_count; k += hn::Lanes(d)) {
            const auto meets = [&](std::size_t axis) HWY_ATTR {
                return hn::And(hn::Le(hn::LoadU(d, faces.lo[axis] + k), hi[axis]),
                               hn::Le(lo[axis], hn::LoadU(d, faces.hi[axis] + k)));
            };
            met |= BitsOfMask(d, hn::And(meets(0), hn::And(meets(1), meets(2)))) << k;
        }
        out[i] = static_cast<std::uint32_t>(met) & wanted;
    }
}

void KeepNear(const Segment* HWY_RESTRICT segments, std::size_t count, const FaceSlabs& faces, float reach,
              std::uint32_t* HWY_RESTRICT met) {
    const hn::CappedTag<float, 16> d;
    using V = hn::Vec<decltype(d)>;
    for (std::size_t i = 0; i < count; ++i) {
        if (met[i] == 0) continue;
        const Vec3f from = nearest_floats(FaceSlabs::scale * (segments[i].from - faces.origin)),
                    to = nearest_floats(FaceSlabs::scale * (segments[i].to - faces.origin));
        std::uint64_t apart = 0;
        for (std::size_t k = 0; k < FaceBoxes::count; k += hn::Lanes(d)) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const V x = hn::LoadU(d, faces.axis[axis][0] + k), y = hn::LoadU(d, faces.axis[axis][1] + k),
                        z = hn::LoadU(d, faces.axis[axis][2] + k);
                const auto along = [&](const Vec3f& p) HWY_ATTR {
                    return hn::MulAdd(x, hn::Set(d, p.x),
                                      hn::MulAdd(y, hn::Set(d, p.y), hn::Mul(z, hn::Set(d, p.z))));
                };
                const V p = along(from), q = along(to);
                const V by = hn::Set(d, float{FaceSlabs::scale} * reach);
                const V lo = hn::Sub(hn::LoadU(d, faces.lo[axis] + k), by),
                        hi = hn::Add(hn::LoadU(d, faces.hi[axis] + k), by);
                const auto above = hn::And(hn::Gt(p, hi), hn::Gt(q, hi));
                apart |= BitsOfMask(d, hn::Or(above, hn::And(hn::Lt(p, lo), hn::Lt(q, lo)))) << k;
            }
        }
        met[i] &= ~static_cast<std::uint32_t>(apart);
    }
}

// Which way around a line with direction e and moment n one with d and m goes is the sign of d.n + m.e. The
// sum of floats is off by less than 2^-20 of the sum of the magnitudes of its six products.
void KeepCrossed(const Segment* HWY_RESTRICT segments, std::size_t count, const FaceLines& faces,
                 std::uint32_t* HWY_RESTRICT met) {
    const hn::CappedTag<float, 16> d;
    using V = hn::Vec<decltype(d)>;
    const V rounding = hn::Set(d, 0x1p-18f), underflow = hn::Set(d, 0x1p-90f);
    for (std::size_t i = 0; i < count; ++i) {
        if (met[i] == 0) continue;
        const Vec3d from = faces.scale * (segments[i].from - faces.origin),
                    way = faces.scale * (segments[i].to - segments[i].from);
        if (!(std::max(largest_coordinate(from), largest_coordinate(way)) < 0x1p20)) continue;
        const Line line(from, way);
        std::uint64_t beside = 0;
        for (std::size_t k = 0; k < FaceBoxes::count; k += hn::Lanes(d)) {
            std::uint64_t left = 0, right = 0;
            for (std::size_t side = 0; side < 3; ++side) {
                V around = hn::Zero(d), size = hn::Zero(d);
                for (std::size_t c = 0; c < 6; ++c)
                    around = hn::MulAdd(hn::Set(d, line.at[c]), hn::LoadU(d, faces.at[side][(c + 3) % 6] + k),
                                        around);
                for (std::size_t c = 0; c < 2; ++c)
                    size =
                        hn::MulAdd(hn::Set(d, line.size[c]), hn::LoadU(d, faces.size[side][1 - c] + k), size);
                const V error = hn::MulAdd(rounding, size, underflow);
                left |= BitsOfMask(d, hn::Gt(around, error));
                right |= BitsOfMask(d, hn::Gt(hn::Neg(around), error));
            }
            beside |= (left & right) << k;
        }
        met[i] &= ~static_cast<std::uint32_t>(beside);
    }
}

} // namespace HWY_NAMESPACE
} // namespace vox
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {

void find_faces(const Box* boxes, std::size_t count, const FaceBoxes& faces, std::uint32_t face_count,
                std::uint32_t* out) noexcept {
    VOX_SIMD_DISPATCH(FindFaces)(boxes, count, faces, face_count, out);
}

void keep_near(const Segment* segments, std::size_t count, const FaceSlabs& faces, float reach,
               std::uint32_t* met) noexcept {
    VOX_SIMD_DISPATCH(KeepNear)(segments, count, faces, reach, met);
}

void keep_crossed(const Segment* segments, std::size_t count, const FaceLines& faces,
                  std::uint32_t* met) noexcept {
    VOX_SIMD_DISPATCH(KeepCrossed)(segments, count, faces, met);
}

} // namespace vox
#endif
