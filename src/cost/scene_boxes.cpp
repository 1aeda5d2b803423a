#include "scene_boxes.hpp"

#include "../fast/query.hpp"
#include "../fast/rest.hpp"
#include "../fast/stream.hpp"
#include "../mesh_check.hpp"

namespace vox {

SceneBoxes::SceneBoxes(std::span<const Body> bodies, std::span<const fast::Tiles* const> tiles,
                       std::pmr::memory_resource* memory)
    : tiles_(tiles), rounded_(memory), positions_(memory), bodies_(bodies.size(), fast::empty_box, memory),
      blocks_(memory), super_boxes_(memory), tile_boxes_(memory), known_(memory),
      supers_known_(bodies.size(), 0, memory), first_block_(memory), first_super_(memory),
      first_tile_(memory) {
    std::size_t block_count = 0, super_count = 0, tile_count = 0, rounded = 0;
    const auto reserve = [&](auto&... lists) { (lists.reserve(bodies.size()), ...); };
    reserve(positions_, first_block_, first_super_, first_tile_);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        first_block_.push_back(block_count);
        first_super_.push_back(super_count);
        first_tile_.push_back(tile_count);
        block_count += tiles[b]->block_count();
        super_count += tiles[b]->super_tile_count();
        tile_count += tiles[b]->tiles.size();
        if (!fast::is_packed(bodies[b].positions)) rounded += 3 * std::size_t{bodies[b].vertex_count};
    }
    blocks_.resize(block_count);
    super_boxes_.resize(super_count);
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

std::span<const fast::Box> SceneBoxes::super_tiles(std::size_t body) {
    const fast::Tiles& tiles = *tiles_[body];
    const std::span<fast::Box> supers{super_boxes_.data() + first_super_[body], tiles.super_tile_count()};
    if (!supers_known_[body]) {
        const std::span<const fast::Box> own = blocks(body);
        for (std::uint32_t s = 0; s < supers.size(); ++s) {
            fast::Box box = fast::empty_box;
            for (const std::uint32_t block : tiles.blocks[s]) fast::add(box, own[block]);
            supers[s] = box;
        }
        supers_known_[body] = 1;
    }
    return supers;
}

void SceneBoxes::know_tiles(std::size_t body, std::uint32_t first, std::uint32_t last) {
    fast::tile_boxes(*tiles_[body], positions_[body], first, last, tile_boxes_.data() + first_tile_[body],
                     known_.data() + first_tile_[body]);
}

} // namespace vox
