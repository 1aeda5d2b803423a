// Golden-section search (J. Kiefer, Sequential minimax search for a maximum, Proc. AMS 4, 1953). Ends of the
// zone by regula falsi (the Illinois variant: M. Dowell, P. Jarratt, BIT 11, 1971). Places are binary
// logarithms of cell sizes.
#include "cell_size/search.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <utility>

namespace vox {

namespace {

constexpr int most_scans = 4096;
constexpr double infinity = std::numeric_limits<double>::infinity();

double finite_cost(const CostFunction& cost, double place) {
    const double value = cost(place);
    return std::isfinite(value) ? value : infinity;
}

double size_at(double place, const CellSizeRange& range) {
    return place <= std::log2(range.min)   ? range.min
           : place >= std::log2(range.max) ? range.max
                                           : std::exp2(place);
}

// Where the cost passes the limit between a place inside, where it is not above it, and one outside.
double crossing(const CostFunction& cost, double limit, double inside, double outside, double near) {
    double below = finite_cost(cost, inside) - limit, above = finite_cost(cost, outside) - limit;
    int kept = 0; // how many times in a row the same end was kept: negative for the inner one
    for (int i = 0; i < 200; ++i) {
        const double middle = inside + (outside - inside) / 2;
        if (middle == inside || middle == outside) break;
        double at = inside + (outside - inside) * (below / (below - above));
        if (!(i < 60 && at != inside && at != outside)) at = middle; // also where `above` is infinite
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

// The least cost and its place, of a function with one minimum from a to b.
std::pair<double, double> golden_section(const CostFunction& cost, double a, double b, double tolerance) {
    const double golden = (std::sqrt(5.0) - 1) / 2;
    std::pair<double, double> best{infinity, a};
    const auto consider = [&](double place) {
        const double c = finite_cost(cost, place);
        if (c < best.first) best = {c, place};
        return c;
    };
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

vox_cost_sample minimise(const CostFunction& cost, const CellSizeRange& range, const Fineness& fineness) {
    const double low = std::log2(range.min), high = std::log2(range.max);
    const int scans = static_cast<int>(std::clamp((high - low) * fineness.scans_per_octave,
                                                  double(fineness.least_scans), double{most_scans}));
    const auto place = [&](int i) { return i == scans - 1 ? high : low + (high - low) * i / (scans - 1); };
    std::pair<double, int> best{infinity, 0};
    for (int i = 0; i < scans; ++i) best = std::min(best, {finite_cost(cost, place(i)), i});
    const auto found = golden_section(cost, place(std::max(best.second - 1, 0)),
                                      place(std::min(best.second + 1, scans - 1)), fineness.tolerance);
    if (found.first < best.first) return {size_at(found.second, range), found.first};
    return {size_at(place(best.second), range), best.first};
}

CellSizeRange zone_around(const vox_cost_sample& minimum, double limit, const CostFunction& cost,
                          const CellSizeRange& range, const Fineness& fineness) {
    // Steps away from the minimum until the cost is above the limit.
    const auto end = [&](double step, double last) {
        double inside = std::log2(minimum.cell_size);
        while (inside != last) {
            double outside = inside + step;
            if (step < 0 ? outside < last : outside > last) outside = last;
            if (finite_cost(cost, outside) > limit)
                return size_at(crossing(cost, limit, inside, outside, fineness.zone_tolerance), range);
            inside = outside;
        }
        return size_at(inside, range);
    };
    if (!(limit > minimum.cost)) return {minimum.cell_size, minimum.cell_size};
    const double step = 1 / fineness.scans_per_octave;
    return {std::min(end(-step, std::log2(range.min)), minimum.cell_size),
            std::max(end(step, std::log2(range.max)), minimum.cell_size)};
}

void draw_curve(const CostFunction& cost, const CellSizeRange& range,
                vox_cost_sample (&curve)[VOX_CURVE_CAPACITY], std::uint32_t& count) {
    count = VOX_CURVE_CAPACITY;
    const double low = std::log2(range.min), high = std::log2(range.max);
    curve[0] = {range.min, cost(low)};
    for (std::uint32_t i = 1; i + 1 < count; ++i) {
        const double place = low + (high - low) * i / (count - 1);
        curve[i] = {std::exp2(place), cost(place)};
    }
    curve[count - 1] = {range.max, cost(high)};
}

void write_terms(const CostTerms& terms, double scale, vox_cell_size_result& result) noexcept {
    result.term_count = 0;
    for (const vox_cost_term& term : terms)
        result.terms[result.term_count++] = {term.name, term.count, scale * term.cost};
}

void add_warning(vox_cell_size_result& result, vox_cell_size_warnings warning,
                 const std::string& text) noexcept {
    result.warnings |= static_cast<std::uint32_t>(warning);
    const std::size_t used = std::strlen(result.note);
    (void)std::snprintf(result.note + used, sizeof result.note - used, "%s%s", used > 0 ? "; " : "",
                        text.c_str());
}

// ---- cost functions of users ------------------------------------------------------------------------

vox_cell_size_result minimise_within(const std::function<double(double cell_size)>& cost_at,
                                     const CellSizeRange& range, double zone_loss) {
    if (!(range.min > 0 && range.min <= range.max && std::isfinite(range.max)))
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("min is %g, max is %g, expected 0 < min <= max", range.min, range.max));
    if (!(zone_loss >= 0 && zone_loss <= 1e6))
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("zone_loss is %g, expected a number from 0 to 1e6", zone_loss));
    const CostFunction cost = [&](double place) { return cost_at(size_at(place, range)); };
    const vox_cost_sample best = minimise(cost, range);
    if (!std::isfinite(best.cost))
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("no finite cost for a cell size from %g to %g", range.min, range.max));
    if (best.cost < 0)
        throw Error(
            VOX_ERROR_INVALID_ARGUMENT,
            format("the cost is %g at cell size %g, expected none below 0", best.cost, best.cell_size));
    const CellSizeRange zone = zone_around(best, (1 + zone_loss) * best.cost, cost, range);
    vox_cell_size_result result{};
    result.cell_size = best.cell_size;
    result.cost = best.cost;
    result.zone_min = zone.min;
    result.zone_max = zone.max;
    draw_curve(cost, range, result.curve, result.curve_count);
    return result;
}

} // namespace vox
