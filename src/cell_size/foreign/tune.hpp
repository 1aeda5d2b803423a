// The best cell size of a grid, by running it at few of them.
#pragma once

#include "cell_size/foreign/fit.hpp"
#include "cell_size/search.hpp"

#include <vox/vox_cell_size.h>

#include <cstdint>
#include <functional>
#include <memory_resource>

namespace vox {

// How to tune, and where; checked. `first` is in the range, whose min is at least the smallest size that
// gives right answers.
struct TuneSettings : FitSettings {
    std::uint32_t max_runs = 7;
    double wanted_loss = 0.02;
    double first = 1;
    CellSizeRange range{1 / 8., 8};
};

// As vox_foreign_run.
using GridRun = std::function<double(double cell_size)>;

// `described` is null where nothing is known of the grid. Throws INVALID_STATE if no run succeeded,
// INVALID_ARGUMENT for times that cannot be.
vox_cell_size_result tune(const CostBasis* described, const TuneSettings& settings, const GridRun& run,
                          std::pmr::memory_resource* memory);

} // namespace vox
