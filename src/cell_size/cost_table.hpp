// A cost function that is asked at many sizes, by its values at a few: the models are sums of powers of the
// cell size, smooth in logarithms.
#pragma once

#include "cell_size/search.hpp"

#include <vox/vox.h>

#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

class CostTable {
public:
    // Sizes from `range.min` on, two an octave. The function is called where somebody asks nearby, once for
    // each of them, and directly for sizes far outside the range.
    CostTable(const CostFunction& cost, const CellSizeRange& range, std::pmr::memory_resource* memory);

    // Between the sizes the logarithm of the cost is a cubic.
    double operator()(double cell_size);

    // The least cost in the range; the cost is the function's own.
    CostMinimum minimum();
    // Around it, as zone_around().
    Zone zone(const CostMinimum& minimum, double limit);
    // Costs at sizes from `first` on that are spread evenly over so many octaves.
    void sample(double first, double octaves, std::span<vox_cost_sample> out);

private:
    double size(double place) const noexcept; // places are numbers of nodes, and numbers between them
    double place(double cell_size) const noexcept;
    double value(int node);       // logarithm of the cost there
    double cubic(double place);   // the same; not finite where that of the nodes around it is not
    double between(double place); // the same, always

    const CostFunction& cost_;
    CellSizeRange range_;
    double end_;                      // place of the end of the range; it begins at 0
    int last_;                        // node in the range; the first is 0
    std::pmr::vector<double> values_; // from node -margin on; NaN: not asked yet
};

} // namespace vox
