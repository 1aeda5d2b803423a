// A box is above or below a region along an axis where its low corner is beyond the region's high one, or the
// other way round. With the signs of all high corners turned that is one comparison of all six.
#include "fast/sides.hpp"
#include "base/simd.hpp"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/sides.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vox::fast {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A region, and the sides of eight boxes from there, a byte each.
class Sides {
public:
    static constexpr std::uint32_t at_once = 8;

    HWY_INLINE explicit Sides(const Box& region)
        : sign_(hn::OddEvenBlocks(hn::Set(d, -0.0f), hn::Zero(d))), // odd blocks are high corners
          bound_(
              hn::Xor(hn::OddEvenBlocks(hn::LoadDup128(d, region.lo), hn::LoadDup128(d, region.hi)), sign_)),
          region_(region) {}

    HWY_INLINE std::uint64_t operator()(const Box* boxes) const {
        std::uint64_t sides = 0;
        constexpr std::size_t lanes = hn::MaxLanes(d);
        if constexpr (lanes >= 8) { // whole boxes
            for (std::size_t i = 0; i < at_once; i += lanes / 8) {
                const auto corners = hn::Xor(hn::LoadU(d, boxes[i].lo), sign_);
                std::uint8_t bits[8];
                hn::StoreMaskBits(d, hn::Gt(corners, bound_), bits);
                std::uint64_t some = 0;
                std::memcpy(&some, bits, lanes / 8);
                sides |= some << (8 * i);
            }
        } else {
            for (unsigned i = 0; i < at_once; ++i)
                sides |= std::uint64_t{sides_of(boxes[i], region_)} << (8 * i);
        }
        return sides & (all_sides * each_byte);
    }

    // Bits of the bytes that are zero.
    HWY_INLINE static std::uint64_t None(std::uint64_t sides) {
        // No byte is above 0x77, so that nothing is carried from one to the next; then the bits are gathered.
        const std::uint64_t some = (sides + 0x7f * each_byte) >> 7 & each_byte;
        return (some ^ each_byte) * 0x0102040810204080u >> 56;
    }

private:
    static constexpr std::uint64_t each_byte = 0x0101010101010101u;
    static constexpr hn::CappedTag<float, 16> d{};
    hn::Vec<hn::CappedTag<float, 16>> sign_, bound_;
    const Box& region_;
};

void FindSides(const Box* HWY_RESTRICT boxes, std::size_t count, const Box& region,
               std::uint8_t* HWY_RESTRICT out) {
    const Sides sides(region);
    std::size_t i = 0;
    for (; i + Sides::at_once <= count; i += Sides::at_once) {
        const std::uint64_t some = sides(boxes + i);
        std::memcpy(out + i, &some, sizeof some);
    }
    for (; i < count; ++i) out[i] = static_cast<std::uint8_t>(sides_of(boxes[i], region));
}

std::uint64_t FindOverlaps(const Box* HWY_RESTRICT boxes, std::uint32_t count, const Box& region) {
    const Sides sides(region);
    std::uint64_t overlaps = 0;
    std::uint32_t i = 0;
    for (; i + Sides::at_once <= count; i += Sides::at_once) overlaps |= Sides::None(sides(boxes + i)) << i;
    for (; i < count; ++i) overlaps |= std::uint64_t{sides_of(boxes[i], region) == 0} << i;
    return overlaps;
}

} // namespace HWY_NAMESPACE
} // namespace vox::fast
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox::fast {

void find_sides(const Box* boxes, std::size_t count, const Box& region, std::uint8_t* sides) {
    VOX_SIMD_DISPATCH(FindSides)(boxes, count, region, sides);
}

std::uint64_t find_overlaps(const Box* boxes, std::uint32_t count, const Box& region) {
    return VOX_SIMD_DISPATCH(FindOverlaps)(boxes, count, region);
}

} // namespace vox::fast
#endif
