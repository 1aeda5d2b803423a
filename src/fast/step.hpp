// One step as its stages see it: the bodies, how they are cut into pieces of work, and the boxes the stages
// make. The blocks, super-tiles and tiles (mesh/tiles.hpp) of all bodies are numbered one body after another.
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "base/parallel.hpp"
#include "base/scene.hpp"
#include "fast/last_positions.hpp"
#include "mesh/tiles.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {
struct Boundary;
}

namespace vox::fast {

struct OrientationCache;

// Blocks or super-tiles [first, last) of a body: the unit of work of a stage.
struct Piece {
    std::uint32_t body, first, last;
};
inline constexpr std::uint32_t piece_blocks = 2048;   // at most
inline constexpr std::uint32_t piece_super_tiles = 8; // at most

// Blocks that follow each other, with a box around them, and fewer at the end of a body.
inline constexpr std::uint32_t group_blocks = 16;
static_assert(piece_blocks % group_blocks == 0);

// One body of a step, beside the Body itself.
struct StepBody {
    // Set by who begins the step.
    const Tiles* tiles;
    LastPositions* last;           // null: nothing is kept of the body from step to step
    const Boundary* boundary;      // null: its self-collision is not culled by winding numbers
    OrientationCache* orientation; // null where `boundary` is
    bool moved;                    // since the last step, or may have; stream() adds what it finds

    // Set by lay_out().
    bool rounded; // positions are the nearest floats of the exact ones less Step::origin, else as they are
    std::uint32_t first_block, first_group, first_super, first_tile;

    // Set by stream().
    const float* positions; // packed
    float* packed;          // where it packs them, unless they are packed floats already
    // Set by track_orientation().
    bool has_super_boxes; // made before the broad phase
};

struct Step {
    explicit Step(std::pmr::memory_resource* memory)
        : of(memory), block_pieces(memory), super_pieces(memory) {}

    std::span<const Body> bodies;
    Array<StepBody> of; // of each of `bodies`
    Array<Piece> block_pieces, super_pieces;
    std::size_t block_count = 0, super_count = 0, tile_count = 0;
    Vec3d origin{}; // subtracted from positions that are rounded
    bool moved_origin() const noexcept { return origin.x != 0 || origin.y != 0 || origin.z != 0; }
    Workers* workers = nullptr;

    std::uint32_t worker_count() const noexcept { return workers ? workers->count() : 1; }

    // Calls function(item, worker) for each item of [0, items). `work` is that of all items together; a task
    // of its own is given at least `least` of it.
    template <class Function>
    void for_each(std::size_t items, std::size_t work, std::size_t least, Function&& function) const {
        const auto range = [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
            for (std::size_t i = begin; i < end; ++i) function(i, worker);
        };
        if (items == 0) return;
        if (worker_count() == 1 || work <= least) return range(0, items, 0);
        workers->for_ranges(items, std::max<std::size_t>(items * least / work, 1), range);
    }
};

// Boxes of tiles are made by the first stage that needs them; `tile_known` has which were.
struct StepBoxes {
    explicit StepBoxes(std::pmr::memory_resource* memory)
        : bodies(memory), blocks(memory), groups(memory), super_tiles(memory), tiles(memory),
          super_change(memory), super_positive(memory), tile_known(memory) {}

    Array<Box> bodies, blocks;
    Array<Box> groups; // of each group_blocks blocks of a body
    // Boxes that hold the super-tiles, not the smallest ones; empty where the broad phase found them out of
    // reach.
    Array<Box> super_tiles;
    Array<Box> tiles;
    Array<float> super_change;          // see track_orientation()
    Array<std::uint8_t> super_positive; // whether all tets of the super-tile certainly are
    Array<std::uint8_t> tile_known;
};

// Begins a step: step.of gets as many bodies, all cleared. The caller then sets the first fields of each.
void begin_step(std::span<const Body> bodies, Workers* workers, Step& step);

// Chooses the origin, numbers what the bodies consist of, cuts it into pieces and makes room for the boxes.
void lay_out(Step& step, StepBoxes& boxes);

} // namespace vox::fast
