#include "surface/compare_boxes.hpp"
#include "base/simd.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surface/compare_boxes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace vox {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void CompareTile(const float* HWY_RESTRICT tile, const float* const* HWY_RESTRICT boxes, std::size_t stride,
                 std::size_t count, float close_by, std::uint64_t* HWY_RESTRICT masks,
                 std::uint64_t* HWY_RESTRICT close) {
    const hn::CappedTag<float, 16> d;
    constexpr std::size_t n = 64;
    const std::size_t lanes = hn::Lanes(d);
    const auto zero = hn::Zero(d), most_close = hn::Set(d, close_by);
    for (std::size_t i = 0; i < count; ++i) {
        const float* const box = boxes[i];
        const auto lx = hn::Set(d, box[0]), ly = hn::Set(d, box[stride]), lz = hn::Set(d, box[2 * stride]);
        const auto hx = hn::Set(d, box[3 * stride]), hy = hn::Set(d, box[4 * stride]),
                   hz = hn::Set(d, box[5 * stride]);
        std::uint64_t overlapping = 0, barely = 0;
        for (std::size_t k = 0; k < n; k += lanes) {
            // How far the boxes reach into each other. The sign of a difference is exact.
            const auto x = hn::Min(hn::Sub(hx, hn::LoadU(d, tile + k)), hn::Sub(hn::LoadU(d, tile + 3 * n + k), lx));
            const auto y =
                hn::Min(hn::Sub(hy, hn::LoadU(d, tile + n + k)), hn::Sub(hn::LoadU(d, tile + 4 * n + k), ly));
            const auto z =
                hn::Min(hn::Sub(hz, hn::LoadU(d, tile + 2 * n + k)), hn::Sub(hn::LoadU(d, tile + 5 * n + k), lz));
            const auto least = hn::Min(x, hn::Min(y, z));
            overlapping |= BitsOfMask(d, hn::Ge(least, zero)) << k;
            barely |= BitsOfMask(d, hn::Le(least, most_close)) << k;
        }
        masks[i] = overlapping;
        close[i] = overlapping & barely;
    }
}

} // namespace HWY_NAMESPACE
} // namespace vox
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {

CompareBoxes* compare_boxes() noexcept { return VOX_SIMD_DISPATCH(CompareTile); }

} // namespace vox
#endif
