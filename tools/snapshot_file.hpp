// Saves grids to snapshot files and loads them.
#pragma once

#include "stepping.hpp"

#include <string>

namespace tool {

// Throws Failure, naming the file, if it cannot be written completely.
void save_snapshot(const vox_grid* grid, const std::string& path);

// Throws Failure, naming the file, if it cannot be read or is not a valid snapshot. `machine` is the desc of
// vox_grid_load.
Grid load_snapshot(const std::string& path, const vox_grid_desc& machine);

} // namespace tool
