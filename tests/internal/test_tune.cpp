// Least squares without negative coefficients, costs fitted to timings, and tuning: over grids whose costs
// are known, with timings that are as noisy and as wrong as those of machines.
#include "cell_size/foreign/fit.hpp"
#include "cell_size/foreign/grid.hpp"
#include "internal/random.hpp"
#include "support/suite.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <memory_resource>
#include <utility>
#include <vector>

using namespace vox;

namespace {

std::pmr::memory_resource* const heap = std::pmr::new_delete_resource();
constexpr double infinity = std::numeric_limits<double>::infinity();

using Cost = std::function<double(double)>;

// ---- least squares ----------------------------------------------------------------------------------

double sum_of_squares(const std::vector<std::vector<double>>& rows, const std::vector<double>& targets,
                      const Coefficients& x) {
    double sum = 0;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        double error = -targets[r];
        for (std::size_t i = 0; i < rows[r].size(); ++i) error += rows[r][i] * x[i];
        sum += error * error;
    }
    return sum;
}

// The slopes tell the least sum: 0 along coefficients above 0, and upwards along the others (Karush, Kuhn and
// Tucker).
START_TEST(least_squares_are_least) {
    Random random{11};
    for (int trial = 0; trial < 300; ++trial) {
        const std::size_t columns = 1 + random.below(14), count = 1 + random.below(20);
        NormalEquations equations{};
        std::vector<std::vector<double>> rows(count, std::vector<double>(columns));
        std::vector<double> targets(count);
        for (std::size_t r = 0; r < count; ++r) {
            for (double& value : rows[r]) value = random.uniform(trial % 2 ? 0.f : -1.f, 1);
            targets[r] = random.uniform(-1, 1);
            Coefficients row{};
            std::ranges::copy(rows[r], row.begin());
            row[columns] = targets[r];
            add_row(row, equations);
        }
        const Coefficients x = solve_non_negative(equations, columns);
        for (std::size_t i = 0; i < columns; ++i) {
            ck_assert_double_ge(x[i], 0);
            double slope = 0;
            for (std::size_t r = 0; r < count; ++r) {
                double error = -targets[r];
                for (std::size_t j = 0; j < columns; ++j) error += rows[r][j] * x[j];
                slope += error * rows[r][i];
            }
            if (x[i] > 0) ck_assert_double_le(std::fabs(slope), 1e-5);
            ck_assert_double_ge(slope, -1e-5);
        }
        ck_assert_double_le(sum_of_squares(rows, targets, x), sum_of_squares(rows, targets, {}) + 1e-12);
    }
}
END_TEST

START_TEST(columns_that_say_nothing) {
    NormalEquations equations{}; // the second is twice the first, the third is 0
    add_row({1, 2, 0, 3}, equations);
    add_row({2, 4, 0, 6}, equations);
    const Coefficients x = solve_non_negative(equations, 3);
    ck_assert_double_eq_tol(x[0] + 2 * x[1], 3, 1e-9);
    ck_assert_double_eq(x[2], 0);
    NormalEquations none{};
    add_row({0, 0, 1}, none);
    ck_assert_double_eq(solve_non_negative(none, 2)[0], 0);
}
END_TEST

// ---- grids ------------------------------------------------------------------------------------------

// Boxes of edges 1 and `large` in a volume, asked by the same boxes.
WorkAt boxes_in_cells(double large, double volume) {
    return [=](double size) {
        constexpr double count = 1e4;
        const double of_one = 0.9 * std::pow(1 / size + 1, 3) + 0.1 * std::pow(large / size + 1, 3);
        vox_foreign_counts work{};
        work.cells = volume / (size * size * size) + 1;
        work.stored = work.visits = count * of_one;
        work.occupied = work.cells * (1 - std::exp(-work.stored / work.cells));
        work.empty = work.visits * (1 - work.occupied / work.cells);
        work.reads = work.visits * work.stored / work.cells;
        return work;
    };
}

constexpr vox_foreign_weights true_weights{5e4, 12, 8, 10, 2, 20, 0.5};

double seconds_of(const WorkAt& work, const vox_foreign_weights& weights, double size) {
    return 1e-9 * grid_cost(work(size), weights);
}

// The least cost from a sixteenth to sixteen times a size.
double least_cost(const Cost& cost, double middle) {
    double least = infinity;
    for (double log_size = -4; log_size <= 4; log_size += 0.01)
        least = std::min(least, cost(middle * std::exp2(log_size)));
    return least;
}

std::vector<vox_timing> timings_of(const Cost& cost, const std::vector<double>& sizes) {
    std::vector<vox_timing> timings;
    for (const double size : sizes) timings.push_back({size, cost(size)});
    return timings;
}

// ---- fits -------------------------------------------------------------------------------------------

// Three exact timings, and weights that were expected to be up to three times as large or small.
START_TEST(fit_of_three_timings) {
    Random random{5};
    std::vector<double> losses;
    for (int trial = 0; trial < 60; ++trial) {
        const WorkAt work = boxes_in_cells(random.uniform(1, 4), random.uniform(3e3f, 1e5f));
        vox_foreign_weights actual = true_weights, expected = true_weights;
        for (double* w : {&actual.run, &actual.store, &actual.visit, &actual.found, &actual.read,
                          &actual.occupied, &actual.cell})
            *w *= std::exp(random.uniform(-1.1f, 1.1f));
        const Cost cost = [&](double size) { return seconds_of(work, actual, size); };
        const double noise[] = {1 + random.uniform(-0.04f, 0.04f), 1 + random.uniform(-0.04f, 0.04f),
                                1 + random.uniform(-0.04f, 0.04f)};
        std::vector<vox_timing> timings = timings_of(cost, {0.6, 1.2, 2.4});
        for (int i = 0; i < 3; ++i) timings[static_cast<std::size_t>(i)].seconds *= noise[i];
        const vox_cell_size_result fit = fit_timings(described_basis(work, expected), timings, heap);
        ck_assert_double_le(fit.fit_error, 0.05);
        ck_assert_double_le(fit.zone_min, fit.cell_size);
        ck_assert_double_ge(fit.zone_max, fit.cell_size);
        // The weights are those of the curve.
        ck_assert_double_eq_tol(seconds_of(work, fit.weights, fit.cell_size), fit.cost, 1e-9 * fit.cost);
        for (std::uint32_t i = 0; i < fit.curve_count; ++i) ck_assert_double_ge(fit.curve[i].cost, 0);
        losses.push_back(cost(fit.cell_size) / least_cost(cost, 1) - 1);
        // Where the best size is beyond those timed, it says so.
        ck_assert_double_le(losses.back(), fit.warnings & VOX_CELL_SIZE_OUT_OF_RANGE ? 0.25 : 0.04);
    }
    std::sort(losses.begin(), losses.end());
    ck_assert_double_le(losses[losses.size() / 2], 0.01);
}
END_TEST

// Entries and visits have the same count at every size here: they are divided as expected.
START_TEST(what_cannot_be_told_apart) {
    const WorkAt work = boxes_in_cells(1, 2e4);
    const Cost cost = [&](double size) { return seconds_of(work, true_weights, size); };
    vox_foreign_weights expected = true_weights;
    expected.store = 3;
    expected.visit = 9;
    const vox_cell_size_result fit =
        fit_timings(described_basis(work, expected), timings_of(cost, {0.5, 0.7, 1, 1.4, 2, 2.8}), heap);
    ck_assert_double_gt(fit.weights.visit, fit.weights.store);
    ck_assert_double_gt(fit.weights.store, 0);
    // A count that is 0 everywhere has its share of what was expected, in proportion.
    const WorkAt without_cells = [&](double size) {
        vox_foreign_counts counts = work(size);
        counts.cells = 0;
        return counts;
    };
    const vox_cell_size_result same =
        fit_timings(described_basis(without_cells, true_weights),
                    timings_of([&](double size) { return 2 * seconds_of(without_cells, true_weights, size); },
                               {0.6, 1.2, 2.4}),
                    heap);
    ck_assert_double_eq_tol(same.weights.cell, 2 * true_weights.cell, 1e-6);
    ck_assert_double_eq_tol(same.weights.read, 2 * true_weights.read, 1e-6);
}
END_TEST

START_TEST(warnings_of_a_fit) {
    const WorkAt work = boxes_in_cells(1.5, 2e4);
    const Cost cost = [&](double size) { return seconds_of(work, true_weights, size); };
    const auto fit = [&](const std::vector<vox_timing>& timings, double least = 0) {
        return fit_timings(described_basis(work, true_weights, least), timings, heap);
    };
    std::vector<vox_timing> timings = timings_of(cost, {0.6, 1.2, 2.4});
    vox_cell_size_result result = fit(timings);
    ck_assert_uint_eq(result.warnings, 0);
    ck_assert_str_eq(result.note, "");
    const double best = result.cell_size;
    // Another run of the same size counts if it is shorter, and warns if it is far off; the order does not
    // matter.
    timings.push_back({1.2, 1.2 * cost(1.2)});
    ck_assert_uint_eq(fit(timings).warnings, 0);
    timings.insert(timings.begin(), {1.2, 3 * cost(1.2)});
    result = fit(timings);
    ck_assert_uint_eq(result.warnings, VOX_CELL_SIZE_TIMINGS_DISAGREE);
    ck_assert_ptr_nonnull(std::strstr(result.note, "size 1.2 differ 3.00 times"));
    ck_assert_double_eq(result.cell_size, best);
    // Times that rise and fall as no sum of these counts does.
    result = fit({{0.4, 1}, {0.8, 3}, {1.6, 1}, {3.2, 3}, {6.4, 1}});
    ck_assert_uint_ne(result.warnings & VOX_CELL_SIZE_MODEL_DISAGREES, 0);
    ck_assert_double_gt(result.fit_error, disagreeing_model);
    ck_assert_ptr_nonnull(std::strstr(result.note, "miss the timings by"));
    // Only small sizes were timed.
    result = fit(timings_of(cost, {best / 8, best / 6, best / 4}));
    ck_assert_uint_eq(result.warnings, VOX_CELL_SIZE_OUT_OF_RANGE);
    ck_assert_double_eq_tol(result.cell_size, best / 4 * 1.2, 1e-3 * best);
    result = fit(timings_of(cost, {2 * best, 3 * best, 4 * best}), 2 * best);
    ck_assert_uint_eq(result.warnings, VOX_CELL_SIZE_AT_MINIMUM);
    ck_assert_double_eq_tol(result.cell_size, 2 * best, 1e-3 * best);
}
END_TEST

// A run that was disturbed moves the answer little.
START_TEST(one_slow_timing) {
    const WorkAt work = boxes_in_cells(1.5, 2e4);
    const Cost cost = [&](double size) { return seconds_of(work, true_weights, size); };
    for (std::size_t slow = 0; slow < 5; ++slow) {
        std::vector<vox_timing> timings = timings_of(cost, {0.5, 0.8, 1.3, 2, 3.2});
        timings[slow].seconds *= 2;
        const vox_cell_size_result fit = fit_timings(described_basis(work, true_weights), timings, heap);
        ck_assert_double_le(cost(fit.cell_size), 1.05 * least_cost(cost, 1));
    }
}
END_TEST

// ---- tuning -----------------------------------------------------------------------------------------

vox_tune_desc tune_within(double min, double max, double first = 1, std::uint32_t max_runs = 7) {
    vox_tune_desc desc = vox_default_tune_desc();
    desc.max_runs = max_runs;
    desc.min = min;
    desc.max = max;
    desc.first = first;
    desc.wanted_loss = 0.02;
    return desc;
}

vox_tune_desc tune_from(double first, std::uint32_t max_runs = 7) {
    return tune_within(first / 8, 8 * first, first, max_runs);
}

// A machine: noise of so much, about normal, and now and then a run that takes twice as long.
struct Machine {
    Cost cost;
    double noise, disturbed;
    Random random;

    double operator()(double size) {
        double normal = -6;
        for (int i = 0; i < 12; ++i) normal += random.unit();
        const double seconds = cost(size) * (1 + noise * std::max(normal, -2.5));
        return random.unit() < disturbed ? 2 * seconds : seconds;
    }
};

struct Losses {
    std::vector<double> all;
    int runs = 0, within_expected = 0;

    void add(const vox_cell_size_result& tuning, const Cost& cost, double middle) {
        const double loss = cost(tuning.cell_size) / least_cost(cost, middle) - 1;
        all.push_back(loss);
        runs += static_cast<int>(tuning.timing_count);
        within_expected += loss <= std::max(tuning.expected_loss, 0.02);
        ck_assert_uint_le(tuning.timing_count, 7);
    }
    double at(double share) {
        std::sort(all.begin(), all.end());
        return all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))];
    }
};

// Sums of powers, with and without waves, and grids with wrong weights expected; the first size is up to 1.6
// octaves off.
START_TEST(tuned_on_a_noisy_machine) {
    Random random{3};
    for (const bool is_described : {false, true}) {
        Losses losses;
        for (std::uint64_t trial = 0; trial < 150; ++trial) {
            const WorkAt work = boxes_in_cells(random.uniform(1, 6), random.uniform(3e3f, 1e5f));
            double coefficients[7];
            for (double& c : coefficients)
                c = 0.005 + (random.unit() < 0.4 ? 0 : std::exp(random.uniform(-4, 0)));
            const double wave = trial % 3 == 0 ? 0.05 : 0;
            vox_foreign_weights expected = true_weights;
            expected.read *= std::exp(random.uniform(-1.5f, 1.5f));
            expected.store *= std::exp(random.uniform(-1.5f, 1.5f));
            const Cost cost = [&](double size) {
                if (is_described) return seconds_of(work, true_weights, size);
                double sum = 0;
                for (int i = 0; i < 7; ++i) sum += coefficients[i] * std::pow(size, i - 3);
                return sum * (1 + wave * std::sin(4 * std::log(size)));
            };
            double best = 1;
            for (double size = 0.1; size < 10; size *= 1.02)
                if (cost(size) < cost(best)) best = size;
            Machine machine{cost, 0.06, 0.1, {trial + 100}};
            const CostBasis basis = described_basis(work, expected);
            const vox_tune_desc desc = tune_from(best * std::exp2(random.uniform(-1.6f, 1.6f)));
            losses.add(tune(is_described ? basis : CostBasis{}, desc, std::ref(machine), heap), cost, best);
        }
        ck_assert_double_le(losses.at(0.5), 0.01);
        ck_assert_double_le(losses.at(0.9), 0.06);
        ck_assert_int_le(losses.runs, 150 * 13 / 2);            // it stops by itself
        ck_assert_int_ge(losses.within_expected, 150 * 8 / 10); // and knows how sure it is
    }
}
END_TEST

// Without disturbances, and with noise of 6 %, nothing is far off.
START_TEST(tuned_without_disturbances) {
    const WorkAt work = boxes_in_cells(2, 2e4);
    const Cost cost = [&](double size) { return seconds_of(work, true_weights, size); };
    const CostBasis basis = described_basis(work, true_weights);
    Losses losses;
    for (std::uint64_t trial = 0; trial < 100; ++trial) {
        Machine machine{cost, 0.06, 0, {trial}};
        losses.add(tune(basis, tune_from(1.2), std::ref(machine), heap), cost, 1);
    }
    ck_assert_double_le(losses.at(0.5), 0.01);
    ck_assert_double_le(losses.at(1), 0.08);
}
END_TEST

bool same_bits(const vox_cell_size_result& a, const vox_cell_size_result& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

// Exact times of a known grid: the best size, its time and weights; the same runs twice give the same bits.
START_TEST(tuned_with_exact_times) {
    const WorkAt work = boxes_in_cells(2, 2e4);
    const Cost cost = [&](double size) { return seconds_of(work, true_weights, size); };
    const CostBasis basis = described_basis(work, true_weights);
    const vox_cell_size_result tuning = tune(basis, tune_from(1), cost, heap);
    ck_assert_uint_le(tuning.timing_count, 5); // it stops by itself
    ck_assert_uint_eq(tuning.warnings, 0);
    ck_assert_double_eq(tuning.timings[0].cell_size, 1);
    ck_assert_double_eq(tuning.timings[1].cell_size, 0.5);
    ck_assert_double_eq(tuning.timings[2].cell_size, 2);
    ck_assert_double_eq(tuning.timings[2].seconds, cost(2));
    ck_assert_double_le(cost(tuning.cell_size), 1.01 * least_cost(cost, 1));
    ck_assert_double_eq_tol(tuning.cost, cost(tuning.cell_size), 0.02 * tuning.cost);
    ck_assert_double_le(tuning.fit_error, 0.01);
    ck_assert_double_le(tuning.expected_loss, 0.02);
    ck_assert_double_eq_tol(tuning.weights.read, true_weights.read, 0.01 * true_weights.read);
    ck_assert_double_lt(tuning.zone_min, tuning.cell_size);
    ck_assert_double_gt(tuning.zone_max, tuning.cell_size);
    ck_assert_double_le(cost(tuning.zone_max), 1.08 * least_cost(cost, 1));
    ck_assert(same_bits(tuning, tune(basis, tune_from(1), cost, heap)));
    // Neither the unit of time nor that of length matters.
    for (const double unit : {1e-12, 1e12}) {
        const vox_cell_size_result other = tune(
            {}, tune_from(unit), [&](double size) { return unit * cost(size / unit); }, heap);
        const vox_cell_size_result plain = tune({}, tune_from(1), cost, heap);
        ck_assert_uint_eq(other.timing_count, plain.timing_count);
        ck_assert_double_eq_tol(other.cell_size / unit, plain.cell_size, 1e-6);
        ck_assert_double_eq_tol(other.expected_loss, plain.expected_loss, 1e-6);
    }
}
END_TEST

const Cost valley = [](double size) { return 1e-3 * (1 / (size * size * size) + size * size * size); };

START_TEST(sizes_that_cannot_run) {
    // Memory for cells of 0.8 and more; the best that can run is there.
    const auto wall = [](double size) { return size < 0.8 ? infinity : size; };
    vox_cell_size_result tuning = tune({}, tune_from(1), wall, heap);
    ck_assert_double_le(tuning.cell_size, 0.8 * 1.1);
    ck_assert_double_ge(tuning.cell_size, 0.8);
    ck_assert_uint_ne(tuning.warnings & VOX_CELL_SIZE_STOPPED, 0);
    ck_assert_ptr_nonnull(std::strstr(tuning.note, "cannot run at cell size 0.5"));
    ck_assert(std::isinf(tuning.timings[1].seconds));
    // The first size cannot, nor can a few others.
    const auto late = [](double size) { return size < 3 ? 1e300 : valley(size / 4); };
    tuning = tune({}, tune_from(1), late, heap);
    ck_assert_double_ge(tuning.cell_size, 3);
    ck_assert_double_le(tuning.cell_size, 5.5);
    ck_assert_uint_le(tuning.timing_count, 7);
    // None can.
    try {
        (void)tune(
            {}, tune_from(1), [](double) { return infinity; }, heap);
        ck_abort();
    } catch (const std::exception& error) {
        ck_assert_str_eq(error.what(), "no run succeeded: 7 could not run, the first at cell size 1");
    }
}
END_TEST

START_TEST(stopped_and_too_short) {
    for (int runs = 1; runs < 6; ++runs) {
        int left = runs;
        const vox_cell_size_result tuning = tune(
            {}, tune_from(1), [&](double size) { return left-- > 0 ? valley(size) + 1e-4 / size : -1; },
            heap);
        if (runs >= 4) continue; // it may have been sure before
        ck_assert_uint_eq(tuning.timing_count, runs);
        ck_assert_uint_ne(tuning.warnings & VOX_CELL_SIZE_STOPPED, 0);
        ck_assert_ptr_nonnull(std::strstr(tuning.note, "stopped at run"));
        ck_assert_double_ge(tuning.cell_size, 0.5);
        ck_assert_double_le(tuning.cell_size, 2);
        ck_assert(runs > 1 || std::isinf(tuning.expected_loss));
    }
    for (const double stop : {-1.0, -infinity, std::nan("")}) {
        int calls = 0;
        try {
            (void)tune(
                {}, tune_from(1), [&](double) { return ++calls, stop; }, heap);
            ck_abort();
        } catch (const std::exception& error) {
            ck_assert_ptr_nonnull(std::strstr(error.what(), "no run succeeded"));
        }
        ck_assert_int_eq(calls, 1);
    }
    try {
        (void)tune(
            {}, tune_from(1), [](double) { return 0.0; }, heap);
        ck_abort();
    } catch (const std::exception& error) {
        ck_assert_ptr_nonnull(std::strstr(error.what(), "run 1, at cell size 1, returned 0 seconds"));
    }
}
END_TEST

START_TEST(ends_of_the_range) {
    // The best size is one that may not be run.
    vox_cell_size_result tuning = tune(
        {}, tune_within(0.9, 4), [](double size) { return size; }, heap);
    ck_assert_double_eq(tuning.cell_size, 0.9);
    tuning = tune(
        {}, tune_within(0.9, 4), [](double size) { return 1 / size; }, heap);
    ck_assert_double_eq(tuning.cell_size, 4);
    for (std::uint32_t i = 0; i < tuning.timing_count; ++i) {
        ck_assert_double_ge(tuning.timings[i].cell_size, 0.9);
        ck_assert_double_le(tuning.timings[i].cell_size, 4);
    }
    // The least legal size.
    tuning = tune(
        {.least_cell_size = 0.97}, tune_within(0.97, 8), [](double size) { return size; }, heap);
    ck_assert_double_eq(tuning.cell_size, 0.97);
    ck_assert_uint_eq(tuning.warnings, VOX_CELL_SIZE_AT_MINIMUM);
    // One size only.
    tuning = tune({}, tune_within(1, 1), valley, heap);
    ck_assert_uint_eq(tuning.timing_count, 1);
    ck_assert_double_eq(tuning.cell_size, 1);
    ck_assert_double_eq(tuning.expected_loss, 0);
    // It is further away than three runs reach; seven do.
    const auto far = [](double size) { return valley(size / 6); };
    tuning = tune({}, tune_from(1, 3), far, heap);
    ck_assert_uint_eq(tuning.timing_count, 3);
    ck_assert_double_eq(tuning.cell_size, 2);
    ck_assert_uint_ne(tuning.warnings & VOX_CELL_SIZE_OUT_OF_RANGE, 0);
    tuning = tune({}, tune_from(1), far, heap);
    ck_assert_double_le(valley(tuning.cell_size / 6), 1.05 * valley(1));
}
END_TEST

// A grid that is faster at its least legal size than a smooth curve shows: a fit takes that size where it
// sees hardly a difference, and only there.
START_TEST(the_least_legal_size) {
    const auto fitted = [](double seconds, double least) {
        const vox_timing timings[] = {{0.73, seconds}, {1.1, 1.7}, {1.65, 4.4}};
        return fit_timings(with_powers({.least_cell_size = least}, 1), timings, heap).cell_size;
    };
    ck_assert_double_gt(fitted(1.35, 0), 0.75);
    ck_assert_double_lt(fitted(1.35, 0), 0.9);
    ck_assert_double_eq(fitted(1.35, 0.73), 0.73);
    ck_assert_double_gt(fitted(1.35, 0.72), 0.75); // no timing is there
    ck_assert_double_gt(fitted(1.5, 0.73), 0.75);  // there is more to gain
}
END_TEST

// Costs that no fit describes: the answer is never far from the best of what was run.
START_TEST(unusual_costs) {
    const Cost costs[] = {
        [](double) { return 1e-3; },                                         // flat
        [](double size) { return 1e-3 * std::ceil(valley(size) * 300); },    // a coarse clock
        [](double size) { return std::exp(4 * std::fabs(std::log(size))); }, // a notch
        [](double size) { return size < 0.7 ? 1e3 * valley(size) : valley(size); },
        // Two minima, as of a table that must be larger for small cells.
        [](double size) {
            return 1 + 0.5 * std::cos(6 * std::log(size)) + 0.3 * std::pow(std::log(size), 2);
        },
        [](double size) { return 1e29 / size; },
    };
    for (const Cost& cost : costs) {
        for (const std::uint32_t max_runs : {3u, 7u, 32u}) {
            const vox_cell_size_result tuning = tune({}, tune_from(1.1, max_runs), cost, heap);
            double best = infinity;
            for (std::uint32_t i = 0; i < tuning.timing_count; ++i)
                best = std::min(best, tuning.timings[i].seconds);
            // Three runs say little of a notch.
            const double most = max_runs == 3 ? 2.5 : 1.35;
            ck_assert_double_le(cost(tuning.cell_size), most * best);
            ck_assert_uint_le(tuning.timing_count, max_runs);
        }
    }
}
END_TEST

// Where planes of a lattice fall between cells, a size beside the smooth minimum is faster than any fit
// shows.
START_TEST(a_notch_beside_the_minimum) {
    for (const double at : {-0.25, 0.25}) {
        const Cost cost = [=](double size) {
            return valley(size) * (std::fabs(std::log2(size) - at) < 0.1 ? 0.8 : 1);
        };
        const vox_cell_size_result tuning = tune({}, tune_from(1), cost, heap);
        ck_assert_double_eq_tol(std::log2(tuning.cell_size), at, 0.1);
        ck_assert_uint_le(tuning.timing_count, 7);
    }
}
END_TEST

// Costs that rise or fall at some size, as where a table no longer fits into a cache. Where the fits promise
// more than any run has shown, it is run there; and what was fast is not given up for what is only fitted.
START_TEST(costs_with_a_jump) {
    int slower_than_a_run = 0;
    std::vector<double> losses;
    for (const double jump : {0.75, 1.3}) {
        for (std::uint64_t trial = 0; trial < 100; ++trial) {
            Random random{trial};
            const double at = std::exp2(3 * random.unit() - 1.5), first = std::exp2(2 * random.unit() - 1);
            const Cost cost = [&](double size) { return 1e-3 * (size + 1 / size) * (size > at ? jump : 1); };
            const vox_cell_size_result tuning = tune({}, tune_from(first), cost, heap);
            double best = infinity;
            for (std::uint32_t i = 0; i < tuning.timing_count; ++i)
                best = std::min(best, tuning.timings[i].seconds);
            slower_than_a_run += cost(tuning.cell_size) > 1.06 * best;
            losses.push_back(cost(tuning.cell_size) / std::min(least_cost(cost, 1), best) - 1);
        }
    }
    std::sort(losses.begin(), losses.end());
    ck_assert_int_le(slower_than_a_run, 2);
    ck_assert_double_le(losses[losses.size() * 9 / 10], 0.15);
}
END_TEST

// One run is many times faster than all others, as one that did nothing, and hardly anything is read there:
// some fits are of reads alone, and 0 where there are none.
START_TEST(one_run_did_nothing) {
    for (double fast = 1e-5; fast < 1; fast *= 1.7) {
        for (const double few : {0.3, 0.03, 0.003}) {
            const WorkAt work = [&](double size) {
                vox_foreign_counts w{};
                w.stored = 12;
                w.reads = size < 0.9 ? 0 : size < 1.1 ? few : 3.4;
                w.visits = w.occupied = 2 - 0.04 * w.reads;
                return w;
            };
            const CostBasis basis = described_basis(work, {0, 73, 36, 0, 6.2, 2.6, 0});
            const double seconds[] = {fast, 2.5, 2.5, 4.25, 8.125, 8.125, 8.125};
            int run = 0;
            const vox_cell_size_result tuning = tune(
                basis, tune_from(1), [&](double) { return seconds[run++]; }, heap);
            ck_assert(std::isfinite(tuning.cost) && std::isfinite(tuning.expected_loss));
            ck_assert_double_gt(tuning.cost, 0);
        }
    }
}
END_TEST

// A weight beyond all measure, of what is not there at the size that was fastest.
START_TEST(expected_beyond_measure) {
    const WorkAt work = [](double size) {
        vox_foreign_counts w{};
        w.visits = 10 / size;
        w.empty = size < 2 ? 0 : w.visits;
        w.reads = size;
        return w;
    };
    const CostBasis basis = described_basis(work, {1, 1, 1, 1e38, 1, 0, 0});
    const vox_cell_size_result tuning = tune(
        basis, tune_from(4), [](double size) { return size / 4 + 4 / size; }, heap);
    ck_assert(std::isfinite(tuning.cost) && std::isfinite(tuning.fit_error));
    ck_assert_double_lt(tuning.cost, 100);
}
END_TEST

// Noise is seen, and a run that contradicts another at the same size is said.
START_TEST(what_is_said_of_noise) {
    int said = 0;
    for (std::uint64_t trial = 0; trial < 20; ++trial) {
        Machine machine{valley, 0.3, 0.3, {trial}};
        const vox_cell_size_result tuning = tune({}, tune_from(1), std::ref(machine), heap);
        said += (tuning.warnings & VOX_CELL_SIZE_TIMINGS_DISAGREE) != 0;
    }
    ck_assert_int_ge(said, 12);
}
END_TEST

// The description is of another grid: the answer is still right, and the warning says so.
START_TEST(wrong_description) {
    const WorkAt work = boxes_in_cells(2, 2e4);
    const WorkAt wrong = [&](double size) { return work(64 * size); };
    const CostBasis basis = described_basis(wrong, {0, 1, 1, 0, 50, 0, 0});
    const Cost& cost = valley;
    const vox_cell_size_result tuning = tune(basis, tune_from(1), cost, heap);
    ck_assert_uint_ne(tuning.warnings & VOX_CELL_SIZE_MODEL_DISAGREES, 0);
    ck_assert_double_le(cost(tuning.cell_size), 1.05 * least_cost(cost, 1));
}
END_TEST

} // namespace

SUITE(tune) {
    TCase* tests = add_case(suite, "tune");
    tcase_add_test(tests, least_squares_are_least);
    tcase_add_test(tests, columns_that_say_nothing);
    tcase_add_test(tests, fit_of_three_timings);
    tcase_add_test(tests, what_cannot_be_told_apart);
    tcase_add_test(tests, warnings_of_a_fit);
    tcase_add_test(tests, one_slow_timing);
    tcase_add_test(tests, tuned_on_a_noisy_machine);
    tcase_add_test(tests, tuned_without_disturbances);
    tcase_add_test(tests, tuned_with_exact_times);
    tcase_add_test(tests, sizes_that_cannot_run);
    tcase_add_test(tests, stopped_and_too_short);
    tcase_add_test(tests, ends_of_the_range);
    tcase_add_test(tests, the_least_legal_size);
    tcase_add_test(tests, unusual_costs);
    tcase_add_test(tests, a_notch_beside_the_minimum);
    tcase_add_test(tests, costs_with_a_jump);
    tcase_add_test(tests, one_run_did_nothing);
    tcase_add_test(tests, expected_beyond_measure);
    tcase_add_test(tests, what_is_said_of_noise);
    tcase_add_test(tests, wrong_description);
}
