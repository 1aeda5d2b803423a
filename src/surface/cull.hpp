// Pairs whose boxes overlap, but that provably stay apart: by axes that separate them during the whole
// motion.
#pragma once

#include "surface/motion.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace vox {

// A frame in which single precision suffices for what is near a tile: coordinates are taken from a middle at
// either end of the motion, and scaled by a power of two, so that the tile's own are at most 1.
struct CullFrame {
    Vec3d middle[2];
    double scale;
};

// Positions of the corners of features at both ends of the motion, as floats in a frame: of each lane, for
// time 0, then 1: corner after corner x, y, z.
inline constexpr std::size_t cull_lanes = 64;
struct alignas(64) CullTile {
    float at[2][3][3][cull_lanes]; // time, corner, axis, lane
};
struct CullPartner {
    float at[2][3][3];
    float largest; // magnitude of a number, at least 1: that of the tile's
};

// Pairs of a lane of a tile and a partner.
struct CullPairs {
    const CullTile& tile;
    const CullPartner* partners;
    unsigned corners, partner_corners;
    float apart;                    // in the frame
    std::uint32_t *lanes, *partner; // of each pair
    std::size_t count;
};

// Keeps the pairs that are not proven to stay further than `apart` from each other, in their order, and
// returns their number.
std::size_t cull_some(const CullPairs& pairs);

// A quick first test. Of the given lanes, as bits, returns the faces that one axis does not prove to stay
// apart from a vertex.
std::uint32_t cull_across(const CullTile& tile, const CullPartner& vertex, std::uint32_t lanes);

// Around the whole motion; or along with the tile, which takes away the motion that others share with it.
CullFrame frame_around(const SurfaceMotion& motion, std::span<const std::uint32_t> vertices) noexcept;
CullFrame frame_along(const SurfaceMotion& motion, std::span<const std::uint32_t> vertices) noexcept;
// 2 * radius in the frame, rounded up.
float apart_in(const CullFrame& frame, const SurfaceMotion& motion) noexcept;
void set_lane(const CullFrame& frame, const SurfaceMotion& motion, std::span<const std::uint32_t> corners,
              std::size_t lane, CullTile& tile) noexcept;
CullPartner partner_in(const CullFrame& frame, const SurfaceMotion& motion,
                       std::span<const std::uint32_t> corners) noexcept;

} // namespace vox
