// Golden-section search (J. Kiefer, Sequential minimax search for a maximum, Proc. AMS 4, 1953), in the
// logarithm of the cell size: costs are sums of powers of it.
#include "minimise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vox {

namespace {

// Places of the scan: so many an octave, and never fewer than these.
constexpr double scans_per_octave = 5;
constexpr int least_scans = 64, most_scans = 4096;

double finite_cost(const CostFunction& cost, double cell_size) {
    const double value = cost(cell_size);
    return std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
}

} // namespace

CostMinimum minimise(const CostFunction& cost, const CellSizeRange& range) {
    const double low = std::log(range.min), high = std::log(range.max);
    const int scan_count = static_cast<int>(
        std::clamp((high - low) * scans_per_octave / std::log(2.0), double{least_scans}, double{most_scans}));
    const auto at = [&](int i) {
        return i == 0                ? range.min
               : i == scan_count - 1 ? range.max
                                     : std::exp(low + (high - low) * i / (scan_count - 1));
    };
    CostMinimum best{range.min, std::numeric_limits<double>::infinity()};
    const auto consider = [&](double cell_size) {
        const double c = finite_cost(cost, cell_size);
        if (c < best.cost) best = {cell_size, c};
        return c;
    };
    int place = 0;
    for (int i = 0; i < scan_count; ++i) {
        const double before = best.cost;
        if (consider(at(i)) < before) place = i;
    }
    const double golden = (std::sqrt(5.0) - 1) / 2;
    double a = std::log(at(place > 0 ? place - 1 : 0));
    double b = std::log(at(place < scan_count - 1 ? place + 1 : scan_count - 1));
    double left = b - golden * (b - a), right = a + golden * (b - a);
    double cost_left = consider(std::exp(left)), cost_right = consider(std::exp(right));
    // Nearer to a minimum than the root of the precision, a function is flat as computed.
    while (b - a > 1e-8) {
        if (cost_left <= cost_right) {
            b = right;
            right = left;
            cost_right = cost_left;
            left = b - golden * (b - a);
            cost_left = consider(std::exp(left));
        } else {
            a = left;
            left = right;
            cost_left = cost_right;
            right = a + golden * (b - a);
            cost_right = consider(std::exp(right));
        }
    }
    return best;
}

Zone zone_around(const CostMinimum& minimum, double limit, const CostFunction& cost,
                 const CellSizeRange& range) {
    // Out from the minimum by small steps, then to the last bits by halving.
    const auto end = [&](double factor, double last) {
        double inside = minimum.cell_size;
        while (inside != last) {
            double outside = inside * factor;
            if (factor < 1 ? outside < last : outside > last) outside = last;
            if (finite_cost(cost, outside) <= limit) {
                inside = outside;
                continue;
            }
            for (;;) {
                const double middle = inside + (outside - inside) / 2;
                if (middle == inside || middle == outside) return inside;
                (finite_cost(cost, middle) <= limit ? inside : outside) = middle;
            }
        }
        return inside;
    };
    if (!(limit > minimum.cost)) return {minimum.cell_size, minimum.cell_size};
    return {end(1 / 1.05, range.min), end(1.05, range.max)};
}

} // namespace vox
