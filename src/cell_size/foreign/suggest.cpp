#include "cell_size/foreign/suggest.hpp"

#include "base/error.hpp"
#include "cell_size/foreign/cost.hpp"
#include "cell_size/foreign/known_grids.hpp"
#include "cell_size/search.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

namespace vox {

namespace {

constexpr Fineness foreign_fineness{.scans_per_octave = 5, .tolerance = 1e-4};

// Empty and occupied cells take longer to count than the rest.
CellsWanted cells_wanted(const ForeignGrid& grid) {
    const vox_foreign_weights& w = grid.desc.weights;
    if (grid.pairs()) return {false, w.occupied > 0 || w.visit > 0 || w.found > 0};
    return {w.found > 0, w.occupied > 0};
}

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
    const CostMinimum best = minimise(most, range, foreign_fineness);
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

void add_to_note(std::string& note, const std::string& text) { note += note.empty() ? text : "; " + text; }

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
    std::string note;
    const auto warn = [&](vox_cell_size_warnings warning, const std::string& text) {
        result.warnings |= static_cast<std::uint32_t>(warning);
        add_to_note(note, text);
    };

    const CellsWanted cells = cells_wanted(grid);
    const auto work_at = [&](double d) { return work.at(d, cells); };
    const CostFunction cost = [&](double log_size) {
        return grid_cost(work_at(std::exp2(log_size)), weights);
    };

    CellSizeRange range = work.range();
    if (work.in_one_place()) {
        warn(VOX_CELL_SIZE_ONE_PLACE, "all are in one place and have no size: any cell size does");
    } else {
        if (work.without_size()) {
            range.min = std::max(range.min, smallest_useful(work));
            warn(VOX_CELL_SIZE_FROM_SPACING,
                 format("no primitive has a size: below %g cells hold one each, and cost the same",
                        range.min));
        }
    }
    const CellSizeRange whole = range;
    if (!work.in_one_place() && (cells.empty || cells.occupied)) {
        const CellSizeRange near = bracket(grid, work);
        range = {std::max(range.min, near.min), std::max(std::max(range.min, near.min), near.max)};
    }
    CostMinimum best = minimise(cost, range, foreign_fineness);
    if (!std::isfinite(best.cost)) best = {range.max, cost(std::log2(range.max))};
    const double least = best.cost;
    CellSizeRange zone =
        zone_around(best, (1 + grid.desc.zone_loss) * best.cost, cost, whole, foreign_fineness);

    const ForeignRules& rules = work.rules();
    const auto add_rule = [&](const char* name, double cell_size) {
        const bool has_cost = cell_size > 0 && work.is_countable(cell_size);
        result.rules[result.rule_count++] = {name, cell_size,
                                             has_cost ? seconds(cost(std::log2(cell_size))) : 0};
    };
    add_rule("mean edge (Teschner et al. 2003)", rules.mean_edge);
    add_rule("mean box side", rules.mean_box_side);
    add_rule("median box side (IPC Toolkit)", rules.median_box_side);
    add_rule("spacing", rules.spacing);
    add_rule("mean radius", rules.radius);
    if (!grid.weights_known)
        warn(VOX_CELL_SIZE_GUESSED_WEIGHTS, "nothing is known of the grid's times: three timings would help");
    // Weights that are a guess say little within the zone, and in some grids little about small gains: then
    // what most people use is as good.
    const double doubt = doubtful_gain(grid.desc.cells_stored, grid.desc.cells_queried, grid.dense());
    CellSizeRange doubtful = zone;
    if (!grid.weights_known && doubt > grid.desc.zone_loss)
        doubtful = zone_around(best, (1 + doubt) * best.cost, cost, whole, foreign_fineness);
    if (!grid.weights_known && in_zone(doubtful, rules.mean_edge)) {
        best = {rules.mean_edge, cost(std::log2(rules.mean_edge))};
        warn(VOX_CELL_SIZE_BY_RULE,
             format(in_zone(zone, best.cell_size)
                        ? "so the mean edge, %g, is as good as any size in the zone"
                        : "so it is in doubt whether any size is better than the mean edge, %g",
                    best.cell_size));
        zone = {std::min(zone.min, best.cell_size), std::max(zone.max, best.cell_size)};
    }

    result.cell_size = best.cell_size;
    result.zone_min = zone.min;
    result.zone_max = zone.max;
    result.cost = seconds(best.cost);
    result.min_cell_size = work.least_cell_size();
    result.weights = weights;
    if (result.min_cell_size > 0 && best.cell_size <= result.min_cell_size * 1.001)
        warn(VOX_CELL_SIZE_AT_MINIMUM,
             format("%g is the smallest cell size that gives right answers", result.min_cell_size));
    if (!work.in_one_place() && best.cell_size >= work.range().max * 0.999)
        warn(VOX_CELL_SIZE_ONE_PLACE, "one cell that holds all costs least: any larger one does");

    // Sizes between those of the search may cost a little less.
    const CostFunction curve = [&](double log_size) { return seconds(std::max(cost(log_size), least)); };
    draw_curve(curve, {best.cell_size / 8, best.cell_size * 8}, result.curve, result.curve_count);
    write_terms(terms_of(work_at(best.cell_size), weights), 1e-9, result);
    *std::copy_n(note.data(), std::min(note.size(), sizeof result.note - 1), result.note) = '\0';
    return result;
}

} // namespace vox
