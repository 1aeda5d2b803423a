// The boxes of everything in a scene, found as the fast engine finds them: those of blocks from one pass over
// the positions, those of tiles where somebody may look.
#pragma once

#include "base/boxes.hpp"
#include "base/scene.hpp"
#include "mesh/tiles.hpp"

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

class SceneBoxes {
public:
    // `tiles` of each body; both must stay. Throws Error(NON_FINITE) naming mesh_id and vertex.
    SceneBoxes(std::span<const Body> bodies, std::span<const Tiles* const> tiles,
               std::pmr::memory_resource* memory);

    // Packed; rounded to floats where the body's are not.
    const float* positions(std::size_t body) const noexcept { return positions_[body]; }
    // Of all their vertices.
    std::span<const Box> bodies() const noexcept { return bodies_; }
    std::span<const Box> blocks(std::size_t body) const noexcept {
        return {blocks_.data() + first_block_[body], tiles_[body]->block_count()};
    }

    // Appends the boxes of the tiles of a body that meet a region.
    void find_tiles(std::size_t body, const Box& region, std::pmr::vector<Box>& out);

private:
    std::span<const Tiles* const> tiles_;
    std::pmr::vector<float> rounded_;
    std::pmr::vector<const float*> positions_; // of each body
    std::pmr::vector<Box> bodies_, blocks_, tile_boxes_;
    std::pmr::vector<std::uint8_t> known_; // of tile_boxes_
    std::pmr::vector<std::uint8_t> sides_; // of the blocks of one body
    std::pmr::vector<std::size_t> first_block_, first_tile_;
};

} // namespace vox
