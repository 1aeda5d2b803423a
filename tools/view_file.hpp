// The results of a step as a page: bodies and contacts to look at in a browser.
#pragma once

#include "results_file.hpp"

namespace tool {

// Writes one HTML file that needs nothing else: the surfaces of the meshes, and each contact with its depth.
// Throws Failure.
void write_view(const std::string& path, std::span<const DrawnMesh> meshes, const vox_grid* grid);

} // namespace tool
