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

vox_profile profile_of(const vox_grid* grid) {
    vox_profile profile{};
    profile.struct_size = sizeof profile;
    check(vox_grid_profile(grid, &profile));
    return profile;
}

vox_counters counters_of(const vox_grid* grid) {
    vox_counters counters{};
    counters.struct_size = sizeof counters;
    check(vox_grid_get_counters(grid, &counters));
    return counters;
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

vox_profile median(std::span<const vox_profile> profiles) {
    std::vector<std::uint64_t> times(profiles.size());
    const auto median_of = [&](std::uint64_t vox_profile::*time) {
        for (std::size_t i = 0; i < profiles.size(); ++i) times[i] = profiles[i].*time;
        std::sort(times.begin(), times.end());
        const std::size_t middle = times.size() / 2;
        return times.size() % 2 ? times[middle] : (times[middle - 1] + times[middle]) / 2;
    };
    vox_profile result = profiles.front();
    for (const auto time :
         {&vox_profile::step_ns, &vox_profile::bin_ns, &vox_profile::broad_ns, &vox_profile::narrow_ns,
          &vox_profile::contacts_ns, &vox_profile::depth_ns, &vox_profile::stream_ns,
          &vox_profile::winding_ns, &vox_profile::broad_phase_ns, &vox_profile::windows_ns,
          &vox_profile::lookup_ns, &vox_profile::decide_ns, &vox_profile::edges_ns, &vox_profile::margin_ns})
        result.*time = median_of(time);
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
