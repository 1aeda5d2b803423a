// The C border of edge contacts.

#include "base/border.hpp"
#include "grid/grid.hpp"

#include <span>

using namespace vox;

vox_result vox_grid_edge_contacts(const vox_grid* grid, vox_edge_contact_view* out_view) {
    return border(grid, "grid", out_view, "out_view", [&]() -> vox_edge_contact_view {
        const std::span<const vox_edge_contact> all = grid->edge_contacts().all();
        return {all.data(), sizeof(vox_edge_contact), all.size(), grid->epoch()};
    });
}

vox_result vox_grid_edge_hash(const vox_grid* grid, uint64_t* out_hash) {
    return border(grid, "grid", out_hash, "out_hash", [&] { return grid->edge_contacts().hash(); });
}

vox_result vox_grid_prepare_edge_depths(vox_grid* grid) {
    return border(grid, "grid", [&] { grid->prepare_edge_depths(); });
}

vox_result vox_grid_edge_depths(const vox_grid* grid, vox_depth_view* out_view) {
    return border(grid, "grid", out_view, "out_view", [&]() -> vox_depth_view {
        const std::span<const vox_depth> depths = grid->edge_contacts().depths();
        return {depths.data(), sizeof(vox_depth), depths.size(), grid->epoch()};
    });
}
