// Draws a curve of costs: the cost over the cell size, the zone, and the sizes that other rules choose.
#pragma once

#include <vox/vox_cell_size.h>

#include <span>
#include <string>
#include <vector>

namespace tool {

// A cell size, and what it was chosen from.
struct CostCurve {
    std::span<const vox_cost_sample> samples; // evenly spaced in the logarithm
    double cell_size, cost;
    double zone_min, zone_max;

    struct Rule {
        const char* name;
        double cell_size, cost; // 0: it does not apply
    };
    std::vector<Rule> rules;
};

CostCurve curve_of(const vox_suggestion& suggestion);

// The text of an SVG file. `words` say what the costs are of.
std::string curve_svg(const CostCurve& curve, const std::string& words);

// The names of up to three files without their folders.
std::string short_names(const std::vector<std::string>& files);

} // namespace tool
