// Draws a suggestion: the predicted cost over the cell size, the zone, and the sizes that other rules choose.
#pragma once

#include <vox/vox.h>

#include <string>

namespace tool {

// The text of an SVG file.
std::string curve_svg(const vox_suggestion& suggestion);

} // namespace tool
