// The C border of what touches: pairs, events, contacts of a mesh.

#include "border.hpp"
#include "grid.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

using namespace vox;

vox_result vox_grid_pairs(const vox_grid* grid, vox_pair_view* out_view) {
    return border([&] {
        require(grid, "grid");
        require(out_view, "out_view");
        const Events& events = grid->events();
        const std::span<const vox_pair> pairs = events.pairs();
        *out_view = {pairs.data(), sizeof(vox_pair), pairs.size(), grid->epoch(), events.pair_contacts()};
    });
}

vox_result vox_mesh_copy_contacts(const vox_grid* grid, vox_mesh mesh, vox_contact* contacts,
                                  uint64_t capacity, uint64_t* out_count) {
    return border([&] {
        require(grid, "grid");
        require(out_count, "out_count");
        if (capacity > 0) require(contacts, "contacts");
        (void)grid->mesh(mesh); // throws for an id that names no mesh
        const vox_contact_view all = grid->contacts();
        // No more can be copied than there are, whatever the capacity.
        const auto room = static_cast<std::size_t>(std::min(capacity, all.count));
        *out_count = grid->events().copy_contacts({all.data, static_cast<std::size_t>(all.count)}, mesh,
                                                  {contacts, room});
    });
}

vox_result vox_grid_touch_events(const vox_grid* grid, vox_touch_view* out_view) {
    return border([&] {
        require(grid, "grid");
        require(out_view, "out_view");
        vox_touch_view view = grid->events().touch_events();
        view.epoch = grid->epoch();
        *out_view = view;
    });
}

vox_result vox_grid_contact_events(const vox_grid* grid, vox_contact_event_view* out_view) {
    return border([&] {
        require(grid, "grid");
        require(out_view, "out_view");
        vox_contact_event_view view = grid->events().contact_events();
        view.epoch = grid->epoch();
        *out_view = view;
    });
}
