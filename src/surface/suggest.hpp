// The cell size of the grid of tiles, by the model of any grid that holds boxes and is asked by boxes
// (cell_size/foreign), with weights of its own.
#pragma once

#include "surface/feature_tiles.hpp"

#include <vox/vox.h>

#include <memory_resource>

namespace vox {

// Both kinds have tiles, with boxes. Sets all fields but struct_size.
vox_foreign_suggestion suggest_for_tiles(const FeatureTiles& a, const FeatureTiles& b,
                                         std::pmr::memory_resource* memory);

} // namespace vox
