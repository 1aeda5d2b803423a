// Minimum and maximum of interleaved coordinates, a vector register per axis.
#include "stream.hpp"
#include "../simd.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/stream.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vox::fast {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

bool StreamBoxes(const float* HWY_RESTRICT positions, std::uint32_t count, Box* HWY_RESTRICT blocks,
                 Box& body) {
    const hn::CappedTag<float, 16> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    const std::size_t lanes = hn::Lanes(d);
    const std::uint32_t full = count / 64;
    // A number is finite when its bits without the sign are below those of infinity.
    const auto magnitude = hn::Set(du, 0x7fffffffu);
    auto largest = hn::Zero(du);
    Box all = empty_box;
    for (std::uint32_t b = 0; b < full; ++b) {
        const float* p = positions + std::size_t{b} * 192;
        auto lx = hn::Undefined(d), ly = lx, lz = lx;
        hn::LoadInterleaved3(d, p, lx, ly, lz);
        auto hx = lx, hy = ly, hz = lz;
        largest = hn::Max(largest, hn::And(hn::BitCast(du, lx), magnitude));
        largest = hn::Max(largest, hn::And(hn::BitCast(du, ly), magnitude));
        largest = hn::Max(largest, hn::And(hn::BitCast(du, lz), magnitude));
        for (std::size_t i = lanes; i < 64; i += lanes) {
            auto x = hn::Undefined(d), y = x, z = x;
            hn::LoadInterleaved3(d, p + 3 * i, x, y, z);
            largest = hn::Max(largest, hn::And(hn::BitCast(du, x), magnitude));
            largest = hn::Max(largest, hn::And(hn::BitCast(du, y), magnitude));
            largest = hn::Max(largest, hn::And(hn::BitCast(du, z), magnitude));
            lx = hn::Min(lx, x);
            hx = hn::Max(hx, x);
            ly = hn::Min(ly, y);
            hy = hn::Max(hy, y);
            lz = hn::Min(lz, z);
            hz = hn::Max(hz, z);
        }
        Box& box = blocks[b];
        box.lo[0] = hn::GetLane(hn::MinOfLanes(d, lx));
        box.lo[1] = hn::GetLane(hn::MinOfLanes(d, ly));
        box.lo[2] = hn::GetLane(hn::MinOfLanes(d, lz));
        box.lo[3] = 0;
        box.hi[0] = hn::GetLane(hn::MaxOfLanes(d, hx));
        box.hi[1] = hn::GetLane(hn::MaxOfLanes(d, hy));
        box.hi[2] = hn::GetLane(hn::MaxOfLanes(d, hz));
        box.hi[3] = 0;
        for (int a = 0; a < 4; ++a) all.lo[a] = box.lo[a] < all.lo[a] ? box.lo[a] : all.lo[a];
        for (int a = 0; a < 4; ++a) all.hi[a] = box.hi[a] > all.hi[a] ? box.hi[a] : all.hi[a];
    }
    bool finite = hn::GetLane(hn::MaxOfLanes(du, largest)) < 0x7f800000u;
    if (full * 64 < count) {
        Box box = empty_box;
        for (std::uint32_t v = full * 64; v < count; ++v)
            for (int a = 0; a < 3; ++a) {
                const float c = positions[std::size_t{v} * 3 + static_cast<std::size_t>(a)];
                finite &= c - c == 0; // not so for infinities and NaN
                box.lo[a] = c < box.lo[a] ? c : box.lo[a];
                box.hi[a] = c > box.hi[a] ? c : box.hi[a];
            }
        blocks[full] = box;
        for (int a = 0; a < 3; ++a) all.lo[a] = box.lo[a] < all.lo[a] ? box.lo[a] : all.lo[a];
        for (int a = 0; a < 3; ++a) all.hi[a] = box.hi[a] > all.hi[a] ? box.hi[a] : all.hi[a];
    }
    body = all;
    return finite;
}

} // namespace HWY_NAMESPACE
} // namespace vox::fast
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox::fast {

bool stream_boxes(const float* positions, std::uint32_t count, Box* blocks, Box& body) {
    return VOX_SIMD_DISPATCH(StreamBoxes)(positions, count, blocks, body);
}

} // namespace vox::fast
#endif
