#include "cell_size/foreign/grid.hpp"

#include <cstddef>

namespace vox {

namespace {

constexpr vox_cells_stored box = VOX_CELLS_STORED_BOX, centre = VOX_CELLS_STORED_CENTRE;
constexpr vox_cells_queried by_box = VOX_CELLS_QUERIED_BOX, around = VOX_CELLS_QUERIED_27,
                            pairs = VOX_CELLS_QUERIED_PAIRS;
constexpr vox_cells_kept occupied = VOX_CELLS_KEPT_OCCUPIED, dense = VOX_CELLS_KEPT_DENSE;

constexpr vox_foreign_grid of_kind(vox_cells_stored stored, vox_cells_queried queried, vox_cells_kept kept,
                                   const vox_foreign_weights& weights) {
    vox_foreign_grid grid{};
    grid.cells_stored = stored;
    grid.cells_queried = queried;
    grid.cells_kept = kept;
    grid.weights = weights;
    return grid;
}

// In nanoseconds, in the order of vox_foreign_weights. bench/foreign/fit_known.py finds and
// prints them; only their proportions matter. Those of HASHED, and below those of dense grids of boxes, are
// not quite the best in generated scenes: they lose less with real bodies.
constexpr vox_foreign_grid known_grids[VOX_KNOWN_GRID_NUMPY + 1] = {
    /* NONE */ of_kind(box, by_box, occupied, {0, 0, 0, 0, 0, 0, 0}),
    /* SORTED */ of_kind(box, by_box, dense, {0, 21, 0.34, 0, 3.6, 0, 0.53}),
    /* HASHED */ of_kind(box, by_box, occupied, {0, 100, 10, 0, 3, 100, 0}),
    /* WARP */ of_kind(centre, by_box, occupied, {0, 0, 5.2, 10, 3.1, 110, 0}),
    /* IPC */ of_kind(box, by_box, occupied, {0, 0, 0, 0, 15, 3.4, 0}),
    /* IPC_PAIRS */ of_kind(box, pairs, occupied, {0, 73, 36, 0, 6.2, 2.6, 0}),
    /* VTK */ of_kind(box, by_box, dense, {0, 49, 0, 220, 3.6, 0, 0}),
    /* PBAT */ of_kind(centre, around, occupied, {0, 0, 0, 0, 150, 0, 0}),
    /* POINT_VOXELS */ of_kind(centre, by_box, occupied, {0, 0, 21, 0, 1.8, 1100, 0}),
    /* NUMPY */ of_kind(box, by_box, occupied, {0, 140, 150, 260, 87, 0, 0}),
};

} // namespace

const vox_foreign_grid& known_grid(vox_known_grid known) noexcept {
    return known_grids[static_cast<std::size_t>(known)];
}

vox_foreign_weights weights_of_any(vox_cells_stored stored, vox_cells_queried queried,
                                   bool is_dense) noexcept {
    if (queried == pairs) return {0, 73, 36, 0, 6.2, 2.6, 0};
    if (queried == around) return {0, 0, 0, 0, 150, 0, 0};
    if (stored == box)
        return is_dense ? vox_foreign_weights{0, 23, 0, 60, 3, 8, 1}
                        : vox_foreign_weights{0, 3.2, 67, 79, 11, 0, 0};
    return is_dense ? vox_foreign_weights{0, 0, 0.67, 0.15, 7.6, 0, 1.6}
                    : vox_foreign_weights{0, 0, 15, 0.14, 2.5, 120, 0};
}

// As bench/foreign finds. For hashed grids of boxes, measured gains miss the modelled ones by 0.13 (root mean
// square), and most of those up to 0.16 were losses; in dense grids of boxes all were gains.
double doubtful_gain(vox_cells_stored stored, vox_cells_queried queried, bool is_dense) noexcept {
    return stored == box && queried == by_box && !is_dense ? 0.16 : 0;
}

} // namespace vox
