// Cubic interpolation with slopes from the neighbours (E. Catmull, R. Rom, A class of local interpolating
// splines, 1974).
#include "cell_size/cost_table.hpp"

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
constexpr double near = 1e-4; // of a node to the next: no model is as good as that

} // namespace

CostTable::CostTable(const CostFunction& cost, const CellSizeRange& range, std::pmr::memory_resource* memory)
    : cost_(cost), range_(range), end_(per_octave * std::min(std::log2(range.max / range.min), most_octaves)),
      last_(static_cast<int>(end_)), values_(static_cast<std::size_t>(last_ + 1 + 2 * margin),
                                             std::numeric_limits<double>::quiet_NaN(), memory) {}

double CostTable::size(double place) const noexcept { return range_.min * std::exp2(place / per_octave); }

double CostTable::place(double cell_size) const noexcept {
    return std::log2(cell_size / range_.min) * per_octave;
}

double CostTable::value(int node) {
    double& known = values_[static_cast<std::size_t>(node + margin)];
    if (!std::isnan(known)) return known;
    const double cost = cost_(size(node));
    return known = std::isfinite(cost) ? std::log2(cost) : std::numeric_limits<double>::infinity();
}

double CostTable::cubic(double place) {
    const double below = std::floor(place);
    if (!(below > -margin && below + 2 < last_ + margin)) return std::numeric_limits<double>::quiet_NaN();
    const int node = static_cast<int>(below);
    const double p0 = value(node - 1), p1 = value(node), p2 = value(node + 1), p3 = value(node + 2);
    const double t = place - below;
    return p1 + t / 2 * (p2 - p0 + t * (2 * p0 - 5 * p1 + 4 * p2 - p3 + t * (3 * (p1 - p2) + p3 - p0)));
}

double CostTable::between(double place) {
    const double known = cubic(place);
    if (std::isfinite(known)) return known;
    const double cost = cost_(size(place));
    return std::isnan(cost) ? std::numeric_limits<double>::infinity() : std::log2(cost);
}

double CostTable::operator()(double cell_size) {
    const double known = cubic(place(cell_size));
    return std::isfinite(known) ? std::exp2(known) : cost_(cell_size);
}

// Cubics are cheap to ask: by halving steps.
CostMinimum CostTable::minimum() {
    int best = 0;
    for (int node = 1; node <= last_; ++node)
        if (value(node) < value(best)) best = node;
    CostMinimum found{size(best), cost_(size(best))};
    double at = best, least = value(best);
    for (double step = 0.5; step > near; step /= 2)
        for (const double next : {at - step, at + step}) {
            if (next < 0 || next > end_ || !(between(next) < least)) continue;
            least = between(at = next);
            break;
        }
    const double cost = cost_(size(at));
    if (cost < found.cost) found = {size(at), cost};
    return found;
}

Zone CostTable::zone(const CostMinimum& minimum, double limit) {
    if (!(limit > minimum.cost)) return {minimum.cell_size, minimum.cell_size};
    const double most = std::log2(limit), middle = place(minimum.cell_size);
    // Out from the minimum by small steps, then by halving.
    const auto end = [&](double step, double last) {
        double inside = middle;
        while (inside != last) {
            double outside = step < 0 ? std::max(inside + step, last) : std::min(inside + step, last);
            if (between(outside) <= most) {
                inside = outside;
                continue;
            }
            while (std::abs(outside - inside) > near) {
                const double half = (inside + outside) / 2;
                (between(half) <= most ? inside : outside) = half;
            }
            break;
        }
        return inside;
    };
    const double low = end(-0.25, 0), high = end(0.25, end_);
    return {low == middle ? minimum.cell_size : size(low), high == end_ ? range_.max : size(high)};
}

void CostTable::sample(double first, double octaves, std::span<vox_cost_sample> out) {
    const double last = static_cast<double>(out.size() - 1), from = place(first);
    const double ratio = std::exp2(octaves / last), step = per_octave * octaves / last;
    double cell_size = first;
    for (std::size_t i = 0; i < out.size(); ++i, cell_size *= ratio)
        out[i] = {cell_size, std::exp2(between(from + step * static_cast<double>(i)))};
}

} // namespace vox
