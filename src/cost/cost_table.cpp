// Cubic interpolation with slopes from the neighbours (E. Catmull, R. Rom, A class of local interpolating
// splines, 1974).
#include "cost_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vox {

namespace {

constexpr double per_octave = 2;
// Nodes beyond either end of the range: a curve goes on for three octaves from the best size.
constexpr int margin = 8;
// Sizes further apart than any floats are.
constexpr double most_octaves = 512;
constexpr double near = 1e-3; // no model is as good as that

} // namespace

CostTable::CostTable(const CostFunction& cost, const CellSizeRange& range)
    : cost_(cost), range_(range),
      last_(static_cast<int>(per_octave * std::min(std::log2(range.max / range.min), most_octaves))),
      values_(static_cast<std::size_t>(last_ + 1 + 2 * margin), std::numeric_limits<double>::quiet_NaN()) {}

double CostTable::size(int node) const noexcept { return range_.min * std::exp2(node / per_octave); }

double CostTable::value(int node) {
    double& known = values_[static_cast<std::size_t>(node + margin)];
    if (!std::isnan(known)) return known;
    const double cost = cost_(size(node));
    return known = std::isfinite(cost) ? std::log2(cost) : std::numeric_limits<double>::infinity();
}

double CostTable::operator()(double cell_size) {
    const double place = std::log2(cell_size / range_.min) * per_octave, below = std::floor(place);
    if (!(below > -margin && below + 2 < last_ + margin)) return cost_(cell_size);
    const int node = static_cast<int>(below);
    const double p0 = value(node - 1), p1 = value(node), p2 = value(node + 1), p3 = value(node + 2);
    const double t = place - below;
    const double between =
        p1 + t / 2 * (p2 - p0 + t * (2 * p0 - 5 * p1 + 4 * p2 - p3 + t * (3 * (p1 - p2) + p3 - p0)));
    return std::isfinite(between) ? std::exp2(between) : cost_(cell_size);
}

CostMinimum CostTable::minimum() {
    int best = 0;
    for (int node = 1; node <= last_; ++node)
        if (value(node) < value(best)) best = node;
    const CellSizeRange around{best > 0 ? size(best - 1) : range_.min, std::min(size(best + 1), range_.max)};
    CostMinimum found{size(best), cost_(size(best))};
    const double between = golden_section([this](double d) { return (*this)(d); }, around, near).cell_size,
                 cost = cost_(between);
    if (cost < found.cost) found = {between, cost};
    return found;
}

} // namespace vox
