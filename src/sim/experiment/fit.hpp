// Fits a polynomial to measured times, and finds the best cell size and the zone around it.
#pragma once

#include <vox/vox_sim.h>

#include <cstddef>
#include <span>

namespace vox::sim {

constexpr std::size_t max_fit_degree = VOX_FIT_CAPACITY - 1;

struct FitZone {
    double min, max;
};

std::size_t count_distinct(std::span<const double> values);

// For positive finite numbers, with at least five different cell sizes.
vox_time_fit fit_times(std::span<const double> cell_sizes, std::span<const double> times);

double fitted_time(const vox_time_fit& fit, double cell_size);

// The cell sizes around the best one where the fitted time is at most `limit` (not below the best one's).
// Ends at the end of the range where the time stays below the limit up to there.
FitZone fit_zone(const vox_time_fit& fit, double limit);

} // namespace vox::sim
