// Grids that people have, as they are described and what their work takes.
#pragma once

#include <vox/vox.h>

#include <cstdint>

namespace vox {

struct KnownGrid {
    vox_cell_content content;
    vox_cell_look look;
    std::uint32_t flags; // vox_foreign_flags
    vox_grid_weights weights;
};

// `known` must be one of vox_known_grid.
const KnownGrid& known_grid(vox_known_grid known) noexcept;

} // namespace vox
