// Draws a suggestion: the predicted cost over the cell size, the zone, and the sizes that other rules choose.
#pragma once

#include <vox/vox.h>

#include <string>
#include <vector>

namespace tool {

// The text of an SVG file, which names the mesh files, for a suggestion where something collides.
std::string curve_svg(const vox_suggestion& suggestion, const std::vector<std::string>& files);

} // namespace tool
