#include "cell_size/scene_boxes.hpp"

#include "fast/broad_phase.hpp"
#include "fast/last_positions.hpp"
#include "fast/stream.hpp"
#include "mesh/check.hpp"

namespace vox {

SceneBoxes::SceneBoxes(std::span<const Body> bodies, std::span<const Tiles* const> tiles,
                       std::pmr::memory_resource* memory)
    : tiles_(tiles), rounded_(memory), positions_(memory), bodies_(bodies.size(), empty_box, memory),
      blocks_(memory), tile_boxes_(memory), known_(memory), sides_(memory), first_block_(memory),
      first_tile_(memory) {
    std::size_t block_count = 0, tile_count = 0, rounded = 0;
    const auto reserve = [&](auto&... lists) { (lists.reserve(bodies.size()), ...); };
    reserve(positions_, first_block_, first_tile_);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        first_block_.push_back(block_count);
        first_tile_.push_back(tile_count);
        block_count += tiles[b]->block_count();
        tile_count += tiles[b]->tiles.size();
        if (!fast::is_packed(bodies[b].positions)) rounded += 3 * std::size_t{bodies[b].vertex_count};
    }
    blocks_.resize(block_count);
    tile_boxes_.resize(tile_count);
    known_.resize(tile_count);
    rounded_.resize(rounded);
    float* copy = rounded_.data();
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const Body& body = bodies[b];
        const float* positions = copy;
        if (fast::is_packed(body.positions))
            positions = reinterpret_cast<const float*>(body.positions.data);
        else
            for (std::uint32_t v = 0; v < body.vertex_count; ++v) {
                const Vec3f p = body.positions[v];
                for (const float x : {p.x, p.y, p.z}) *copy++ = x;
            }
        positions_.push_back(positions);
        if (body.vertex_count > 0 && !fast::stream_boxes(positions, tiles[b]->block_first,
                                                         blocks_.data() + first_block_[b], bodies_[b]))
            check_finite(body);
    }
}

// A super-tile is out of reach when all of its blocks lie on the same side of the region.
void SceneBoxes::find_tiles(std::size_t body, const Box& region, std::pmr::vector<Box>& out) {
    const Tiles& tiles = *tiles_[body];
    Box* boxes = tile_boxes_.data() + first_tile_[body];
    std::uint8_t* known = known_.data() + first_tile_[body];
    const std::span<const Box> own = blocks(body);
    if (sides_.size() < own.size()) sides_.resize(own.size());
    for (std::size_t block = 0; block < own.size(); ++block)
        sides_[block] = static_cast<std::uint8_t>(sides_of(own[block], region));
    for (std::uint32_t s = 0; s < tiles.super_tile_count(); ++s) {
        unsigned beyond = all_sides;
        for (const std::uint32_t block : tiles.blocks[s])
            if ((beyond &= sides_[block]) == 0) break;
        if (beyond != 0) continue;
        const std::uint32_t first = tiles.super_first[s], last = tiles.super_first[s + 1];
        fast::make_tile_boxes(tiles, positions_[body], first, last, boxes, known);
        for (std::uint32_t t = first; t < last; ++t)
            if (overlap(boxes[t], region)) out.push_back(boxes[t]);
    }
}

} // namespace vox
