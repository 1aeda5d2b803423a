// A cost function that is asked at many sizes, by its values at a few: the models are sums of powers of the
// cell size, smooth in logarithms.
#pragma once

#include "minimise.hpp"

#include <vector>

namespace vox {

class CostTable {
public:
    // Sizes from `range.min` on, two an octave. The function is called where somebody asks nearby, once for
    // each of them, and directly for sizes far outside the range.
    CostTable(const CostFunction& cost, const CellSizeRange& range);

    // Between the sizes the logarithm of the cost is a cubic.
    double operator()(double cell_size);

    // The least cost in the range; the cost is the function's own.
    CostMinimum minimum();

private:
    double size(int node) const noexcept;
    double value(int node); // logarithm of the cost there

    const CostFunction& cost_;
    CellSizeRange range_;
    int last_;                   // node in the range; the first is 0
    std::vector<double> values_; // from node -margin on; NaN: not asked yet
};

} // namespace vox
