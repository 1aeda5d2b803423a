// Golden-section search (J. Kiefer, Sequential minimax search for a maximum, Proc. AMS 4, 1953) in the
// logarithm of the cell size, since costs are sums of powers of it. Ends of the zone by regula falsi (the Illinois
// variant: M. Dowell, P. Jarratt, BIT 11, 1971). Cubics with slopes from the neighbours (E. Catmull, R. Rom, A
// class of local interpolating splines, 1974).
#include "cell_size/search.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vox {

namespace {

constexpr int most_scans = 4096;
constexpr double infinity = std::numeric_limits<double>::infinity();

double finite_cost(const CostFunction& cost, double cell_size) {
    const double value = cost(cell_size);
    return std::isfinite(value) ? value : infinity;
}

// Where the cost passes the limit between a size inside, where it is not above it, and one outside.
double crossing(const CostFunction& cost, double limit, double inside, double outside) {
    constexpr double near = 1e-12; // of the limit
    double below = finite_cost(cost, inside) - limit, above = finite_cost(cost, outside) - limit;
    int kept = 0; // how many times in a row the same end was kept: negative for the inner one
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

// For a function with one minimum in the range.
CostMinimum golden_section(const CostFunction& cost, const CellSizeRange& range, double tolerance) {
    const double golden = (std::sqrt(5.0) - 1) / 2;
    CostMinimum best{range.min, infinity};
    const auto consider = [&](double logarithm) {
        const double cell_size = std::exp(logarithm), c = finite_cost(cost, cell_size);
        if (c < best.cost) best = {cell_size, c};
        return c;
    };
    double a = std::log(range.min), b = std::log(range.max);
    double left = b - golden * (b - a), right = a + golden * (b - a);
    double cost_left = consider(left), cost_right = consider(right);
    // Closer to a minimum than the square root of the precision, rounding makes any function flat.
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

} // namespace

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
    CostMinimum best{range.min, infinity};
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

CellSizeRange zone_around(const CostMinimum& minimum, double limit, const CostFunction& cost,
                          const CellSizeRange& range, const Fineness& fineness) {
    // Steps away from the minimum until the cost is above the limit.
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
    const double step = std::exp2(1 / fineness.scans_per_octave);
    return {end(1 / step, range.min), end(step, range.max)};
}

void draw_curve(const CostFunction& cost, const CellSizeRange& range,
                vox_cost_sample (&curve)[VOX_COST_CURVE_CAPACITY], std::uint32_t& count) {
    count = VOX_COST_CURVE_CAPACITY;
    const double ratio = std::pow(range.max / range.min, 1.0 / (VOX_COST_CURVE_CAPACITY - 1));
    double at = range.min;
    for (std::uint32_t i = 0; i + 1 < count; ++i, at *= ratio) curve[i] = {at, cost(at)};
    curve[count - 1] = {range.max, cost(range.max)};
}

// ---- table ----------------------------------------------------------------------------------------

namespace {

constexpr double per_octave = 2;
// Nodes beyond either end of the range: a curve goes on for three octaves from the best size.
constexpr int margin = 8;
// Sizes further apart than any floats are.
constexpr double most_octaves = 512;

} // namespace

CostTable::CostTable(const CostFunction& cost, const CellSizeRange& range, std::pmr::memory_resource* memory)
    : cost_(cost), min_(range.min),
      last_(static_cast<int>(per_octave * std::min(std::log2(range.max / range.min), most_octaves))),
      values_(static_cast<std::size_t>(last_ + 1 + 2 * margin), std::numeric_limits<double>::quiet_NaN(),
              memory) {}

double CostTable::value(int node) {
    double& known = values_[static_cast<std::size_t>(node + margin)];
    if (!std::isnan(known)) return known;
    const double cost = cost_(min_ * std::exp2(node / per_octave));
    return known = std::isfinite(cost) ? std::log2(cost) : infinity;
}

double CostTable::operator()(double cell_size) {
    const double place = std::log2(cell_size / min_) * per_octave;
    if (!(place >= 1 - margin && place < last_ + margin - 2)) return cost_(cell_size);
    const int node = static_cast<int>(place + margin) - margin; // rounded down
    const double p0 = value(node - 1), p1 = value(node), p2 = value(node + 1), p3 = value(node + 2);
    const double t = place - node;
    const double cubic =
        p1 + t / 2 * (p2 - p0 + t * (2 * p0 - 5 * p1 + 4 * p2 - p3 + t * (3 * (p1 - p2) + p3 - p0)));
    return std::isfinite(cubic) ? std::exp2(cubic) : cost_(cell_size);
}

// ---- cost functions of users ------------------------------------------------------------------------

vox_cost_bounds cost_bounds_defaults() {
    vox_cost_bounds bounds{};
    bounds.struct_size = sizeof bounds;
    bounds.zone_loss = 0.05;
    return bounds;
}

vox_cost_minimum minimise_within(const CostFunction& cost, const vox_cost_bounds& bounds) {
    if (!(bounds.min > 0 && bounds.min <= bounds.max && std::isfinite(bounds.max)))
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("bounds are %g to %g, expected 0 < min <= max", bounds.min, bounds.max));
    if (!(bounds.zone_loss >= 0 && bounds.zone_loss <= 1e6))
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("bounds zone_loss is %g, expected a number from 0 to 1e6", bounds.zone_loss));
    if (bounds.reserved != 0)
        throw Error(VOX_ERROR_INVALID_ARGUMENT, format("bounds reserved is %u, expected 0", bounds.reserved));
    const CellSizeRange range{bounds.min, bounds.max};
    const CostMinimum best = minimise(cost, range);
    if (!std::isfinite(best.cost))
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("no finite cost for a cell size from %g to %g", bounds.min, bounds.max));
    if (best.cost < 0)
        throw Error(
            VOX_ERROR_INVALID_ARGUMENT,
            format("the cost is %g at cell size %g, expected none below 0", best.cost, best.cell_size));
    const CellSizeRange zone = zone_around(best, (1 + bounds.zone_loss) * best.cost, cost, range);
    vox_cost_minimum result{};
    result.cell_size = best.cell_size;
    result.cost = best.cost;
    result.zone_min = zone.min;
    result.zone_max = zone.max;
    draw_curve(cost, range, result.curve, result.curve_count);
    return result;
}

} // namespace vox
