#include "grid.hpp"

#include "failure.hpp"

#include <algorithm>
#include <type_traits>

namespace tool {

Grid make_grid(const vox_grid_desc& desc, std::span<const vox_mesh_desc> meshes, std::vector<vox_body>& ids) {
    vox_grid* created = nullptr;
    check(vox_grid_create(&desc, &created));
    Grid grid(created);
    ids.clear();
    for (const vox_mesh_desc& mesh : meshes) {
        vox_body id = VOX_NULL_BODY;
        check(vox_mesh_insert(grid.get(), &mesh, &id));
        ids.push_back(id);
    }
    return grid;
}

Counters counters_of(const vox_grid* grid) {
    vox_counter_view view{};
    check(vox_grid_get_counters(grid, &view));
    return {view.data, view.data + view.count};
}

std::uint64_t value_of(const Counters& counters, std::string_view name) {
    for (const vox_counter& counter : counters)
        if (counter.name == name) return counter.value;
    throw Failure("vox counts no " + std::string(name));
}

vox_grid_info info_of(const vox_grid* grid) {
    vox_grid_info info{};
    info.struct_size = sizeof info;
    check(vox_grid_get_info(grid, &info));
    return info;
}

std::uint64_t hash_of(const vox_grid* grid) {
    std::uint64_t hash = 0;
    check(vox_grid_get_hash(grid, &hash));
    return hash;
}

vox_contact_view contacts_of(const vox_grid* grid) {
    vox_contact_view view{};
    check(vox_grid_get_contacts(grid, &view));
    return view;
}

vox_penetration_view penetrations_of(const vox_grid* grid) {
    vox_penetration_view view{};
    check(vox_grid_penetrations(grid, &view));
    return view;
}

vox_edge_contact_view edge_contacts_of(const vox_grid* grid) {
    vox_edge_contact_view view{};
    check(vox_grid_edge_contacts(grid, &view));
    return view;
}

vox_depth_view edge_depths_of(const vox_grid* grid) {
    vox_depth_view view{};
    check(vox_grid_edge_depths(grid, &view));
    return view;
}

Counters median(std::span<const Counters> steps) {
    Counters result = steps.front();
    std::vector<std::uint64_t> values(steps.size());
    for (std::size_t c = 0; c < result.size(); ++c) {
        for (std::size_t i = 0; i < steps.size(); ++i) values[i] = steps[i][c].value;
        std::sort(values.begin(), values.end());
        const std::size_t middle = values.size() / 2;
        result[c].value = values.size() % 2 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
    }
    return result;
}

void step_anew(vox_grid* grid, std::span<const vox_body> ids) {
    for (const vox_body id : ids) check(vox_body_mark_moved(grid, id));
    check(vox_grid_step(grid));
}

namespace {

// The elements of a view, which may be larger than this program knows them.
template <class View>
auto elements_of(const View& view) {
    std::vector<std::remove_cvref_t<decltype(*view.data)>> all(view.count);
    for (std::uint64_t i = 0; i < view.count; ++i)
        std::memcpy(&all[i], reinterpret_cast<const char*>(view.data) + i * view.byte_stride, sizeof all[i]);
    return all;
}

bool has_flag(const vox_grid* grid, std::uint32_t flag) { return (info_of(grid).flags & flag) != 0; }

} // namespace

bool has_margin(const vox_grid* grid) { return info_of(grid).margin > 0; }

std::vector<vox_margin_contact> margin_contacts_of(const vox_grid* grid) {
    vox_margin_contact_view view;
    check(vox_grid_margin_contacts(grid, &view));
    return elements_of(view);
}

std::vector<vox_passage> passages_of(const vox_grid* grid) {
    vox_passage_view view;
    check(vox_grid_passages(grid, &view));
    return elements_of(view);
}

bool has_penetrations(const vox_grid* grid) { return has_flag(grid, VOX_GRID_PENETRATIONS); }

bool has_edge_contacts(const vox_grid* grid) { return has_flag(grid, VOX_GRID_EDGE_CONTACTS); }

} // namespace tool
