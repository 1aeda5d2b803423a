#include "stepping.hpp"

#include "failure.hpp"
#include "terminal.hpp"

#include <algorithm>

namespace tool {

Grid make_grid(const vox_grid_desc& desc, std::span<const Body> bodies, bool self_collision,
               std::vector<vox_mesh>& ids) {
    vox_grid* created = nullptr;
    check(vox_grid_create(&desc, &created));
    Grid grid(created);
    ids.clear();
    for (const Body& body : bodies) {
        vox_mesh_desc mesh = mesh_desc(body);
        if (self_collision) mesh.flags |= VOX_MESH_SELF_COLLISION;
        vox_mesh id = VOX_NULL_MESH;
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
    check(vox_grid_counters(grid, &counters));
    return counters;
}

double cell_size_of(const vox_grid* grid) {
    double cell_size = 0;
    check(vox_grid_cell_size(grid, &cell_size));
    return cell_size;
}

vox_contact_view contacts_of(const vox_grid* grid) {
    vox_contact_view view{};
    check(vox_grid_contacts(grid, &view));
    return view;
}

vox_penetration_view penetrations_of(const vox_grid* grid) {
    vox_penetration_view view{};
    check(vox_grid_penetrations(grid, &view));
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
    for (const auto time : {&vox_profile::step_ns, &vox_profile::bin_ns, &vox_profile::broad_ns,
                            &vox_profile::narrow_ns, &vox_profile::contacts_ns, &vox_profile::depth_ns,
                            &vox_profile::stream_ns, &vox_profile::winding_ns, &vox_profile::broad_phase_ns,
                            &vox_profile::windows_ns, &vox_profile::lookup_ns, &vox_profile::decide_ns})
        result.*time = median_of(time);
    return result;
}

void step_anew(vox_grid* grid, std::span<const vox_mesh> ids) {
    for (const vox_mesh id : ids) check(vox_mesh_mark_moved(grid, id));
    check(vox_grid_step(grid));
}

vox_profile measure_steps(vox_grid* grid, std::span<const vox_mesh> ids, std::uint32_t repeat) {
    Progress progress;
    check(vox_grid_step(grid));
    std::vector<vox_profile> profiles;
    for (std::uint32_t i = 0; i < repeat; ++i) {
        progress.show("step " + std::to_string(i + 1) + " of " + std::to_string(repeat));
        step_anew(grid, ids);
        profiles.push_back(profile_of(grid));
    }
    return median(profiles);
}

} // namespace tool
