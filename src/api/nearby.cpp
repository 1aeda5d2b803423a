// The C border of margin contacts and passages.

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

vox_result vox_grid_passages(const vox_grid* grid, vox_passage_view* out_view) {
    return border(grid, "grid", out_view, "out_view", [&] { return grid->passages(); });
}

vox_result vox_grid_margin_contacts(const vox_grid* grid, vox_margin_contact_view* out_view) {
    return border(grid, "grid", out_view, "out_view", [&] { return grid->margin_contacts(); });
}
