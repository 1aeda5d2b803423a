// The edges and faces of the surface of a mesh, in tiles: what the search for edge contacts looks at. Made
// from the topology; the positions at that time only decide how compact the tiles are.
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "base/scene.hpp"
#include "fast/broad_phase.hpp"
#include "mesh/tiles.hpp"
#include "mesh/topology.hpp"

#include <array>
#include <cstdint>
#include <memory_resource>

namespace vox {

// Neighbouring faces, their vertices, and of their edges those that no tile before has.
struct SurfaceTile {
    static constexpr std::uint32_t most_faces = 32, most_edges = 3 * most_faces,
                                   most_vertices = 3 * most_faces;

    std::uint32_t first_vertex, first_face, first_edge, first_block;
    std::uint8_t vertex_count, face_count, edge_count, block_count;
};

// Tiles that follow each other, and are near each other.
inline constexpr std::uint32_t tiles_of_group = 8;

struct SurfaceGroup {
    std::uint32_t first, count; // in block_groups
};

struct SurfaceFeatures {
    explicit SurfaceFeatures(std::pmr::memory_resource* memory) noexcept
        : tiles(memory), groups(memory), vertices(memory), blocks(memory), block_groups(memory),
          faces(memory), edges(memory), triangles(memory), tets(memory) {}

    Array<SurfaceTile> tiles;
    Array<SurfaceGroup> groups;
    Array<std::uint32_t> vertices; // of the mesh
    // The blocks that hold the vertices of a tile, and the groups of blocks (fast::group_blocks) that hold
    // those of a group of tiles.
    Array<std::uint32_t> blocks, block_groups;
    // Indices of vertices of the tile.
    Array<std::array<std::uint8_t, 3>> faces;
    Array<std::array<std::uint8_t, 2>> edges;
    Array<std::uint32_t> triangles; // of each face, in Topology::triangles
    Array<std::uint32_t> tets;      // of each face, the one behind it; of doubled ones the lowest
};

// The boxes of the blocks of a body, and of groups of them.
struct BlockBoxes {
    const Box *blocks, *groups;
};

// Makes the boxes of the tiles [first, last), the first one at the begin of a group, `out[0]` that of
// `first`: by `box_of`, or empty where the blocks of a tile, and so its faces, all lie to one side of
// `region`.
template <class BoxOfTile>
void make_boxes_in(const Box& region, const SurfaceFeatures& features, const BlockBoxes& boxes,
                   std::uint32_t first, std::uint32_t last, Box* out, const BoxOfTile& box_of) {
    for (std::uint32_t begin = first; begin < last; begin += tiles_of_group) {
        const std::uint32_t end = std::min(begin + tiles_of_group, last);
        const SurfaceGroup& group = features.groups[begin / tiles_of_group];
        if (fast::common_sides(boxes.groups, {features.block_groups.data() + group.first, group.count},
                               region)) {
            out = std::fill_n(out, end - begin, empty_box);
            continue;
        }
        for (std::uint32_t t = begin; t < end; ++t) {
            const SurfaceTile& tile = features.tiles[t];
            const bool is_to_one_side = fast::common_sides(
                boxes.blocks, {features.blocks.data() + tile.first_block, tile.block_count}, region);
            *out++ = is_to_one_side ? empty_box : box_of(tile);
        }
    }
}

// Of an empty `out`. `tiles` are those of the mesh. Takes time linear in the tets, and n log n in the faces.
// Throws what the memory throws.
void make_surface_features(const Topology& topology, const Positions& positions, const Tiles& tiles,
                           SurfaceFeatures& out);

} // namespace vox
