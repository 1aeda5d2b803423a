// A cost as a sum of terms with coefficients >= 0, fitted to timings, and the best cell size of a grid by few
// runs. The terms are the counts of a grid that is described, and their coefficients its weights, or powers
// of the cell size where nothing is known.
#pragma once

#include "cell_size/search.hpp"

#include <vox/vox_cell_size.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory_resource>
#include <span>

namespace vox {

// ---- least squares with no negative coefficient -----------------------------------------------------

using Coefficients = std::array<double, 16>;
// A'A, where each row of A is some columns and, behind them, their target.
using NormalEquations = std::array<Coefficients, 16>;

// The numbers of a row are finite, and so small that their squares are.
void add_row(const Coefficients& row, NormalEquations& equations) noexcept;

// The x >= 0 for which the sum of (row . x - target)^2 is least. A column that is a sum of others, up to
// rounding, has the coefficient 0, as has one of zeros.
Coefficients solve_non_negative(const NormalEquations& equations, std::size_t columns) noexcept;

// ---- terms ------------------------------------------------------------------------------------------

// What a run of a grid does at a cell size. Counts are 0 or more.
using WorkAt = std::function<vox_foreign_counts(double cell_size)>;

// What a cost is a sum of.
struct CostBasis {
    std::size_t count = 0;                                  // of the terms; 0: nothing is known of the grid
    std::function<Coefficients(double cell_size)> values{}; // of the terms, >= 0
    Coefficients expected{}; // coefficients in any unit: what timings cannot tell apart is divided like these
    double least_cell_size = 0; // that is legal; 0: any
    double zone_loss = default_zone_loss;
};

// The terms of vox_foreign_weights, in its order.
CostBasis described_basis(const WorkAt& work, const vox_foreign_weights& expected, double least_cell_size = 0,
                          double zone_loss = default_zone_loss);

// Squares of ratios of such times are finite.
inline constexpr double least_seconds = 1e-30, most_seconds = 1e30;

// Beyond this error the counts do not describe the grid: three times what noise of 5 % does.
inline constexpr double disagreeing_model = 0.15;

// Throws INVALID_ARGUMENT for timings that vox_cell_size.h does not allow.
vox_cell_size_result fit_timings(const CostBasis& described, std::span<const vox_timing> timings,
                                 std::pmr::memory_resource* memory);

// As vox_foreign_run.
using GridRun = std::function<double(double cell_size)>;

// The desc is checked, and no field is 0: its first size is in its range, whose min is at least the smallest
// that gives right answers. Throws INVALID_STATE if no run succeeded, INVALID_ARGUMENT for times that cannot
// be.
vox_cell_size_result tune(const CostBasis& described, const vox_tune_desc& desc, const GridRun& run,
                          std::pmr::memory_resource* memory);

// ---- what both do -----------------------------------------------------------------------------------

// The described terms, and powers -3 to 3 of the cell size behind them for what they lack, which nothing is
// expected of; or powers alone. A sum of powers is convex in the logarithm. That of the expected coefficients
// is least at `middle`, and costs 5 % more at 0.78 and 1.29 of it, as the paper's cost does.
CostBasis with_powers(const CostBasis& described, double middle);

// Throws LIMIT where a term is more than most_counted at that size. `what` the size is, for the text.
void check_countable(const CostBasis& basis, double cell_size, const char* what);

double cost_of(const Coefficients& values, const Coefficients& coefficients) noexcept;

// A timing, and the terms at its cell size.
struct TimedTerms {
    double seconds; // from least_seconds to most_seconds
    Coefficients values;
    double weight = 1; // of its squared error
};

// Coefficients, in seconds, by least squares of the relative errors (fitted / measured - 1) of at least one
// timing. The share of each term at `middle`, which has the terms at one cell size, is pulled weakly towards
// the expected one, as a sixteenth of a timing would. This settles what timings cannot tell apart.
Coefficients fit_once(const CostBasis& basis, const Coefficients& middle,
                      std::span<const TimedTerms> timings) noexcept;
// Sets the weights of the timings: those far above the curve count less, as something else was running then.
Coefficients fit_robustly(const CostBasis& basis, const Coefficients& middle,
                          std::span<TimedTerms> timings) noexcept;

// Writes the best size, the zone within `range`, the curve, and whether it is the smallest that gives right
// answers.
void write_best(const vox_cost_sample& best, const CostFunction& cost, const CellSizeRange& range,
                const CostBasis& basis, vox_cell_size_result& result);

// Writes how far timings are from a tuning's fit to them, `all`, and, where a grid is described, the weights
// of a fit without powers. Changes the weights of the timings.
void write_errors(const CostBasis& described, const Coefficients& middle, std::span<TimedTerms> timings,
                  const Coefficients& all, vox_cell_size_result& result);

} // namespace vox
