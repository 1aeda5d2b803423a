// Golden-section search (J. Kiefer, Sequential minimax search for a maximum, Proc. AMS 4, 1953), in the
// logarithm of the cell size: costs are sums of powers of it.
#include "cell_size/search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vox {

namespace {

constexpr int most_scans = 4096;

double finite_cost(const CostFunction& cost, double cell_size) {
    const double value = cost(cell_size);
    return std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
}

// Where the cost passes the limit between a size inside, where it is not above it, and one outside.
double crossing(const CostFunction& cost, double limit, double inside, double outside) {
    constexpr double near = 1e-10; // of the limit
    double below = finite_cost(cost, inside) - limit, above = finite_cost(cost, outside) - limit;
    int kept = 0; // how often the same end was, one after the other: negative the inner one
    for (int i = 0; i < 200; ++i) {
        double at = inside + (outside - inside) / 2;
        if (std::isfinite(above) && i < 60) at = inside + (outside - inside) * (below / (below - above));
        if (at == inside || at == outside) break;
        const double excess = finite_cost(cost, at) - limit;
        if (excess <= 0) {
            inside = at;
            below = excess;
            if (-excess <= near * limit) break;
            if (kept++ > 0) above /= 2;
            kept = std::max(kept, 1);
        } else {
            outside = at;
            above = excess;
            if (kept-- < 0) below /= 2;
            kept = std::min(kept, -1);
        }
    }
    return inside;
}

} // namespace

CostMinimum golden_section(const CostFunction& cost, const CellSizeRange& range, double tolerance) {
    const double golden = (std::sqrt(5.0) - 1) / 2;
    CostMinimum best{range.min, std::numeric_limits<double>::infinity()};
    const auto consider = [&](double logarithm) {
        const double cell_size = std::exp(logarithm), c = finite_cost(cost, cell_size);
        if (c < best.cost) best = {cell_size, c};
        return c;
    };
    double a = std::log(range.min), b = std::log(range.max);
    double left = b - golden * (b - a), right = a + golden * (b - a);
    double cost_left = consider(left), cost_right = consider(right);
    // Nearer to a minimum than the root of the precision, a function is flat as computed.
    while (b - a > std::max(tolerance, 1e-8)) {
        if (cost_left <= cost_right) {
            b = right;
            right = left;
            cost_right = cost_left;
            left = b - golden * (b - a);
            cost_left = consider(left);
        } else {
            a = left;
            left = right;
            cost_left = cost_right;
            right = a + golden * (b - a);
            cost_right = consider(right);
        }
    }
    return best;
}

CostMinimum minimise(const CostFunction& cost, const CellSizeRange& range, const Fineness& fineness) {
    const double low = std::log(range.min), high = std::log(range.max);
    const int scan_count =
        static_cast<int>(std::clamp((high - low) * fineness.scans_per_octave / std::log(2.0),
                                    double(fineness.least_scans), double{most_scans}));
    const auto at = [&](int i) {
        return i == 0                ? range.min
               : i == scan_count - 1 ? range.max
                                     : std::exp(low + (high - low) * i / (scan_count - 1));
    };
    CostMinimum best{range.min, std::numeric_limits<double>::infinity()};
    int place = 0;
    for (int i = 0; i < scan_count; ++i) {
        const double c = finite_cost(cost, at(i));
        if (!(c < best.cost)) continue;
        best = {at(i), c};
        place = i;
    }
    const CostMinimum found = golden_section(
        cost, {at(place > 0 ? place - 1 : 0), at(std::min(place + 1, scan_count - 1))}, fineness.tolerance);
    return found.cost < best.cost ? found : best;
}

Zone zone_around(const CostMinimum& minimum, double limit, const CostFunction& cost,
                 const CellSizeRange& range) {
    // Out from the minimum by small steps, then regula falsi (the Illinois variant: M. Dowell, P. Jarratt,
    // BIT 11, 1971) until that is as near as matters.
    const auto end = [&](double factor, double last) {
        double inside = minimum.cell_size;
        while (inside != last) {
            double outside = inside * factor;
            if (factor < 1 ? outside < last : outside > last) outside = last;
            if (finite_cost(cost, outside) <= limit) {
                inside = outside;
                continue;
            }
            return crossing(cost, limit, inside, outside);
        }
        return inside;
    };
    if (!(limit > minimum.cost)) return {minimum.cell_size, minimum.cell_size};
    return {end(1 / 1.05, range.min), end(1.05, range.max)};
}

} // namespace vox
