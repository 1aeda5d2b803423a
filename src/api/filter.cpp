#include "api/filter.hpp"

#include "base/border.hpp"
#include "base/structs.hpp"
#include "grid/grid.hpp"
#include "mesh/filter.hpp"

vox_filter vox::read_filter(const vox_filter* given) {
    if (!given) return filter_defaults();
    vox_filter filter = read_struct(given, filter_defaults(), "filter");
    filter.struct_size = sizeof filter;
    check_filter(filter);
    return filter;
}

void vox::refuse_zeroed(const vox_filter& filter) {
    if (filter.group != 0 || filter.category != 0 || filter.mask != 0 || filter.self_collision != 0) return;
    throw Error(
        VOX_ERROR_INVALID_ARGUMENT,
        "filter has group, category, mask and self_collision 0, so that its mesh would collide with nothing: "
        "fill it with vox_filter_init or vox_default_filter; vox_body_set_enabled takes a mesh out");
}

bool vox::read_enabled(std::uint32_t enabled) {
    if (enabled > 1)
        throw Error(VOX_ERROR_INVALID_ARGUMENT, format("enabled is %u, expected 0 or 1", enabled));
    return enabled != 0;
}

using namespace vox;

vox_result vox_filter_init(vox_filter* filter, uint32_t struct_size) {
    return border([&] { init_struct(filter, struct_size, filter_defaults(), "filter"); });
}

vox_result vox_body_set_filter(vox_grid* grid, vox_body body, const vox_filter* filter) {
    return border(grid, "grid", [&] {
        require(filter, "filter");
        const vox_filter read = read_filter(filter);
        refuse_zeroed(read);
        grid->set_filter(body, read);
    });
}

vox_result vox_mesh_filter(const vox_grid* grid, vox_body body, vox_filter* out_filter) {
    return border(grid, "grid", [&] { write_struct(out_filter, grid->mesh(body).filter(), "out_filter"); });
}

vox_result vox_body_set_enabled(vox_grid* grid, vox_body body, uint32_t enabled) {
    return border(grid, "grid", [&] { grid->set_enabled(body, read_enabled(enabled)); });
}

vox_result vox_grid_set_pair_enabled(vox_grid* grid, vox_body body_a, vox_body body_b, uint32_t enabled) {
    return border(grid, "grid", [&] { grid->set_pair_enabled(body_a, body_b, read_enabled(enabled)); });
}
