// A whole grid as bytes and back: docs/snapshot.md.
#pragma once

#include "grid/snapshot_chunks.hpp"

#include <vox/vox.h>

#include <cstddef>
#include <cstdint>

namespace vox {

// The number of bytes that save_snapshot() writes.
std::uint64_t snapshot_size(const vox_grid& grid) noexcept;
// Reads the grid's arrays and positions, allocates nothing. Returns the number of bytes written.
std::uint64_t save_snapshot(const vox_grid& grid, std::byte* out) noexcept;

// The settings in a snapshot, over a caller's for the machine it runs on (vox_grid_load), checked as a grid
// needs them. Throws Error(FORMAT, UNSUPPORTED).
vox_grid_desc snapshot_settings(SnapshotReader in, const vox_grid_desc& machine);
// Fills a grid made from these settings. Throws Error(FORMAT, UNSUPPORTED, LIMIT, BUDGET) or what the memory
// throws; the grid is then only fit to be destroyed.
void load_snapshot(SnapshotReader in, vox_grid& grid);

} // namespace vox
