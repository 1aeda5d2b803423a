// Boxes of the tiles that make_tiles() would make of a body, and of its super-tiles, from a sample of its
// tetrahedra: for a cost model, which needs to know how large tiles are and where, and not what is in them.
//
// The sample is cut as make_tiles() cuts all of them. Where a part of it has few tetrahedra left, its box is
// cut on, by the numbers of tetrahedra that it stands for. Then each box is enlarged by how far tetrahedra
// extend beyond their centroids.
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "base/scene.hpp"
#include "mesh/tiles.hpp"

#include <cstddef>
#include <memory_resource>

namespace vox {

struct TileSketch {
    explicit TileSketch(std::pmr::memory_resource* memory)
        : tiles(memory), boxes(memory), super_tiles(memory) {}

    Tiles tiles; // super_first, and as many tiles; nothing is in them. Its blocks are the caller's
    Array<Box> boxes, super_tiles;
};

// From about `wanted` tetrahedra. Positions that are not finite count as 0.
void sketch_tiles(const Body& body, std::size_t wanted, TileSketch& out);

} // namespace vox
