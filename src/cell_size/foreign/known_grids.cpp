#include "cell_size/foreign/known_grids.hpp"

#include <array>
#include <cstddef>

namespace vox {

namespace {

// In nanoseconds: fixed, entries, visits, found, reads, occupied, cells. bench/foreign/fit_known.py finds and
// prints them; only their proportions matter. Those of HASHED, and below those of dense grids of boxes, are
// not quite the best in generated scenes: they lose less with real bodies.
constexpr std::array<KnownGrid, VOX_KNOWN_GRID_NUMPY + 1> known_grids{{
    /* ANY */ {VOX_CELLS_HOLD_BOXES, VOX_LOOK_BOX, 0, {0, 0, 0, 0, 0, 0, 0}},
    /* SORTED */ {VOX_CELLS_HOLD_BOXES, VOX_LOOK_BOX, VOX_FOREIGN_DENSE, {0, 21, 0.34, 0, 3.6, 0, 0.53}},
    /* HASHED */ {VOX_CELLS_HOLD_BOXES, VOX_LOOK_BOX, 0, {0, 100, 10, 0, 3, 100, 0}},
    /* WARP */ {VOX_CELLS_HOLD_CENTRES, VOX_LOOK_BOX, 0, {0, 0, 5.2, 10, 3.1, 110, 0}},
    /* IPC */ {VOX_CELLS_HOLD_BOXES, VOX_LOOK_BOX, 0, {0, 0, 0, 0, 15, 3.4, 0}},
    /* IPC_PAIRS */ {VOX_CELLS_HOLD_BOXES, VOX_LOOK_PAIRS, 0, {0, 73, 36, 0, 6.2, 2.6, 0}},
    /* VTK */ {VOX_CELLS_HOLD_BOXES, VOX_LOOK_BOX, VOX_FOREIGN_DENSE, {0, 49, 0, 220, 3.6, 0, 0}},
    /* PBAT */ {VOX_CELLS_HOLD_CENTRES, VOX_LOOK_AROUND, 0, {0, 0, 0, 0, 150, 0, 0}},
    /* POINT_VOXELS */ {VOX_CELLS_HOLD_CENTRES, VOX_LOOK_BOX, 0, {0, 0, 21, 0, 1.8, 1100, 0}},
    /* NUMPY */ {VOX_CELLS_HOLD_BOXES, VOX_LOOK_BOX, 0, {0, 140, 150, 260, 87, 0, 0}},
}};

} // namespace

const KnownGrid& known_grid(vox_known_grid known) noexcept {
    return known_grids[static_cast<std::size_t>(known)];
}

vox_grid_weights weights_of_any(vox_cell_content content, vox_cell_look look, bool dense) noexcept {
    if (look == VOX_LOOK_PAIRS) return {0, 73, 36, 0, 6.2, 2.6, 0};
    if (look == VOX_LOOK_AROUND) return {0, 0, 0, 0, 150, 0, 0};
    if (content == VOX_CELLS_HOLD_BOXES)
        return dense ? vox_grid_weights{0, 23, 0, 60, 3, 8, 1} : vox_grid_weights{0, 3.2, 67, 79, 11, 0, 0};
    return dense ? vox_grid_weights{0, 0, 0.67, 0.15, 7.6, 0, 1.6}
                 : vox_grid_weights{0, 0, 15, 0.14, 2.5, 120, 0};
}

// As bench/foreign finds. For hashed grids of boxes, measured gains miss the modelled ones by 0.13 (root mean
// square), and most of those up to 0.16 were losses; in dense grids of boxes all were gains.
double doubtful_gain(vox_cell_content content, vox_cell_look look, bool dense) noexcept {
    return content == VOX_CELLS_HOLD_BOXES && look == VOX_LOOK_BOX && !dense ? 0.16 : 0;
}

} // namespace vox
