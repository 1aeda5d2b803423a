// The broad phase: from boxes of bodies and of blocks to regions in which vertices of one body may be in
// tetrahedra of another. Plain functions over the arrays of a step, which the fast engine and its cost model
// call.
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "fast/body_pairs.hpp"
#include "fast/step.hpp"
#include "mesh/tiles.hpp"

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox::fast {

// sides_of() each of the boxes.
void find_sides(const Box* boxes, std::size_t count, const Box& region, std::uint8_t* sides);

// The sides on which all of boxes[which[i]] are; all of them without any.
unsigned common_sides(const Box* boxes, std::span<const std::uint32_t> which, const Box& region);

// Bit i of the result: boxes[i] overlaps the region. `count` is at most most_boxes.
inline constexpr std::uint32_t most_boxes = 64;
std::uint64_t find_overlaps(const Box* boxes, std::uint32_t count, const Box& region);

// find_overlaps() for `count` blocks from the begin of a group on, with the boxes of the groups.
std::uint64_t find_blocks(const Box* blocks, const Box* groups, std::uint32_t count, const Box& region);

// A box that holds every vertex of body a that is in a tet of body b. It is the intersection of the boxes of
// the two bodies, the box around those blocks of a that meet these (of a single block: its vertices that are
// in both), and the box around those tiles of b that meet what is left, with the box of a super-tile in place
// of its tiles where that is inside. Empty where no tile of b meets it.
struct PairRegion {
    std::uint32_t a, b;
    Box region;
    // The size of those tiles, which will look into the windows of a; one counts for a super-tile inside.
    TileSize tile_size;
};

struct BroadPhase {
    explicit BroadPhase(std::pmr::memory_resource* memory)
        : regions(memory), first_of_a(memory), by_b(memory), first_of_b(memory), reached(memory),
          block_sides(memory), pairs(memory), pair_buffers(memory) {}

    Array<PairRegion> regions;       // sorted by a, then b
    Array<std::uint32_t> first_of_a; // of each body in `regions`, and the end
    Array<std::uint32_t> by_b;       // indices of `regions`, sorted by b, then a
    Array<std::uint32_t> first_of_b; // of each body in `by_b`, and the end

    // The regions of the vertices of a body, and the indices of those that reach its tets.
    std::span<const PairRegion> of_a(std::uint32_t a) const noexcept {
        return std::span(regions).subspan(first_of_a[a], first_of_a[a + 1] - first_of_a[a]);
    }
    std::span<const std::uint32_t> of_b(std::uint32_t b) const noexcept {
        return std::span(by_b).subspan(first_of_b[b], first_of_b[b + 1] - first_of_b[b]);
    }
    bool is_reached(std::uint32_t b) const noexcept { return first_of_b[b] != first_of_b[b + 1]; }

    // For each body, the box around the regions in which others reach it, before tiles made them smaller.
    Array<Box> reached;
    Array<std::uint8_t> block_sides; // sides_of() each block, seen from there

    // Buffers.
    Array<Pair> pairs;
    PairBuffers pair_buffers;
};

// Finds the regions of all pairs of bodies that may collide (mesh/filter.hpp) and of which one moved. Needs
// boxes.bodies and boxes.blocks (stream), and boxes.super_tiles of bodies that has_super_boxes. Makes the
// boxes of all super-tiles of bodies that are reached, and of all tiles that meet a region, but for those of
// super-tiles inside the regions that they meet. The result does not depend on the number of workers.
void find_regions(const Step& step, StepBoxes& boxes, BroadPhase& out);

// Makes the boxes of some super-tiles. Of bodies that are reached and do not collide with themselves,
// super-tiles that lie beyond `reached` get an empty box: nothing will be asked of them.
void make_super_tile_boxes(const Step& step, const BroadPhase& broad, const Piece& piece, StepBoxes& boxes);

// Makes the boxes of the tiles [first, last) of a body that are not known.
void make_tile_boxes(const Tiles& tiles, const float* positions, std::uint32_t first, std::uint32_t last,
                     Box* boxes, std::uint8_t* known);
inline void make_tile_boxes(const StepBody& body, std::uint32_t first, std::uint32_t last, StepBoxes& boxes) {
    make_tile_boxes(*body.tiles, body.positions, first, last, boxes.tiles.data() + body.first_tile,
                    boxes.tile_known.data() + body.first_tile);
}

} // namespace vox::fast
