// Saves grids to snapshot files and loads them.
#pragma once

#include "grid.hpp"
#include "results_file.hpp"

#include <string>
#include <vector>

namespace tool {

// Throws Failure, naming the file, if it cannot be written completely.
void save_snapshot(const vox_grid* grid, const std::string& path);

// A snapshot's bytes and the grid that they make.
struct Snapshot {
    std::vector<unsigned char> bytes;
    Grid grid;
};

// Throws Failure, naming the file, if it cannot be read or is not a valid snapshot. `machine` is the desc of
// vox_grid_load.
Snapshot load_snapshot(const std::string& path, const vox_grid_desc& machine);

// The meshes of a snapshot that vox_grid_load has accepted, by id, at their present positions and without the
// tetrahedra that are off. Skips disabled meshes and meshes without positions.
std::vector<DrawnMesh> drawn_meshes(const std::vector<unsigned char>& bytes);

} // namespace tool
