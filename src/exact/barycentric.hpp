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

// Weights of the first `count` points of a block, four a point; computes, and reads, whole registers of
// eight. Bit i of the result: those of point i are not certain, and unspecified.
std::uint64_t barycentric(const BarycentricBlock<float>& block, std::size_t count, float* weights);

using BarycentricWeights = std::array<std::array<float, 4>, barycentric_block>;

// Weights of the corners of the tetrahedra for the vertices of hits[first], hits[first + 1], ... as far as
// there are hits and the block has room; the same bits as barycentric() of predicates.hpp gives. `rounded`:
// some body's positions are (see Positions). `first` is below the number of hits; those after the block are
// looked at to prefetch what they need.
void barycentric(std::span<const Body> bodies, bool rounded, std::span<const Hit> hits, std::size_t first,
                 BarycentricWeights& weights);

} // namespace vox
