// Weighted least squares that is repeated with weights from its own errors: P. J. Huber, Robust Statistics,
// 1981, ch. 7, with the weights of a Cauchy distribution, on the slow side alone: a timing can be disturbed,
// which makes it longer, never shorter.
#include "cell_size/foreign/fit.hpp"

#include "base/array.hpp"
#include "base/error.hpp"
#include "cell_size/search.hpp"

#include <algorithm>
#include <cinttypes>
#include <cmath>

namespace vox {

// ---- terms ----------------------------------------------------------------------------------------

CostBasis described_basis(const WorkAt& work, const vox_foreign_weights& expected) {
    const auto values = [work](double cell_size) {
        const vox_foreign_counts w = work(cell_size);
        return Coefficients{1,       w.stored,   w.visits, std::max(w.visits - w.empty, 0.0),
                            w.reads, w.occupied, w.cells};
    };
    return {7,
            values,
            {expected.run, expected.store, expected.visit, expected.found, expected.read, expected.occupied,
             expected.cell}};
}

CostBasis power_basis(double middle) {
    const auto values = [middle](double cell_size) {
        const double x = cell_size / middle, y = middle / cell_size;
        return Coefficients{y * y * y, y * y, y, 1, x, x * x, x * x * x};
    };
    return {7, values, {0.05, 0.075, 0.1, 0.55, 0.1, 0.075, 0.05}};
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

vox_foreign_weights weights_of(const Coefficients& seconds) noexcept {
    constexpr double ns = 1e9;
    return {ns * seconds[0], ns * seconds[1], ns * seconds[2], ns * seconds[3],
            ns * seconds[4], ns * seconds[5], ns * seconds[6]};
}

// ---- the fit --------------------------------------------------------------------------------------

CostFit::CostFit(const CostBasis& basis, const Coefficients& middle) noexcept : count_(basis.count) {
    const double total = cost_of(middle, basis.expected);
    for (std::size_t i = 0; i < count_; ++i) {
        if (middle[i] > 0) scale_[i] = 1 / middle[i];
        if (total > 0)
            expected_[i] = std::min((middle[i] > 0 ? middle[i] : 1) * basis.expected[i] / total, 1.0);
        else
            expected_[i] = middle[i] > 0 ? 1 / static_cast<double>(count_) : 0;
    }
}

Coefficients CostFit::operator()(std::span<const TimedTerms> timings) const noexcept {
    constexpr double pull = 0.1;
    // What a run would take at `middle` if the expected shares were right: the geometric mean over the
    // timings.
    double logs = 0, weights = 0;
    for (const TimedTerms& timing : timings) {
        double expected = 0;
        for (std::size_t i = 0; i < count_; ++i) expected += expected_[i] * scale_[i] * timing.values[i];
        if (!(expected > 0)) continue;
        logs += timing.weight * std::log(timing.seconds / expected);
        weights += timing.weight;
    }
    const double unit = weights > 0 ? std::exp(logs / weights) : timings.front().seconds;
    NonNegativeLeastSquares squares(static_cast<int>(count_));
    Coefficients row{};
    for (const TimedTerms& timing : timings) {
        const double root = std::sqrt(timing.weight);
        for (std::size_t i = 0; i < count_; ++i)
            row[i] = root * (unit / timing.seconds) * (scale_[i] * timing.values[i]);
        squares.add({row.data(), count_}, root);
    }
    for (std::size_t i = 0; i < count_; ++i) {
        row = {};
        row[i] = pull;
        squares.add({row.data(), count_}, pull * expected_[i]);
    }
    Coefficients found = squares.solve();
    for (std::size_t i = 0; i < count_; ++i)
        found[i] = unit * (scale_[i] > 0 ? found[i] * scale_[i] : expected_[i]);
    return found;
}

double weigh(const CostFit& fit, std::span<TimedTerms> timings) noexcept {
    // Before anything is known of the noise: as if that many timings had shown so much.
    constexpr double usual_noise = 0.05, usual_count = 4;
    // Timings so many times the noise above the curve count half.
    constexpr double far = 2.5;
    double least = timings.front().seconds;
    for (const TimedTerms& timing : timings) least = std::min(least, timing.seconds);
    for (TimedTerms& timing : timings) timing.weight = least / timing.seconds;
    double noise = usual_noise;
    for (int round = 0; round < 5; ++round) {
        const Coefficients coefficients = fit(timings);
        double sum = usual_count * usual_noise * usual_noise, count = usual_count;
        for (TimedTerms& timing : timings) {
            const double fitted = cost_of(timing.values, coefficients);
            const double error = fitted / timing.seconds - 1, ratio = error / (far * noise);
            timing.weight = least / std::max(fitted, least) / (error < 0 ? 1 + ratio * ratio : 1);
            sum += timing.weight * error * error;
            count += timing.weight;
        }
        noise = std::sqrt(sum / count);
    }
    return noise;
}

double weighted_error(std::span<const TimedTerms> timings, const Coefficients& coefficients) noexcept {
    double sum = 0, weights = 0;
    for (const TimedTerms& timing : timings) {
        const double error = cost_of(timing.values, coefficients) / timing.seconds - 1;
        sum += timing.weight * error * error;
        weights += timing.weight;
    }
    return std::sqrt(sum / weights);
}

double plain_error(std::span<const TimedTerms> timings, const Coefficients& coefficients) noexcept {
    double sum = 0;
    for (const TimedTerms& timing : timings) {
        const double error = cost_of(timing.values, coefficients) / timing.seconds - 1;
        sum += error * error;
    }
    return std::sqrt(sum / static_cast<double>(timings.size()));
}

// ---- warnings -------------------------------------------------------------------------------------

void Notes::add(vox_cell_size_warnings warning, const std::string& text) {
    warnings_ |= static_cast<std::uint32_t>(warning);
    text_ += text_.empty() ? text : "; " + text;
}

void Notes::write(char (&note)[VOX_NOTE_CAPACITY]) const noexcept {
    *std::copy_n(text_.data(), std::min(text_.size(), sizeof note - 1), note) = '\0';
}

// ---- the smallest cell size ----

void prefer_least(CostMinimum& best, const CostMinimum& at_least) noexcept {
    constexpr double hardly_more = 1.03;
    if (at_least.cost <= hardly_more * best.cost) best = at_least;
}

// ---- a grid from its timings ----------------------------------------------------------------------

namespace {

// Cell sizes that differ by less, relatively, are one.
constexpr double same_size = 1e-6;
// How far beyond the sizes timed the least cost is looked for.
constexpr double beyond = 1.2;

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

vox_cell_size_result fit_timings(const CostBasis& described, const FitSettings& settings,
                                 std::span<const vox_timing> timings, std::pmr::memory_resource* memory) {
    check_timings(timings, settings.least_cell_size);
    Array<vox_timing> sorted(timings.begin(), timings.end(), memory);
    std::sort(sorted.begin(), sorted.end(), [](const vox_timing& a, const vox_timing& b) {
        return a.cell_size != b.cell_size ? a.cell_size < b.cell_size : a.seconds < b.seconds;
    });
    // Of those at one size the shortest; they are counted from the smallest of them.
    Notes notes;
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
    const CostFit fit(described, described.values(std::sqrt(smallest) * std::sqrt(largest)));
    (void)weigh(fit, timed);
    const Coefficients coefficients = fit(timed);

    const CellSizeRange range{std::max(smallest / beyond, std::min(settings.least_cell_size, smallest)),
                              largest * beyond};
    const CostFunction cost = [&](double log_size) {
        return cost_of(described.values(std::exp2(log_size)), coefficients);
    };
    CostMinimum best = minimise(cost, range, {.tolerance = 1e-4});
    if (settings.least_cell_size > 0 && smallest <= settings.least_cell_size * (1 + same_size))
        prefer_least(best, {smallest, cost(std::log2(smallest))});
    const CellSizeRange zone =
        zone_around(best, (1 + settings.zone_loss) * best.cost, cost, range, {.tolerance = 1e-4});

    vox_cell_size_result result{};
    result.weights = weights_of(coefficients);
    result.fit_error = plain_error(timed, coefficients);
    result.cell_size = best.cell_size;
    result.zone_min = zone.min;
    result.zone_max = zone.max;
    result.cost = best.cost;
    result.min_cell_size = settings.least_cell_size;
    draw_curve(cost, {best.cell_size / 8, best.cell_size * 8}, result.curve, result.curve_count);
    if (widest > disagreeing_timings)
        notes.add(
            VOX_CELL_SIZE_TIMINGS_DISAGREE,
            format("timings at cell size %g differ %.2f times; the shortest counts", widest_at, widest));
    if (result.fit_error > disagreeing_model)
        notes.add(VOX_CELL_SIZE_MODEL_DISAGREES,
                  format("the counts of this grid miss the timings by %.0f %%, expected at most %.0f %%",
                         100 * result.fit_error, 100 * disagreeing_model));
    if (best.cell_size < smallest || best.cell_size > largest)
        notes.add(VOX_CELL_SIZE_OUT_OF_RANGE, format("the best cell size %g is beyond those timed, %g to %g",
                                                     best.cell_size, smallest, largest));
    if (settings.least_cell_size > 0 && best.cell_size <= settings.least_cell_size * (1 + same_size))
        notes.add(VOX_CELL_SIZE_AT_MINIMUM,
                  format("%g is the smallest cell size that gives right answers", settings.least_cell_size));
    result.warnings = notes.warnings();
    notes.write(result.note);
    return result;
}

} // namespace vox
