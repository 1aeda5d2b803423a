#include "api/filter.hpp"

#include "base/border.hpp"
#include "base/structs.hpp"
#include "grid/grid.hpp"
#include "mesh/filter.hpp"

bool vox::read_enabled(std::uint32_t enabled) {
    if (enabled > 1)
        throw Error(VOX_ERROR_INVALID_ARGUMENT, format("enabled is %u, expected 0 or 1", enabled));
    return enabled != 0;
}

using namespace vox;

vox_result vox_body_set_filter(vox_grid* grid, vox_body body, const vox_filter* filter) {
    return border(grid, "grid", [&] {
        require(filter, "filter");
        grid->set_filter(body, checked_filter(*filter));
    });
}

vox_result vox_body_set_enabled(vox_grid* grid, vox_body body, uint32_t enabled) {
    return border(grid, "grid", [&] { grid->set_enabled(body, read_enabled(enabled)); });
}

vox_result vox_grid_set_pair_enabled(vox_grid* grid, vox_body body_a, vox_body body_b, uint32_t enabled) {
    return border(grid, "grid", [&] { grid->set_pair_enabled(body_a, body_b, read_enabled(enabled)); });
}
