// The exact location of many points in tetrahedra, a block at a time.
#pragma once

#include "exact/predicates.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace vox {

inline constexpr std::size_t point_block = 64;

// Points and the four corners of their tetrahedra, as a structure of arrays.
struct PointBlock {
    alignas(64) double point[3][point_block];
    alignas(64) double corner[4][3][point_block];
};

inline void set(double (&to)[3][point_block], std::size_t i, const Vec3d& at) noexcept {
    to[0][i] = at.x;
    to[1][i] = at.y;
    to[2][i] = at.z;
}

// Calls work(i, point, corners) for each bit i of the first `count`: what registers were not enough for.
template <class Work>
void for_uncertain(std::uint64_t uncertain, const PointBlock& block, std::size_t count, Work&& work) {
    for (uncertain &= ~std::uint64_t{0} >> (point_block - count); uncertain; uncertain &= uncertain - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(uncertain));
        const auto at = [i](const double(&of)[3][point_block]) {
            return Vec3d{of[0][i], of[1][i], of[2][i]};
        };
        const Vec3d corners[4] = {at(block.corner[0]), at(block.corner[1]), at(block.corner[2]),
                                  at(block.corner[3])};
        work(i, at(block.point), corners);
    }
}

// Repeats the first point, and that many of its corners, after the last of `count`.
inline void fill_last_register(PointBlock& block, std::size_t count, std::size_t corners = 4) noexcept {
    for (std::size_t i = count; i % 8; ++i)
        for (std::size_t a = 0; a < 3; ++a) {
            block.point[a][i] = block.point[a][0];
            for (std::size_t c = 0; c < corners; ++c) block.corner[c][a][i] = block.corner[c][a][0];
        }
}

// corner_volumes() of each point of a block, with the same bits.
struct VolumeBlock {
    alignas(64) double volume[4][point_block], error[4][point_block];

    std::array<BoundedVolume, 4> of(std::size_t i) const {
        return {{{volume[0][i], error[0][i]},
                 {volume[1][i], error[1][i]},
                 {volume[2][i], error[2][i]},
                 {volume[3][i], error[3][i]}}};
    }
};

// Where the points of a block are: a bit for each, as locate_in_solid() defines it. Points without a bit need
// exact arithmetic.
struct CertainLocations {
    std::uint64_t outside = 0, interior = 0, boundary = 0;
};

// Locates the first `count` points; results of others are unspecified. Reads and writes whole registers.
CertainLocations locate(const PointBlock& block, std::size_t count, VolumeBlock& volumes);

} // namespace vox
