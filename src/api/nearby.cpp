// The C border of the margin and of previous positions.

#include "base/border.hpp"
#include "grid/grid.hpp"
#include "mesh/check.hpp"

using namespace vox;

vox_result vox_grid_set_margin(vox_grid* grid, double margin) {
    return border(grid, "grid", [&] { grid->set_margin(margin); });
}

vox_result vox_mesh_bind_previous_positions(vox_grid* grid, vox_body body, const vox_positions* positions) {
    return border(grid, "grid", [&] {
        const std::uint32_t vertices = grid->mesh(body).vertex_count();
        grid->bind_previous(body, positions && positions->data
                                      ? check_positions_of(vertices, *positions, "positions")
                                      : Positions{});
    });
}
