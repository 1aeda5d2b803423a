// Edges of a surface through its faces, exactly (exact/crossing.hpp).
#pragma once

#include "base/array.hpp"
#include "base/parallel.hpp"
#include "surface/pairs.hpp"
#include "surface/topology.hpp"

#include <vox/vox_surface.h>

#include <memory_resource>
#include <span>

namespace vox {

// Appends those of the edges that `pairs` has faces for, by edge, then face. `positions` are those of the
// vertices. Throws what the memory throws.
void find_crossings(const SurfaceTopology& topology, std::span<const Vec3d> positions,
                    const FeaturePairs& pairs, Workers& workers, Array<vox_crossing>& out);

} // namespace vox
