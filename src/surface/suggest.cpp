#include "surface/suggest.hpp"

#include "cell_size/foreign/grid.hpp"
#include "cell_size/foreign/suggest.hpp"

namespace vox {

namespace {

// Nanoseconds, estimates: the time of a search is nearly all in comparing features, so the cells' own share is hard to
// measure, and what its minimum is off by costs little (bench/surface/pairs.py --sweep).
constexpr vox_grid_weights tile_weights{0, 12, 6, 2, 2, 2, 0};

vox_primitives boxes_as_primitives(const std::pmr::vector<Box>& boxes) {
    static_assert(sizeof(Box) == 2 * sizeof(Box::lo) && sizeof(Box::lo) == 4 * sizeof(float));
    vox_primitives primitives = primitives_defaults();
    primitives.type = VOX_PRIMITIVE_BOX;
    primitives.positions = boxes.data();
    primitives.position_byte_stride = sizeof(Box::lo);
    primitives.vertex_count = 2 * boxes.size();
    primitives.count = boxes.size();
    return primitives;
}

} // namespace

vox_foreign_suggestion suggest_for_tiles(const FeatureTiles& a, const FeatureTiles& b,
                                         std::pmr::memory_resource* memory) {
    const vox_primitives held = boxes_as_primitives(b.tile_boxes), asking = boxes_as_primitives(a.tile_boxes);
    vox_foreign_grid grid = foreign_grid_defaults();
    grid.content = VOX_CELLS_HOLD_BOXES;
    grid.look = VOX_LOOK_BOX;
    grid.held = &held;
    grid.asking = &a == &b ? nullptr : &asking;
    grid.weights = tile_weights;
    const ForeignGrid described(&grid);
    ForeignWork work(described, quick_look(described), memory);
    return suggest_for(described, work);
}

} // namespace vox
