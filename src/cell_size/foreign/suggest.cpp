#include "cell_size/foreign/grid.hpp"

#include "base/error.hpp"
#include "cell_size/search.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

namespace {

constexpr Fineness foreign_fineness{.scans_per_octave = 5, .tolerance = 1e-4};

// The sizes among which the least cost must be, as no cell costs less than an empty one that was never made,
// or more than one of its own for each entry.
CellSizeRange bracket(const ForeignGrid& grid, const ForeignWork& work) {
    const vox_foreign_weights& weights = grid.desc.weights;
    const CellSizeRange& range = work.range();
    const auto most = [&](double log_size) {
        vox_foreign_counts w = work.smooth_at(std::exp2(log_size));
        w.occupied = w.stored;
        w.empty = 0;
        return grid_cost(w, weights);
    };
    const auto least = [&](double log_size) {
        vox_foreign_counts w = work.smooth_at(std::exp2(log_size));
        if (grid.pairs()) w.visits = w.empty = 0;
        return grid_cost(w, weights);
    };
    const vox_cost_sample best = minimise(most, range, foreign_fineness);
    const double limit = best.cost * (1 + 1e-6); // beyond rounding
    return zone_around({best.cell_size, least(std::log2(best.cell_size))}, limit, least, range,
                       foreign_fineness);
}

bool in_zone(const CellSizeRange& zone, double cell_size) {
    return cell_size >= zone.min && cell_size <= zone.max;
}

// Where nothing has a size, smaller cells are never worse. Below the size where one other in sixteen is
// found, they are hardly better.
double smallest_useful(const ForeignWork& work) {
    const CellSizeRange& range = work.range();
    const double own = work.smooth_at(range.min).reads;
    double low = std::log2(range.min), high = std::log2(range.max);
    while (high - low > 1e-3) {
        const double middle = (low + high) / 2;
        (work.smooth_at(std::exp2(middle)).reads - own < work.asking_count() / 16 ? low : high) = middle;
    }
    return std::exp2(high);
}

// The sizes that are worth a look.
CellSizeRange useful_range(const ForeignWork& work, vox_cell_size_result& result) {
    CellSizeRange range = work.range();
    if (work.in_one_place()) {
        add_warning(result, VOX_CELL_SIZE_ONE_PLACE,
                    "all are in one place and have no size: any cell size does");
    } else if (work.without_size()) {
        range.min = std::max(range.min, smallest_useful(work));
        add_warning(
            result, VOX_CELL_SIZE_FROM_SPACING,
            format("no primitive has a size: below %g cells hold one each, and cost the same", range.min));
    }
    return range;
}

// Weights that are a guess say little within the zone, and in some grids little about small gains: then what
// most people use, the mean edge, is as good.
void prefer_rule(const ForeignGrid& grid, double mean_edge, const CostFunction& cost,
                 const CellSizeRange& whole, vox_cost_sample& best, CellSizeRange& zone,
                 vox_cell_size_result& result) {
    add_warning(result, VOX_CELL_SIZE_GUESSED_WEIGHTS,
                "nothing is known of the grid's times: three timings would help");
    const double doubt = doubtful_gain(grid.desc.cells_stored, grid.desc.cells_queried, grid.dense());
    const bool is_as_good = in_zone(zone, mean_edge);
    if (!is_as_good &&
        !(doubt > grid.desc.zone_loss &&
          in_zone(zone_around(best, (1 + doubt) * best.cost, cost, whole, foreign_fineness), mean_edge)))
        return;
    best = {mean_edge, cost(std::log2(mean_edge))};
    zone = {std::min(zone.min, mean_edge), std::max(zone.max, mean_edge)};
    add_warning(result, VOX_CELL_SIZE_BY_RULE,
                format(is_as_good ? "so the mean edge, %g, is as good as any size in the zone"
                                  : "so it is in doubt whether any size is better than the mean edge, %g",
                       mean_edge));
}

CostTerms terms_of(const vox_foreign_counts& work, const vox_foreign_weights& weights) {
    CostTerms terms;
    const auto add = [&](const char* name, double count, double weight) {
        if (weight > 0) terms.add(name, count, weight);
    };
    add("run", 1, weights.run);
    add("store in a cell", work.stored, weights.store);
    add("visit a cell", work.visits, weights.visit);
    add("find something there", work.visits - work.empty, weights.found);
    add("read a primitive", work.reads, weights.read);
    add("make a cell", work.occupied, weights.occupied);
    add("clear a cell", work.cells, weights.cell);
    return terms;
}

double seconds(double nanoseconds) noexcept { return 1e-9 * nanoseconds; }

} // namespace

vox_cell_size_result suggest_for(const ForeignGrid& grid, ForeignWork& work) {
    const vox_foreign_weights& weights = grid.desc.weights;
    vox_cell_size_result result{};
    const bool empty = !grid.pairs() && weights.found > 0,
               occupied = weights.occupied > 0 || (grid.pairs() && (weights.visit > 0 || weights.found > 0));
    const auto work_at = [&](double d) { return work.at(d, empty, occupied); };
    const CostFunction cost = [&](double log_size) {
        return grid_cost(work_at(std::exp2(log_size)), weights);
    };

    const CellSizeRange whole = useful_range(work, result);
    CellSizeRange range = whole;
    if (!work.in_one_place() && (empty || occupied)) {
        const CellSizeRange near = bracket(grid, work);
        range.min = std::max(range.min, near.min);
        range.max = std::max(range.min, near.max);
    }
    vox_cost_sample best = minimise(cost, range, foreign_fineness);
    if (!std::isfinite(best.cost)) best = {range.max, cost(std::log2(range.max))};
    const double least = best.cost;
    CellSizeRange zone =
        zone_around(best, (1 + grid.desc.zone_loss) * best.cost, cost, whole, foreign_fineness);

    for (vox_cell_size_rule rule : work.rules()) {
        if (rule.cell_size > 0 && work.is_countable(rule.cell_size))
            rule.cost = seconds(cost(std::log2(rule.cell_size)));
        result.rules[result.rule_count++] = rule;
    }
    if (!grid.weights_known)
        prefer_rule(grid, work.rules().front().cell_size, cost, whole, best, zone, result);

    result.cell_size = best.cell_size;
    result.zone_min = zone.min;
    result.zone_max = zone.max;
    result.cost = seconds(best.cost);
    result.min_cell_size = work.least_cell_size();
    result.weights = weights;
    if (result.min_cell_size > 0 && best.cell_size <= result.min_cell_size * 1.001)
        add_warning(result, VOX_CELL_SIZE_AT_MINIMUM,
                    format("%g is the smallest cell size that gives right answers", result.min_cell_size));
    if (!work.in_one_place() && best.cell_size >= work.range().max * 0.999)
        add_warning(result, VOX_CELL_SIZE_ONE_PLACE,
                    "one cell that holds all costs least: any larger one does");

    // Sizes between those of the search may cost a little less.
    const CostFunction curve = [&](double log_size) { return seconds(std::max(cost(log_size), least)); };
    draw_curve(curve, {best.cell_size / 8, best.cell_size * 8}, result.curve, result.curve_count);
    write_terms(terms_of(work_at(best.cell_size), weights), 1e-9, result);
    return result;
}

} // namespace vox
