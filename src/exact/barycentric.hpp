// Barycentric coordinates of many hits, a block at a time.
#pragma once

#include "base/scene.hpp"

#include <array>
#include <cstddef>
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

using BarycentricWeights = std::array<std::array<float, 4>, barycentric_block>;

// Computes the weights of hits[first], hits[first + 1], ... until the hits end or the block is full, with the
// same bits as barycentric() of predicates.hpp. `rounded` says whether any body has rounded positions
// (Positions::rounded). `first` is below the number of hits. Hits after the block are read too, to prefetch
// what they will need.
void barycentric(std::span<const Body> bodies, bool rounded, std::span<const Hit> hits, std::size_t first,
                 BarycentricWeights& weights);

} // namespace vox
