// Fits a polynomial to measured times, and finds the best cell size and the zone around it.
#pragma once

#include <cstddef>
#include <span>

namespace vox::sim {

constexpr std::size_t max_fit_degree = 8;

// ln(time) over ln(cell size), as a power series in u = -1 ... 1 over the range of the cell sizes.
struct TimeFit {
    std::size_t degree = 0;
    double range_min = 0, range_max = 0;          // of the cell sizes
    double coefficients[max_fit_degree + 1] = {}; // of u^0, u^1, ...
    double r_squared = 0;                         // of the logarithms
    double prediction_error = 0;                  // leave-one-out, root mean square of the logarithms
    double cell_size = 0;                         // of the least fitted time
    double time = 0;                              // that time
    bool bracketed = false;                       // it lies inside the range, not at one end

    double at(double cell_size) const; // fitted time
};

struct FitZone {
    double min, max;
};

// For positive finite numbers, with at least five different cell sizes.
TimeFit fit_times(std::span<const double> cell_sizes, std::span<const double> times);

// The cell sizes around the best one where the fitted time is at most `limit` (not below the best one's).
// Ends at the end of the range where the time stays below the limit up to there.
FitZone fit_zone(const TimeFit& fit, double limit);

} // namespace vox::sim
