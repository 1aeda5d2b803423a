// The C border of pairs, events, contacts of a mesh or a pair, and their readings.

#include "base/border.hpp"
#include "grid/grid.hpp"

#include <cstddef>
#include <initializer_list>
#include <span>

using namespace vox;

namespace {

std::span<const vox_contact> contacts_of(const vox_grid& grid) noexcept {
    const vox_contact_view view = grid.contacts();
    return {view.data, static_cast<std::size_t>(view.count)};
}

std::span<const vox_reading> readings_of(const vox_grid& grid) { return grid.readings(); }

// Copies items of contacts, of which all_of(grid) has one for each: those of one mesh, or those between two
// meshes. `name` is that of the parameter `items`.
template <class Item>
vox_result copy_items(const vox_grid* grid, std::initializer_list<vox_mesh> meshes, Item* items,
                      const char* name, std::uint64_t capacity, std::uint64_t* out_count,
                      std::span<const Item> (*all_of)(const vox_grid&)) {
    return border(grid, "grid", out_count, "out_count", [&] {
        if (capacity > 0) require(items, name);
        for (const vox_mesh mesh : meshes) (void)grid->mesh(mesh); // throws for an id that names no mesh
        const std::span<const Item> all = all_of(*grid);
        std::uint64_t count = 0;
        grid->events().for_contacts_of(meshes, [&](std::uint32_t index) {
            if (count < capacity) items[count] = all[index];
            ++count;
        });
        return count;
    });
}

} // namespace

vox_result vox_grid_pairs(const vox_grid* grid, vox_pair_view* out_view) {
    return border(grid, "grid", out_view, "out_view", [&]() -> vox_pair_view {
        const std::span<const vox_pair> pairs = grid->events().pairs();
        return {pairs.data(), sizeof(vox_pair), pairs.size(), grid->epoch(), grid->events().pair_contacts()};
    });
}

vox_result vox_mesh_copy_contacts(const vox_grid* grid, vox_mesh mesh, vox_contact* contacts,
                                  uint64_t capacity, uint64_t* out_count) {
    return copy_items(grid, {mesh}, contacts, "contacts", capacity, out_count, contacts_of);
}

vox_result vox_pair_copy_contacts(const vox_grid* grid, vox_mesh mesh_a, vox_mesh mesh_b,
                                  vox_contact* contacts, uint64_t capacity, uint64_t* out_count) {
    return copy_items(grid, {mesh_a, mesh_b}, contacts, "contacts", capacity, out_count, contacts_of);
}

vox_result vox_grid_touch_events(const vox_grid* grid, vox_touch_view* out_view) {
    return border(grid, "grid", out_view, "out_view",
                  [&] { return grid->events().touch_events(grid->epoch()); });
}

vox_result vox_grid_contact_events(const vox_grid* grid, vox_contact_event_view* out_view) {
    return border(grid, "grid", out_view, "out_view",
                  [&] { return grid->events().contact_events(grid->epoch()); });
}

// ---- readings -------------------------------------------------------------------------------------

vox_result vox_grid_prepare_readings(vox_grid* grid) {
    return border(grid, "grid", [&] { grid->prepare_readings(); });
}

vox_result vox_grid_readings(const vox_grid* grid, vox_reading_view* out_view) {
    return border(grid, "grid", out_view, "out_view", [&]() -> vox_reading_view {
        const std::span<const vox_reading> readings = grid->readings();
        return {readings.data(), sizeof(vox_reading), readings.size(), grid->epoch()};
    });
}

vox_result vox_mesh_copy_readings(const vox_grid* grid, vox_mesh mesh, vox_reading* readings,
                                  uint64_t capacity, uint64_t* out_count) {
    return copy_items(grid, {mesh}, readings, "readings", capacity, out_count, readings_of);
}

vox_result vox_pair_copy_readings(const vox_grid* grid, vox_mesh mesh_a, vox_mesh mesh_b,
                                  vox_reading* readings, uint64_t capacity, uint64_t* out_count) {
    return copy_items(grid, {mesh_a, mesh_b}, readings, "readings", capacity, out_count, readings_of);
}
