// Grids that people have, as they are described and what their work takes.
#pragma once

#include <vox/vox_cell_size.h>

#include <cstdint>

namespace vox {

struct KnownGrid {
    vox_cells_stored stored;
    vox_cells_queried queried;
    vox_cells_kept kept;
    vox_foreign_weights weights; // all 0 for NONE: below
};

// `known` must be one of vox_known_grid.
const KnownGrid& known_grid(vox_known_grid known) noexcept;

// Where nothing is known of the times: what loses least in the worst of the known grids that hold, look and
// keep their cells in this way.
vox_foreign_weights weights_of_any(vox_cells_stored stored, vox_cells_queried queried, bool dense) noexcept;

// With those weights a gain over another size may be none where it is smaller than this: the known grids of
// that kind differ so much.
double doubtful_gain(vox_cells_stored stored, vox_cells_queried queried, bool dense) noexcept;

} // namespace vox
