// Makes grids with meshes in them, and reads their results.
#pragma once

#include <vox/vox.h>

#include <cstdint>
#include <cstring>
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

// What the grid counts and times, by name: a copy of its counters.
using Counters = std::vector<vox_counter>;
Counters counters_of(const vox_grid* grid);
std::uint64_t value_of(const Counters& counters, std::string_view name);
inline bool is_time(const vox_counter& counter) { return std::string_view(counter.name).ends_with("_ns"); }
vox_grid_info info_of(const vox_grid* grid);
std::uint64_t hash_of(const vox_grid* grid);
vox_contact_view contacts_of(const vox_grid* grid);
vox_penetration_view penetrations_of(const vox_grid* grid);
vox_edge_contact_view edge_contacts_of(const vox_grid* grid);
vox_depth_view edge_depths_of(const vox_grid* grid);

// Whether the grid has a margin, and its results.
bool has_margin(const vox_grid* grid);
std::vector<vox_margin_contact> margin_contacts_of(const vox_grid* grid);
std::vector<vox_passage> passages_of(const vox_grid* grid);

inline vox_contact contact_at(const vox_contact_view& view, std::uint64_t index) {
    vox_contact contact;
    std::memcpy(&contact, reinterpret_cast<const char*>(view.data) + index * view.byte_stride,
                sizeof contact);
    return contact;
}

inline vox_penetration penetration_at(const vox_penetration_view& view, std::uint64_t index) {
    vox_penetration penetration;
    std::memcpy(&penetration, reinterpret_cast<const char*>(view.data) + index * view.byte_stride,
                sizeof penetration);
    return penetration;
}

inline vox_edge_contact edge_contact_at(const vox_edge_contact_view& view, std::uint64_t index) {
    vox_edge_contact contact;
    std::memcpy(&contact, reinterpret_cast<const char*>(view.data) + index * view.byte_stride,
                sizeof contact);
    return contact;
}

inline vox_depth depth_at(const vox_depth_view& view, std::uint64_t index) {
    vox_depth depth;
    std::memcpy(&depth, reinterpret_cast<const char*>(view.data) + index * view.byte_stride, sizeof depth);
    return depth;
}

// The median of each, taken separately. There must be at least one.
Counters median(std::span<const Counters> steps);

// Runs a step for timing, which processes all meshes even if none has moved since the last step.
void step_anew(vox_grid* grid, std::span<const vox_body> ids);

bool has_penetrations(const vox_grid* grid);
bool has_edge_contacts(const vox_grid* grid);

} // namespace tool
