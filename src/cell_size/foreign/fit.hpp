// A cost as a sum of terms with coefficients >= 0, fitted to timings. The terms are the counts of a grid that
// is described, and their coefficients its weights, or powers of the cell size where nothing is known.
#pragma once

#include "cell_size/foreign/cost.hpp"
#include "cell_size/foreign/least_squares.hpp"
#include "cell_size/search.hpp"

#include <vox/vox_cell_size.h>

#include <cstdint>
#include <functional>
#include <memory_resource>
#include <span>

namespace vox {

using Coefficients = NonNegativeLeastSquares::Coefficients;

// What a cost is a sum of.
struct CostBasis {
    std::size_t count = 0;                                // of the terms
    std::function<Coefficients(double cell_size)> values; // of the terms, >= 0
    Coefficients expected{}; // coefficients in any unit: what timings cannot tell apart is divided like these
};

// The terms of vox_foreign_weights, in its order.
CostBasis described_basis(const WorkAt& work, const vox_foreign_weights& expected);

// Powers -3 to 3 of the cell size. A sum of them is convex in the logarithm. That of the expected
// coefficients is least at `middle`, and costs 5 % more at 0.78 and 1.29 of it, as the paper's cost does.
CostBasis power_basis(double middle);

// The described terms, and powers behind them for what they lack, which nothing is expected of; or powers
// alone.
CostBasis with_powers(const CostBasis* described, double middle);

// Throws LIMIT where a term is more than most_counted at that size. `what` the size is, for the text.
void check_countable(const CostBasis& basis, double cell_size, const char* what);

double cost_of(const Coefficients& values, const Coefficients& coefficients) noexcept;
vox_foreign_weights weights_of(const Coefficients& seconds) noexcept; // of described_basis; in nanoseconds

// A timing, and the terms at its cell size.
struct TimedTerms {
    double seconds; // from least_seconds to most_seconds
    Coefficients values;
    double weight = 1; // of its squared error
};

// Squares of ratios of such times are finite.
inline constexpr double least_seconds = 1e-30, most_seconds = 1e30;

// Coefficients by least squares of the relative errors (fitted / measured - 1).
class CostFit {
public:
    // The share of each term at `middle` is pulled weakly towards the expected one, as a sixteenth of a
    // timing would. This settles what timings cannot tell apart. `middle` has the terms at one cell size.
    CostFit(const CostBasis& basis, const Coefficients& middle) noexcept;

    // In seconds. At least one timing.
    Coefficients operator()(std::span<const TimedTerms> timings) const noexcept;

private:
    std::size_t count_;
    Coefficients scale_{}; // of a term, so that it is 1 at `middle`; 0 where it is 0 there
    Coefficients
        expected_{}; // shares at `middle`; for terms that are 0 there, of the whole for each one, at most all
};

// Sets the weights of the timings: those far above the curve count less, as something else was running then.
Coefficients fit_robustly(const CostFit& fit, std::span<TimedTerms> timings) noexcept;

// Root mean square of (fitted / measured - 1).
double relative_error(std::span<const TimedTerms> timings, const Coefficients& coefficients) noexcept;

// Beyond this error the counts do not describe the grid: three times what noise of 5 % does.
inline constexpr double disagreeing_model = 0.15;
// Timings at one cell size disagree beyond this ratio: five times what noise of 5 % does.
inline constexpr double disagreeing_timings = 1.25;

struct FitSettings {
    double least_cell_size = 0; // that is legal; 0: any
    double zone_loss = default_zone_loss;
};

// What both fit and tune say of the best size: its cost, the zone within `range`, the curve, and whether it
// is the smallest that gives right answers.
void write_best(const CostMinimum& best, const CostFunction& cost, const CellSizeRange& range,
                const FitSettings& settings, vox_cell_size_result& result);

// How far timings are from a tuning's fit to them, `all`, and, where a grid is described, the weights of a
// fit without powers. `middle` as for CostFit. Changes the weights of the timings.
void write_errors(const CostBasis* described, const Coefficients& middle, std::span<TimedTerms> timings,
                  const Coefficients& all, vox_cell_size_result& result);

// Throws INVALID_ARGUMENT for timings that vox_cell_size.h does not allow.
vox_cell_size_result fit_timings(const CostBasis& described, const FitSettings& settings,
                                 std::span<const vox_timing> timings, std::pmr::memory_resource* memory);

} // namespace vox
