// Draws the cost over the cell size, the zone, and the sizes that other rules choose.
#pragma once

#include <vox/vox_cell_size.h>

#include <string>
#include <vector>

namespace tool {

// The text of an SVG file. `words` say what costs.
std::string curve_svg(const vox_cell_size_result& found, const std::string& words);

// The names of up to three files without their folders.
std::string short_names(const std::vector<std::string>& files);

} // namespace tool
