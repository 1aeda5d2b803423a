// The C border of what touches: pairs, events, contacts of a mesh or a pair, and their readings.

#include "border.hpp"
#include "grid.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

using namespace vox;

namespace {

std::span<const vox_contact> contacts_of(const vox_grid& grid) noexcept {
    const vox_contact_view view = grid.contacts();
    return {view.data, static_cast<std::size_t>(view.count)};
}

// The caller's array. No more can be copied than there are, whatever the capacity.
template <class T>
std::span<T> room(T* array, std::uint64_t capacity, std::size_t most) noexcept {
    return {array, static_cast<std::size_t>(std::min<std::uint64_t>(capacity, most))};
}

} // namespace

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
        const std::span<const vox_contact> all = contacts_of(*grid);
        *out_count = grid->events().copy_of_mesh(all, mesh, room(contacts, capacity, all.size()));
    });
}

vox_result vox_pair_copy_contacts(const vox_grid* grid, vox_mesh mesh_a, vox_mesh mesh_b,
                                  vox_contact* contacts, uint64_t capacity, uint64_t* out_count) {
    return border([&] {
        require(grid, "grid");
        require(out_count, "out_count");
        if (capacity > 0) require(contacts, "contacts");
        (void)grid->mesh(mesh_a);
        (void)grid->mesh(mesh_b);
        const std::span<const vox_contact> all = contacts_of(*grid);
        *out_count = grid->events().copy_of_pair(all, mesh_a, mesh_b, room(contacts, capacity, all.size()));
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

// ---- readings -------------------------------------------------------------------------------------

vox_result vox_grid_prepare_readings(vox_grid* grid) {
    return border([&] {
        require(grid, "grid");
        grid->prepare_readings();
    });
}

vox_result vox_grid_readings(const vox_grid* grid, vox_reading_view* out_view) {
    return border([&] {
        require(grid, "grid");
        require(out_view, "out_view");
        const std::span<const vox_reading> readings = grid->readings();
        *out_view = {readings.data(), sizeof(vox_reading), readings.size(), grid->epoch()};
    });
}

vox_result vox_mesh_copy_readings(const vox_grid* grid, vox_mesh mesh, vox_reading* readings,
                                  uint64_t capacity, uint64_t* out_count) {
    return border([&] {
        require(grid, "grid");
        require(out_count, "out_count");
        if (capacity > 0) require(readings, "readings");
        (void)grid->mesh(mesh);
        const std::span<const vox_reading> all = grid->readings();
        *out_count = grid->events().copy_of_mesh(all, mesh, room(readings, capacity, all.size()));
    });
}

vox_result vox_pair_copy_readings(const vox_grid* grid, vox_mesh mesh_a, vox_mesh mesh_b,
                                  vox_reading* readings, uint64_t capacity, uint64_t* out_count) {
    return border([&] {
        require(grid, "grid");
        require(out_count, "out_count");
        if (capacity > 0) require(readings, "readings");
        (void)grid->mesh(mesh_a);
        (void)grid->mesh(mesh_b);
        const std::span<const vox_reading> all = grid->readings();
        *out_count = grid->events().copy_of_pair(all, mesh_a, mesh_b, room(readings, capacity, all.size()));
    });
}
