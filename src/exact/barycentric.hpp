// Barycentric coordinates of many hits, and the exact location of many points, a block at a time.
#pragma once

#include "base/scene.hpp"
#include "exact/predicates.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace vox {

inline constexpr std::size_t barycentric_block = 64;

// Points and the four corners of their tetrahedra, as a structure of arrays.
template <class Coordinate>
struct BarycentricBlock {
    alignas(64) Coordinate point[3][barycentric_block];
    alignas(64) Coordinate corner[4][3][barycentric_block];
};

// Computes the weights of the first `count` points of a block, four a point. Reads and writes whole registers
// of eight points. Bit i of the result is set when the weights of point i are uncertain; they are unspecified
// then.
std::uint64_t barycentric(const BarycentricBlock<float>& block, std::size_t count, float* weights);
std::uint64_t barycentric(const BarycentricBlock<double>& block, std::size_t count, float* weights);

// corner_volumes() of each point of a block, with the same bits.
struct VolumeBlock {
    alignas(64) double volume[4][barycentric_block], error[4][barycentric_block];

    std::array<BoundedVolume, 4> of(std::size_t i) const {
        return {{{volume[0][i], error[0][i]},
                 {volume[1][i], error[1][i]},
                 {volume[2][i], error[2][i]},
                 {volume[3][i], error[3][i]}}};
    }
};

// Where points of a block are, a bit for each, with the meaning of locate_in_solid(). Points without a bit
// need exact arithmetic.
struct CertainLocations {
    std::uint64_t outside = 0, interior = 0, boundary = 0;
};

// For the first `count` points; what there is of others is unspecified. Reads and writes whole registers.
CertainLocations locate(const BarycentricBlock<double>& block, std::size_t count, VolumeBlock& volumes);

using BarycentricWeights = std::array<std::array<float, 4>, barycentric_block>;

// Computes the weights of hits[first], hits[first + 1], ... until the hits end or the block is full, with the
// same bits as barycentric() of predicates.hpp. `rounded` says whether any body has rounded positions
// (Positions::rounded). `first` is below the number of hits. Hits after the block are read too, to prefetch
// what they will need.
void barycentric(std::span<const Body> bodies, bool rounded, std::span<const Hit> hits, std::size_t first,
                 BarycentricWeights& weights);

} // namespace vox
