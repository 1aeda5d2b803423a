// Draws the cost over the cell size, the zone, and the sizes that other rules choose.
#pragma once

#include <vox/vox_cell_size.h>

#include <string>
#include <vector>

namespace tool {

struct CurveWords {
    std::string title, below; // the second one says what costs
    std::string axis = "cost, in units of the least";
    double unit = 0; // of the numbers along that axis, in costs of the curve; 0: the least cost
};

// The text of an SVG file, with dots for the timings of the result.
std::string curve_svg(const vox_cell_size_result& found, const CurveWords& words);

// The names of up to three files without their folders.
std::string short_names(const std::vector<std::string>& files);

} // namespace tool
