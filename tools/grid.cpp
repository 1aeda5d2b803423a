#include "grid.hpp"

#include "failure.hpp"

#include <algorithm>

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
    auto info = sized<vox_grid_info>();
    check(vox_grid_get_info(grid, &info));
    return info;
}

std::uint64_t hash_of(const vox_grid* grid) {
    std::uint64_t hash = 0;
    check(vox_grid_get_hash(grid, &hash));
    return hash;
}

std::span<const vox_contact> contacts_of(const vox_grid* grid) {
    vox_contact_view view{};
    check(vox_grid_get_contacts(grid, &view));
    return {view.data, static_cast<std::size_t>(view.count)};
}

std::span<const vox_constraint> constraints_of(const vox_grid* grid) {
    vox_constraint_view view{};
    check(vox_grid_get_constraints(grid, &view));
    return {view.data, static_cast<std::size_t>(view.count)};
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

} // namespace tool
