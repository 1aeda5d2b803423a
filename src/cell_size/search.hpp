// The cell size of least cost, for any cost function: used by the models of this library and by those of its
// users (vox_cost_minimise).
#pragma once

#include "cell_size/paper_model.hpp"

#include <functional>

namespace vox {

// Cost at a cell size > 0. What is not a finite number counts as infinitely dear.
using CostFunction = std::function<double(double cell_size)>;

struct CellSizeRange {
    double min, max; // 0 < min <= max, finite
};

struct CostMinimum {
    double cell_size;
    double cost; // infinite where the function is, throughout
};

// How closely a function is looked at: at so many places an octave, never fewer than some; then the place is
// found to within a part of it.
struct Fineness {
    double scans_per_octave = 5;
    int least_scans = 64;
    double tolerance = 1e-8;
};

// The least cost in the range, by a scan that is even in the logarithm of the cell size, and a golden-section
// search around its best place. The function may have several minima; those that lie between two places of
// the scan can be missed.
CostMinimum minimise(const CostFunction& cost, const CellSizeRange& range, const Fineness& fineness = {});

// The golden-section search alone: for a function with one minimum in the range, at a place inside it.
CostMinimum golden_section(const CostFunction& cost, const CellSizeRange& range, double tolerance);

// The interval around the minimum where the cost is at most `limit`, as far as the range goes.
Zone zone_around(const CostMinimum& minimum, double limit, const CostFunction& cost,
                 const CellSizeRange& range);

} // namespace vox
