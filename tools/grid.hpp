// Makes grids with meshes in them, and reads their results.
#pragma once

#include <vox/vox.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace tool {

struct GridDeleter {
    void operator()(vox_grid* grid) const noexcept { vox_grid_destroy(grid); }
};
using Grid = std::unique_ptr<vox_grid, GridDeleter>;

// Creates a grid and inserts the meshes, whose positions it borrows. ids[i] names meshes[i].
Grid make_grid(const vox_grid_desc& desc, std::span<const vox_mesh_desc> meshes, std::vector<vox_body>& ids);

// A copy of the grid's counters and times, by name.
using Counters = std::vector<vox_counter>;
Counters counters_of(const vox_grid* grid);
std::uint64_t value_of(const Counters& counters, std::string_view name);
inline bool is_time(const vox_counter& counter) { return std::string_view(counter.name).ends_with("_ns"); }
vox_grid_info info_of(const vox_grid* grid);
std::uint64_t hash_of(const vox_grid* grid);
std::span<const vox_contact> contacts_of(const vox_grid* grid);
// Throws Failure if constraints were not found since the last step.
std::span<const vox_constraint> constraints_of(const vox_grid* grid);

// The median of each counter. There must be at least one sample.
Counters median(std::span<const Counters> steps);

// Runs a step for timing, which processes all meshes even if none has moved since the last step.
void step_anew(vox_grid* grid, std::span<const vox_body> ids);

} // namespace tool
