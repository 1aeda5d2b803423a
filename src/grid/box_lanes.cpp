#include "grid/box_lanes.hpp"

#include "base/simd.hpp"

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

} // namespace vox
#endif
