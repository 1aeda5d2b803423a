// The cell size of least cost, for any cost function: used by the models of this library and by those of its
// users (vox_cost_minimise).
#pragma once

#include "paper_cost.hpp"

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

// The least cost in the range, by a scan that is even in the logarithm of the cell size, and a golden-section
// search around its best place. The function may have several minima; those that lie between two places of
// the scan can be missed. The place is found to within this part of it.
CostMinimum minimise(const CostFunction& cost, const CellSizeRange& range, double tolerance = 1e-8);

// The golden-section search alone: for a function with one minimum in the range, at a place inside it.
CostMinimum golden_section(const CostFunction& cost, const CellSizeRange& range, double tolerance);

// The interval around the minimum where the cost is at most `limit`, as far as the range goes.
Zone zone_around(const CostMinimum& minimum, double limit, const CostFunction& cost,
                 const CellSizeRange& range);

} // namespace vox
