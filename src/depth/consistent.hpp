// Consistent penetration depths of the colliding vertices of one body in another.
#pragma once

#include "depth/normals.hpp"
#include "depth/points.hpp"

#include <cstdint>
#include <span>

namespace vox::depth {

// Sets the states of `points`, and depth and direction of all that do not end as ENCLOSED or CROSSING.
// `number` has a zero for each vertex of body a, before and after the call. `queue` is as long as `points`.
void find_consistent_depths(const BodyPair& pair, std::span<Point> points, std::span<std::uint32_t> number,
                            std::span<std::uint32_t> queue, Normals& normals, Counts& counts);

} // namespace vox::depth
