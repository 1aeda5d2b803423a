// Least squares that is repeated with weights from its own errors: P. J. Huber, Robust Statistics, 1981, ch.
// 7, with the weights of a Cauchy distribution, on the slow side alone: a timing can be disturbed, which
// makes it longer, never shorter. Losses in the comments are those of replays on the curves of
// docs/evidence/foreign-grids.svg.
#include "cell_size/foreign/fit.hpp"

#include "base/array.hpp"
#include "base/error.hpp"
#include "cell_size/foreign/grid.hpp"

#include <algorithm>
#include <bit>
#include <cinttypes>
#include <cmath>

namespace vox {

// ---- terms ----------------------------------------------------------------------------------------

CostBasis described_basis(const WorkAt& work, const vox_foreign_weights& expected, double least_cell_size,
                          double zone_loss) {
    const auto values = [work](double cell_size) {
        const vox_foreign_counts w = work(cell_size);
        return Coefficients{1,       w.stored,   w.visits, std::max(w.visits - w.empty, 0.0),
                            w.reads, w.occupied, w.cells};
    };
    CostBasis basis{std::tuple_size_v<WeightArray>, values, {}, least_cell_size, zone_loss};
    std::ranges::copy(std::bit_cast<WeightArray>(expected), basis.expected.begin());
    return basis;
}

CostBasis with_powers(const CostBasis& described, double middle) {
    constexpr std::size_t powers = 7;
    const auto values = [described, middle](double cell_size) {
        Coefficients all = described.count > 0 ? described.values(cell_size) : Coefficients{};
        const double x = cell_size / middle, y = middle / cell_size;
        std::ranges::copy(std::array{y * y * y, y * y, y, 1.0, x, x * x, x * x * x},
                          all.begin() + described.count);
        return all;
    };
    CostBasis basis = described;
    basis.count += powers;
    basis.values = values;
    if (described.count == 0) basis.expected = {0.05, 0.075, 0.1, 0.55, 0.1, 0.075, 0.05};
    return basis;
}

void check_countable(const CostBasis& basis, double cell_size, const char* what) {
    for (const double value : basis.values(cell_size))
        if (!(value <= most_counted))
            throw Error(VOX_ERROR_LIMIT,
                        format("%s is %.9g, so small that there would be more than %g cells or entries", what,
                               cell_size, most_counted));
}

double cost_of(const Coefficients& values, const Coefficients& coefficients) noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += values[i] * coefficients[i];
    return sum;
}

// ---- the fit --------------------------------------------------------------------------------------

Coefficients fit_once(const CostBasis& basis, const Coefficients& middle,
                      std::span<const TimedTerms> timings) noexcept {
    // Fits to three timings lose 1.1 % on average with 0.1 to 0.35; at 0.03 and 0.5 the worst loses 15 and 34
    // % in place of 11.
    constexpr double pull = 0.25;
    Coefficients scale{}; // of a term, so that it is 1 at `middle`; 0 where it is 0 there
    Coefficients
        expected{}; // shares at `middle`; for terms that are 0 there, of the whole for each one, at most all
    const double total = cost_of(middle, basis.expected);
    for (std::size_t i = 0; i < basis.count; ++i) {
        if (middle[i] > 0) scale[i] = 1 / middle[i];
        if (total > 0)
            expected[i] = std::min((middle[i] > 0 ? middle[i] : 1) * basis.expected[i] / total, 1.0);
        else
            expected[i] = middle[i] > 0 ? 1 / static_cast<double>(basis.count) : 0;
    }
    // What a run would take at `middle` if the expected shares were right: the geometric mean over the
    // timings.
    double logs = 0, weights = 0;
    for (const TimedTerms& timing : timings) {
        double at_once = 0;
        for (std::size_t i = 0; i < basis.count; ++i) at_once += expected[i] * scale[i] * timing.values[i];
        if (!(at_once > 0)) continue;
        logs += timing.weight * std::log(timing.seconds / at_once);
        weights += timing.weight;
    }
    const double unit = weights > 0 ? std::exp(logs / weights) : timings.front().seconds;
    NormalEquations equations{};
    for (const TimedTerms& timing : timings) {
        const double root = std::sqrt(timing.weight);
        Coefficients row{};
        for (std::size_t i = 0; i < basis.count; ++i)
            row[i] = root * (unit / timing.seconds) * (scale[i] * timing.values[i]);
        row[basis.count] = root;
        add_row(row, equations);
    }
    for (std::size_t i = 0; i < basis.count; ++i) {
        Coefficients row{};
        row[i] = pull;
        row[basis.count] = pull * expected[i];
        add_row(row, equations);
    }
    Coefficients found = solve_non_negative(equations, basis.count);
    for (std::size_t i = 0; i < basis.count; ++i)
        found[i] = unit * (scale[i] > 0 ? found[i] * scale[i] : expected[i]);
    return found;
}

Coefficients fit_robustly(const CostBasis& basis, const Coefficients& middle,
                          std::span<TimedTerms> timings) noexcept {
    // A timing so far above the curve, relatively, counts half. Without such weights tunings with 8 % noise
    // and disturbed runs lose 1.5 % on average in place of 1.2; half or twice as far, 1.3. A second round
    // changes nothing.
    constexpr double far = 0.125;
    for (TimedTerms& timing : timings) timing.weight = 1;
    const Coefficients coefficients = fit_once(basis, middle, timings);
    for (TimedTerms& timing : timings) {
        const double ratio = std::min(cost_of(timing.values, coefficients) / timing.seconds - 1, 0.0) / far;
        timing.weight = 1 / (1 + ratio * ratio);
    }
    return fit_once(basis, middle, timings);
}

namespace {

// Cell sizes that differ by less, relatively, are one: decimal numbers in files have six digits or more.
constexpr double same_size = 1e-6;
// Of an octave: far less than any zone is wide.
constexpr Fineness fineness{.tolerance = 1e-4};
// Timings at one cell size disagree beyond this ratio: five times what noise of 5 % does.
constexpr double disagreeing_timings = 1.25;

// Of described_basis, in nanoseconds.
vox_foreign_weights weights_of(const Coefficients& seconds) noexcept {
    WeightArray ns{};
    for (std::size_t i = 0; i < ns.size(); ++i) ns[i] = 1e9 * seconds[i];
    return std::bit_cast<vox_foreign_weights>(ns);
}

// Root mean square of (fitted / measured - 1).
double relative_error(std::span<const TimedTerms> timings, const Coefficients& coefficients) noexcept {
    double sum = 0;
    for (const TimedTerms& timing : timings) {
        const double error = cost_of(timing.values, coefficients) / timing.seconds - 1;
        sum += error * error;
    }
    return std::sqrt(sum / static_cast<double>(timings.size()));
}

} // namespace

void write_best(const vox_cost_sample& best, const CostFunction& cost, const CellSizeRange& range,
                const CostBasis& basis, vox_cell_size_result& result) {
    const CellSizeRange zone = zone_around(best, (1 + basis.zone_loss) * best.cost, cost, range, fineness);
    result.cell_size = best.cell_size;
    result.zone_min = zone.min;
    result.zone_max = zone.max;
    result.cost = best.cost;
    result.min_cell_size = basis.least_cell_size;
    draw_curve(cost, {best.cell_size / 8, best.cell_size * 8}, result.curve, result.curve_count);
    if (basis.least_cell_size > 0 && best.cell_size <= basis.least_cell_size * (1 + same_size))
        add_warning(result, VOX_CELL_SIZE_AT_MINIMUM,
                    format("%g is the smallest cell size that gives right answers", basis.least_cell_size));
}

void write_errors(const CostBasis& described, const Coefficients& middle, std::span<TimedTerms> timings,
                  const Coefficients& all, vox_cell_size_result& result) {
    result.fit_error = relative_error(timings, all);
    if (result.fit_error > disagreeing_timings - 1)
        add_warning(result, VOX_CELL_SIZE_TIMINGS_DISAGREE,
                    format("runs are %.0f %% away from the best curve", 100 * result.fit_error));
    if (described.count == 0) return;
    const Coefficients coefficients = fit_robustly(described, middle, timings);
    const double error = relative_error(timings, coefficients);
    if (error > disagreeing_model && error > 2 * result.fit_error)
        add_warning(
            result, VOX_CELL_SIZE_MODEL_DISAGREES,
            format("the counts of this grid miss the times by %.0f %%, powers of the cell size by %.0f %%",
                   100 * error, 100 * result.fit_error));
    result.weights = weights_of(coefficients);
}

// ---- a grid from its timings ----------------------------------------------------------------------

namespace {

// How far beyond the sizes timed the least cost is looked for, so that a warning can say that it is there. At
// 1.4 fits lose 1.2 % on average in place of 1.1.
constexpr double beyond = 1.2;
// More than this must be gained beside the least legal size: with 1 the worst fit loses 13 % in place of 11,
// with 1.06 nothing changes.
constexpr double hardly_more = 1.03;

void check_timings(std::span<const vox_timing> timings, double least_cell_size) {
    for (std::size_t i = 0; i < timings.size(); ++i) {
        const auto [size, seconds] = timings[i];
        const auto fail = [&](const char* what, double value, const std::string& expected) {
            throw Error(VOX_ERROR_INVALID_ARGUMENT,
                        format("timings[%zu].%s is %.9g, expected %s", i, what, value, expected.c_str()));
        };
        if (!(size > 0) || !std::isfinite(size)) fail("cell_size", size, "a finite number above 0");
        if (size < least_cell_size * (1 - same_size))
            fail("cell_size", size,
                 format("at least the smallest that gives right answers, %.9g", least_cell_size));
        if (!(seconds >= least_seconds && seconds <= most_seconds))
            fail("seconds", seconds, format("%g to %g", least_seconds, most_seconds));
    }
}

} // namespace

vox_cell_size_result fit_timings(const CostBasis& described, std::span<const vox_timing> timings,
                                 std::pmr::memory_resource* memory) {
    check_timings(timings, described.least_cell_size);
    Array<vox_timing> sorted(timings.begin(), timings.end(), memory);
    std::sort(sorted.begin(), sorted.end(), [](const vox_timing& a, const vox_timing& b) {
        return a.cell_size != b.cell_size ? a.cell_size < b.cell_size : a.seconds < b.seconds;
    });
    // Of those at one size the shortest; they are counted from the smallest of them.
    std::size_t sizes = 0;
    double widest = 1, widest_at = 0;
    for (std::size_t i = 0; i < sorted.size();) {
        std::size_t end = i;
        vox_timing shortest = sorted[i], longest = sorted[i];
        for (; end < sorted.size() && sorted[end].cell_size <= sorted[i].cell_size * (1 + same_size); ++end) {
            if (sorted[end].seconds < shortest.seconds) shortest = sorted[end];
            if (sorted[end].seconds > longest.seconds) longest = sorted[end];
        }
        if (longest.seconds / shortest.seconds > widest) {
            widest = longest.seconds / shortest.seconds;
            widest_at = shortest.cell_size;
        }
        sorted[sizes++] = shortest;
        i = end;
    }
    sorted.resize(sizes);
    if (sizes < 3)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("timings are at %zu different cell sizes, expected at least 3", sizes));

    check_countable(described, sorted.front().cell_size, "the smallest cell size timed");
    Array<TimedTerms> timed(memory);
    timed.reserve(sizes);
    for (const vox_timing& timing : sorted)
        timed.push_back({timing.seconds, described.values(timing.cell_size)});
    const double smallest = sorted.front().cell_size, largest = sorted.back().cell_size;
    const Coefficients coefficients =
        fit_robustly(described, described.values(std::sqrt(smallest) * std::sqrt(largest)), timed);

    const CellSizeRange range{std::max(smallest / beyond, std::min(described.least_cell_size, smallest)),
                              largest * beyond};
    const CostFunction cost = [&](double log_size) {
        return cost_of(described.values(std::exp2(log_size)), coefficients);
    };
    vox_cost_sample best = minimise(cost, range, fineness);
    // No box of a grid that needs cells as large as its boxes covers more than two of them along an axis. A
    // run at the least such size can be far faster than one close to it, which smooth terms do not show.
    if (smallest <= described.least_cell_size * (1 + same_size))
        if (const double there = cost(std::log2(smallest)); there <= hardly_more * best.cost)
            best = {smallest, there};

    vox_cell_size_result result{};
    write_best(best, cost, range, described, result);
    result.weights = weights_of(coefficients);
    result.fit_error = relative_error(timed, coefficients);
    if (widest > disagreeing_timings)
        add_warning(
            result, VOX_CELL_SIZE_TIMINGS_DISAGREE,
            format("timings at cell size %g differ %.2f times; the shortest counts", widest_at, widest));
    if (result.fit_error > disagreeing_model)
        add_warning(result, VOX_CELL_SIZE_MODEL_DISAGREES,
                    format("the counts of this grid miss the timings by %.0f %%, expected at most %.0f %%",
                           100 * result.fit_error, 100 * disagreeing_model));
    if (best.cell_size < smallest || best.cell_size > largest)
        add_warning(result, VOX_CELL_SIZE_OUT_OF_RANGE,
                    format("the best cell size %g is beyond those timed, %g to %g", best.cell_size, smallest,
                           largest));
    return result;
}

} // namespace vox
