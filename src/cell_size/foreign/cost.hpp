// The cost of a run of a grid that is described (vox_foreign_grid), from what it does and what each of that
// takes.
#pragma once

#include <vox/vox_cell_size.h>

#include <functional>

namespace vox {

// What a run of a grid does at a cell size. Counts are 0 or more.
using WorkAt = std::function<vox_foreign_counts(double cell_size)>;

// Beyond this a count is of no use: products of such counts and of times leave the range of doubles.
inline constexpr double most_counted = 1e80;

inline double grid_cost(const vox_foreign_counts& work, const vox_foreign_weights& weights) noexcept {
    return weights.run + weights.store * work.stored + weights.visit * work.visits +
           weights.found * (work.visits - work.empty) + weights.read * work.reads +
           weights.occupied * work.occupied + weights.cell * work.cells;
}

} // namespace vox
