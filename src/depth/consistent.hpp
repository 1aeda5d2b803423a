// Consistent penetration depth of the colliding vertices of one body in another.
#pragma once

#include "depth/normals.hpp"
#include "depth/points.hpp"

#include <cstdint>
#include <span>

namespace vox::depth {

// Sets states, depths and directions of `points`, but for depth and direction of those that are left ENCLOSED
// or CROSSING. `number` has a zero for each vertex of body a, before and after; `queue` is as long as
// `points`.
void find_consistent_depths(const BodyPair& pair, std::span<Point> points, std::span<std::uint32_t> number,
                            std::span<std::uint32_t> queue, Normals& normals, Counts& counts);

} // namespace vox::depth
