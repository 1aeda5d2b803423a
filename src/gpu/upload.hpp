// The meshes of grids for a device.
#pragma once

#include "gpu/scene_data.hpp"

#include <span>

namespace vox::gpu {

// Grid i is scene i. Throws Error: UNSUPPORTED for what the kernels do not know, INVALID_STATE for a mesh
// without positions, LIMIT.
SceneData read_grids(std::span<const vox_grid* const> grids, double cell_size);

} // namespace vox::gpu
