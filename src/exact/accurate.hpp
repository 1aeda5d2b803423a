// Weights and places on segments, rounded from twice the digits of a double. What these do not suffice for is
// left to exact integers, so that the results are those of any other arithmetic that rounds once.
#pragma once

#include "exact/point_location.hpp"
#include "exact/predicates.hpp"

#include <cstddef>
#include <cstdint>

namespace vox {

struct AccurateWeights {
    alignas(64) double weight[4][point_block];
};

// The barycentric coordinates of the first `count` points in tetrahedra of non-zero volume, each the double
// nearest to the true one, or off by 2^-58 of the largest more. `clamped`: for points in their closed
// tetrahedra, whose weights are in [0, 1]. Reads and writes whole registers.
void weigh_accurately(const PointBlock& block, std::size_t count, bool clamped, AccurateWeights& out);

// The weights of corners 0, 1 and 2 for the points of the triangles that they form that are closest to the
// first `count` points, rounded likewise; they are not negative. Returns a bit for each triangle that is too
// thin, too small or too far away for this: its weights are unspecified.
std::uint64_t weigh_closest(const PointBlock& block, std::size_t count, AccurateWeights& out);

struct Crossings {
    alignas(64) double t[point_block];
};

// Where the segment from point to corner 3 crosses the plane of corners 0, 1 and 2, from 0 at its beginning
// to 1 at its end: the double nearest to the true place, always. The ends are on opposite sides of the plane,
// or one of them on it.
void cross_planes(const PointBlock& block, std::size_t count, Crossings& out);

} // namespace vox
