// The C border of pairs, events, contacts of a mesh or a pair, and their readings.

#include "base/border.hpp"
#include "base/structs.hpp"
#include "grid/grid.hpp"

#include <cstddef>
#include <initializer_list>
#include <span>

using namespace vox;

namespace {

// Copies items of the contacts of one mesh, or of those between two meshes. items_of(grid) gives a function
// from the index of a contact to its item, or null if it has none. `name` is that of the parameter `items`.
template <class Item, class ItemsOf>
vox_result copy_items(const vox_grid* grid, std::initializer_list<vox_body> meshes, Item* items,
                      const char* name, std::uint64_t capacity, std::uint64_t* out_count,
                      ItemsOf&& items_of) {
    return border(grid, "grid", out_count, "out_count", [&] {
        if (capacity > 0) require(items, name);
        for (const vox_body mesh : meshes) (void)grid->mesh(mesh); // throws for an id that names no mesh
        const auto item_of = items_of(*grid);
        std::uint64_t count = 0;
        grid->events().for_contacts_of(meshes, [&](std::uint32_t index) {
            const Item* item = item_of(index);
            if (item && count < capacity) items[count] = *item;
            count += item != nullptr;
        });
        return count;
    });
}

constexpr auto contacts_of = [](const vox_grid& grid) {
    return [all = grid.contacts().data](std::uint32_t index) { return all + index; };
};

constexpr auto readings_of = [](const vox_grid& grid) {
    return [&readings = grid.readings()](std::uint32_t index) { return readings.find(index); };
};

} // namespace

vox_result vox_grid_get_pairs(const vox_grid* grid, vox_pair_view* out_view) {
    return border(grid, "grid", out_view, "out_view", [&]() -> vox_pair_view {
        const std::span<const vox_pair> pairs = grid->events().pairs();
        return {pairs.data(), sizeof(vox_pair), pairs.size(), grid->epoch(), grid->events().pair_contacts()};
    });
}

vox_result vox_mesh_copy_contacts(const vox_grid* grid, vox_body body, vox_contact* contacts,
                                  uint64_t capacity, uint64_t* out_count) {
    return copy_items(grid, {body}, contacts, "contacts", capacity, out_count, contacts_of);
}

vox_result vox_pair_copy_contacts(const vox_grid* grid, vox_body body_a, vox_body body_b,
                                  vox_contact* contacts, uint64_t capacity, uint64_t* out_count) {
    return copy_items(grid, {body_a, body_b}, contacts, "contacts", capacity, out_count, contacts_of);
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
    return border(grid, "grid", [&] { grid->prepare_readings({}); });
}

vox_result vox_grid_prepare_readings_of(vox_grid* grid, const vox_readings_desc* desc) {
    return border(grid, "grid",
                  [&] { grid->prepare_readings(desc ? read_struct(desc, "desc") : vox_readings_desc{}); });
}

vox_result vox_grid_readings(const vox_grid* grid, vox_reading_view* out_view) {
    return border(grid, "grid", out_view, "out_view", [&]() -> vox_reading_view {
        const std::span<const vox_reading> readings = grid->readings().all();
        return {readings.data(), sizeof(vox_reading), readings.size(), grid->epoch()};
    });
}

vox_result vox_grid_reading_depths(const vox_grid* grid, vox_depth_view* out_view) {
    return border(grid, "grid", out_view, "out_view", [&]() -> vox_depth_view {
        const std::span<const vox_depth> depths = grid->readings().depths();
        return {depths.data(), sizeof(vox_depth), depths.size(), grid->epoch()};
    });
}

vox_result vox_mesh_copy_readings(const vox_grid* grid, vox_body body, vox_reading* readings,
                                  uint64_t capacity, uint64_t* out_count) {
    return copy_items(grid, {body}, readings, "readings", capacity, out_count, readings_of);
}

vox_result vox_pair_copy_readings(const vox_grid* grid, vox_body body_a, vox_body body_b,
                                  vox_reading* readings, uint64_t capacity, uint64_t* out_count) {
    return copy_items(grid, {body_a, body_b}, readings, "readings", capacity, out_count, readings_of);
}
