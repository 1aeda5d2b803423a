// The C border of pairs and constraints.

#include "base/border.hpp"
#include "base/structs.hpp"
#include "grid/grid.hpp"

#include <cstddef>
#include <span>

using namespace vox;

vox_result vox_grid_get_pairs(const vox_grid* grid, vox_pair_view* out_view) {
    return border(grid, "grid", out_view, "out_view", [&]() -> vox_pair_view {
        const std::span<const vox_pair> pairs = grid->pairs().all();
        return {pairs.data(), pairs.size(), grid->pairs().contacts()};
    });
}

vox_result vox_grid_find_constraints(vox_grid* grid, const vox_constraint_desc* desc) {
    return border(grid, "grid",
                  [&] { grid->find_constraints(desc ? read_struct(desc, "desc") : vox_constraint_desc{}); });
}

vox_result vox_grid_get_constraints(const vox_grid* grid, vox_constraint_view* out_view) {
    return border(grid, "grid", out_view, "out_view", [&] { return grid->constraints(); });
}
