// Fits a polynomial to measured times, and finds the best cell size and the zone around it.
#pragma once

#include <cstddef>
#include <span>

namespace tool {

constexpr std::size_t max_fit_degree = 8;

// A polynomial fitted to the logarithms of times: ln(time) = sum of coefficients[k] * u^k for k = 0 to
// degree, where u goes from -1 at range_min to 1 at range_max and is linear in ln(cell size).
struct TimeFit {
    std::size_t degree;          // 2 or more, the one with the least prediction_error
    double range_min, range_max; // smallest and largest cell size
    double coefficients[max_fit_degree + 1];
    double r_squared;        // share of the variance of ln(time) that is explained
    double prediction_error; // root mean square error of predicting each point from a fit to all others, in
                             // ln(time), so roughly a relative error
    double cell_size;        // of the least fitted time
    double time;             // that time, in the unit of the times given
    bool bracketed;          // whether cell_size is inside the range; otherwise the best may be beyond it
};

struct FitZone {
    double min, max;
};

// For positive finite cell sizes, which may repeat. Throws Failure for a time of 0, and if fewer than five
// cell sizes differ.
TimeFit fit_times(std::span<const double> cell_sizes, std::span<const double> times);

// For a cell size of the range.
double fitted_time(const TimeFit& fit, double cell_size);

// The cell sizes around the best one where the fitted time is at most `limit` (not below the best one's).
// Ends at the end of the range where the time stays below the limit up to there.
FitZone fit_zone(const TimeFit& fit, double limit);

} // namespace tool
