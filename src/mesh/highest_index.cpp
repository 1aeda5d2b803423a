#include "mesh/highest_index.hpp"

#include "base/simd.hpp"

#undef VOX_SOURCE
#define VOX_SOURCE "mesh/highest_index.cpp"
#include "base/each_target.hpp"

HWY_BEFORE_NAMESPACE();
namespace vox {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

std::uint32_t Highest(const std::uint32_t* HWY_RESTRICT list, std::size_t count) {
    const hn::CappedTag<std::uint32_t, 16> d;
    const std::size_t lanes = hn::Lanes(d);
    auto a = hn::Zero(d), b = a, c = a, e = a; // four, which do not wait for each other
    std::size_t i = 0;
    for (; i + 4 * lanes <= count; i += 4 * lanes) {
        a = hn::Max(a, hn::LoadU(d, list + i));
        b = hn::Max(b, hn::LoadU(d, list + i + lanes));
        c = hn::Max(c, hn::LoadU(d, list + i + 2 * lanes));
        e = hn::Max(e, hn::LoadU(d, list + i + 3 * lanes));
    }
    std::uint32_t highest = hn::GetLane(hn::MaxOfLanes(d, hn::Max(hn::Max(a, b), hn::Max(c, e))));
    for (; i < count; ++i) highest = list[i] > highest ? list[i] : highest;
    return highest;
}

} // namespace HWY_NAMESPACE
} // namespace vox
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {

std::uint32_t highest_index(const std::uint32_t* list, std::size_t count) noexcept {
    return VOX_SIMD_DISPATCH(Highest)(list, count);
}

} // namespace vox
#endif
