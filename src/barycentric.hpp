// Barycentric coordinates of many hits, a block at a time.
#pragma once

#include "scene.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace vox {

inline constexpr std::size_t barycentric_block = 64;

using BarycentricWeights = std::array<std::array<float, 4>, barycentric_block>;

// Weights of the corners of the tetrahedra for the vertices of hits[first], hits[first + 1], ... as far as
// there are hits and the block has room; the same bits as barycentric() of predicates.hpp gives. `rounded`:
// some body's positions are (see Positions). `first` is below the number of hits; those after the block are
// looked at to prefetch what they need.
void barycentric(std::span<const Body> bodies, bool rounded, std::span<const Hit> hits, std::size_t first,
                 BarycentricWeights& weights);

} // namespace vox
