// Snapshots of grids in files.
#pragma once

#include "stepping.hpp"

#include <string>

namespace tool {

// Throws Failure, naming the file, when it cannot be written whole.
void save_snapshot(const vox_grid* grid, const std::string& path);

// Throws Failure, naming the file, when it cannot be read or is no sound snapshot. `machine` as in
// vox_grid_load.
Grid load_snapshot(const std::string& path, const vox_grid_desc& machine);

} // namespace tool
