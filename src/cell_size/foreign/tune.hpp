// The best cell size of a grid, by running it at few of them.
#pragma once

#include "cell_size/foreign/fit.hpp"
#include "cell_size/search.hpp"

#include <vox/vox_cell_size.h>

#include <cstdint>
#include <functional>
#include <memory_resource>

namespace vox {

// Sets the fields whose 0 stands for something else.
void complete(vox_tune_desc& desc);

// Throws INVALID_ARGUMENT for what vox_cell_size.h does not allow, whatever the grid.
void check_tune_desc(const vox_tune_desc& desc);

// Where to look, from a desc that was checked. `suggested`: the first cell size where the caller has set
// none; 0: none. `least`: the smallest that gives right answers, or 0. Throws INVALID_ARGUMENT where no cell
// size is left.
struct TuneSettings {
    TuneSettings(const vox_tune_desc& desc, double loss_in_zone, double suggested, double least);

    std::uint32_t max_runs;
    double zone_loss;
    double wanted_loss;
    double least; // legal size, or 0
    double first;
    CellSizeRange range;
};

// As vox_foreign_run.
using GridRun = std::function<double(double cell_size)>;

// `described` is null where nothing is known of the grid. Throws INVALID_STATE if no run succeeded,
// INVALID_ARGUMENT for times that cannot be.
vox_cell_size_result tune(const CostBasis* described, const TuneSettings& settings, const GridRun& run,
                          std::pmr::memory_resource* memory);

} // namespace vox
