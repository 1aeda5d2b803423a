#include "cell_size/foreign/known_grids.hpp"

#include <array>
#include <cstddef>

namespace vox {

namespace {

// In nanoseconds, in the order of vox_foreign_weights. bench/foreign/fit_known.py finds and
// prints them; only their proportions matter. Those of HASHED, and below those of dense grids of boxes, are
// not quite the best in generated scenes: they lose less with real bodies.
constexpr std::array<KnownGrid, VOX_KNOWN_GRID_NUMPY + 1> known_grids{{
    /* NONE */ {VOX_CELLS_STORED_BOX, VOX_CELLS_QUERIED_BOX, VOX_CELLS_KEPT_OCCUPIED, {0, 0, 0, 0, 0, 0, 0}},
    /* SORTED */
    {VOX_CELLS_STORED_BOX, VOX_CELLS_QUERIED_BOX, VOX_CELLS_KEPT_DENSE, {0, 21, 0.34, 0, 3.6, 0, 0.53}},
    /* HASHED */
    {VOX_CELLS_STORED_BOX, VOX_CELLS_QUERIED_BOX, VOX_CELLS_KEPT_OCCUPIED, {0, 100, 10, 0, 3, 100, 0}},
    /* WARP */
    {VOX_CELLS_STORED_CENTRE, VOX_CELLS_QUERIED_BOX, VOX_CELLS_KEPT_OCCUPIED, {0, 0, 5.2, 10, 3.1, 110, 0}},
    /* IPC */
    {VOX_CELLS_STORED_BOX, VOX_CELLS_QUERIED_BOX, VOX_CELLS_KEPT_OCCUPIED, {0, 0, 0, 0, 15, 3.4, 0}},
    /* IPC_PAIRS */
    {VOX_CELLS_STORED_BOX, VOX_CELLS_QUERIED_PAIRS, VOX_CELLS_KEPT_OCCUPIED, {0, 73, 36, 0, 6.2, 2.6, 0}},
    /* VTK */ {VOX_CELLS_STORED_BOX, VOX_CELLS_QUERIED_BOX, VOX_CELLS_KEPT_DENSE, {0, 49, 0, 220, 3.6, 0, 0}},
    /* PBAT */
    {VOX_CELLS_STORED_CENTRE, VOX_CELLS_QUERIED_27, VOX_CELLS_KEPT_OCCUPIED, {0, 0, 0, 0, 150, 0, 0}},
    /* POINT_VOXELS */
    {VOX_CELLS_STORED_CENTRE, VOX_CELLS_QUERIED_BOX, VOX_CELLS_KEPT_OCCUPIED, {0, 0, 21, 0, 1.8, 1100, 0}},
    /* NUMPY */
    {VOX_CELLS_STORED_BOX, VOX_CELLS_QUERIED_BOX, VOX_CELLS_KEPT_OCCUPIED, {0, 140, 150, 260, 87, 0, 0}},
}};

} // namespace

const KnownGrid& known_grid(vox_known_grid known) noexcept {
    return known_grids[static_cast<std::size_t>(known)];
}

vox_foreign_weights weights_of_any(vox_cells_stored stored, vox_cells_queried queried, bool dense) noexcept {
    if (queried == VOX_CELLS_QUERIED_PAIRS) return {0, 73, 36, 0, 6.2, 2.6, 0};
    if (queried == VOX_CELLS_QUERIED_27) return {0, 0, 0, 0, 150, 0, 0};
    if (stored == VOX_CELLS_STORED_BOX)
        return dense ? vox_foreign_weights{0, 23, 0, 60, 3, 8, 1}
                     : vox_foreign_weights{0, 3.2, 67, 79, 11, 0, 0};
    return dense ? vox_foreign_weights{0, 0, 0.67, 0.15, 7.6, 0, 1.6}
                 : vox_foreign_weights{0, 0, 15, 0.14, 2.5, 120, 0};
}

// As bench/foreign finds. For hashed grids of boxes, measured gains miss the modelled ones by 0.13 (root mean
// square), and most of those up to 0.16 were losses; in dense grids of boxes all were gains.
double doubtful_gain(vox_cells_stored stored, vox_cells_queried queried, bool dense) noexcept {
    return stored == VOX_CELLS_STORED_BOX && queried == VOX_CELLS_QUERIED_BOX && !dense ? 0.16 : 0;
}

} // namespace vox
