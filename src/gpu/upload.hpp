// The meshes of some grids as arrays for a device: bodies, tiles and tetrahedra. Meshes with the same
// tetrahedra share these.
#pragma once

#include "gpu/scene.hpp"

#include <span>
#include <vector>

namespace vox::gpu {

struct SceneData {
    u32 vertex_count = 0;
    bool any_filter = false;
    std::vector<BodyOfScene> bodies; // those of scene i are [first_body[i], first_body[i + 1])
    std::vector<u32> first_body;
    std::vector<CellsOfBody> cells;
    std::vector<u32> vertex_body;
    std::vector<TileOfBody> tiles;
    std::vector<u32> tile_vertices, tile_tets, corners;
    std::vector<Tet> tets;
};

// Grid i is scene i. `cell_size` 0: chosen for each scene. Throws Error: UNSUPPORTED for what the kernels do
// not know, INVALID_STATE for a mesh without positions, of which tiles and cells are made.
SceneData read_grids(std::span<const vox_grid* const> grids, double cell_size);

} // namespace vox::gpu
