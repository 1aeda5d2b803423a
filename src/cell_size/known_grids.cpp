#include "cell_size/known_grids.hpp"

#include <array>
#include <cstddef>

namespace vox {

namespace {

// In nanoseconds: fixed, entries, visits, found, reads, occupied, cells.
constexpr std::array<KnownGrid, VOX_KNOWN_GRID_NUMPY + 1> known_grids{{
    /* ANY */ {VOX_CELLS_HOLD_BOXES, VOX_LOOK_BOX, 0, {0, 12, 4, 4, 2, 0, 0}},
    /* SORTED */ {VOX_CELLS_HOLD_BOXES, VOX_LOOK_BOX, VOX_FOREIGN_DENSE, {0, 5, 1, 2, 1, 0, 0.5}},
    /* HASHED */ {VOX_CELLS_HOLD_BOXES, VOX_LOOK_BOX, 0, {0, 15, 12, 8, 1.5, 40, 0}},
    /* WARP */ {VOX_CELLS_HOLD_CENTRES, VOX_LOOK_BOX, 0, {0, 20, 3, 3, 3, 0, 0}},
    /* IPC */ {VOX_CELLS_HOLD_BOXES, VOX_LOOK_BOX, 0, {0, 40, 10, 10, 4, 0, 0}},
    /* IPC_PAIRS */ {VOX_CELLS_HOLD_BOXES, VOX_LOOK_PAIRS, 0, {0, 40, 0, 10, 4, 0, 0}},
    /* VTK */ {VOX_CELLS_HOLD_BOXES, VOX_LOOK_BOX, VOX_FOREIGN_DENSE, {0, 10, 10, 10, 20, 0, 1}},
    /* PBAT */ {VOX_CELLS_HOLD_CENTRES, VOX_LOOK_AROUND, 0, {0, 20, 3, 3, 3, 0, 0}},
    /* POINT_VOXELS */ {VOX_CELLS_HOLD_CENTRES, VOX_LOOK_BOX, 0, {0, 20, 15, 10, 2, 60, 0}},
    /* NUMPY */ {VOX_CELLS_HOLD_BOXES, VOX_LOOK_BOX, 0, {0, 100, 100, 0, 20, 0, 0}},
}};

} // namespace

const KnownGrid& known_grid(vox_known_grid known) noexcept {
    return known_grids[static_cast<std::size_t>(known)];
}

} // namespace vox
