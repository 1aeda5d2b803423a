// The cell size of the grid of tiles, by the model of any grid that holds boxes and is asked by boxes
// (cell_size/foreign), with weights of its own.
#pragma once

#include "cell_size/scene.hpp"
#include "surface/feature_tiles.hpp"

#include <vox/vox_cell_size.h>

#include <memory_resource>

namespace vox {

// Both kinds have tiles, with boxes. Sets all fields but struct_size.
vox_cell_size_result suggest_for_tiles(const FeatureTiles& a, const FeatureTiles& b,
                                       std::pmr::memory_resource* memory);

// VOX_COST_MODEL_SURFACE: suggests a cell size for the surfaces of all bodies as one, asked for pairs of
// edges, and of faces and vertices. Throws INVALID_ARGUMENT where there is none, or all of it is in one
// place.
vox_cell_size_result suggest_for_surfaces(const vox_cell_size_desc& desc, CellSizeScene& scene);

} // namespace vox
