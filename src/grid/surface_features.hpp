// The edges and faces of the surface of a mesh, in tiles: what the search for edge contacts looks at. Made
// from the topology; the positions at that time only decide how compact the tiles are.
#pragma once

#include "base/boxes.hpp"
#include "base/scene.hpp"
#include "mesh/tiles.hpp"
#include "mesh/topology.hpp"

#include <array>
#include <cstdint>
#include <memory_resource>
#include <vector>

namespace vox {

// Neighbouring faces, their vertices, and of their edges those that no tile before has.
struct SurfaceTile {
    static constexpr std::uint32_t most_faces = 32, most_edges = 3 * most_faces,
                                   most_vertices = 3 * most_faces;

    std::uint32_t first_vertex, first_face, first_edge, first_block;
    std::uint8_t vertex_count, face_count, edge_count, block_count;
};

struct SurfaceFeatures {
    explicit SurfaceFeatures(std::pmr::memory_resource* memory) noexcept
        : tiles(memory), vertices(memory), blocks(memory), faces(memory), edges(memory), triangles(memory),
          tets(memory) {}

    std::pmr::vector<SurfaceTile> tiles;
    std::pmr::vector<std::uint32_t> vertices; // of the mesh
    std::pmr::vector<std::uint32_t> blocks;   // that hold the vertices of a tile; for the fast engine
    // Indices of vertices of the tile.
    std::pmr::vector<std::array<std::uint8_t, 3>> faces;
    std::pmr::vector<std::array<std::uint8_t, 2>> edges;
    std::pmr::vector<std::uint32_t> triangles; // of each face, in Topology::triangles
    std::pmr::vector<std::uint32_t> tets;      // of each face, the one behind it; of doubled ones the lowest
};

// Whether the blocks of a tile, and so its faces, all lie to one side of a region: `sides` are those of all
// blocks of the body (fast::find_sides). False where the blocks are not known.
inline bool is_to_one_side(const SurfaceFeatures& features, const SurfaceTile& tile,
                           const std::uint8_t* sides) noexcept {
    if (tile.block_count == 0) return false;
    const std::uint32_t* blocks = features.blocks.data() + tile.first_block;
    constexpr std::uint32_t at_once = 4; // between branches
    unsigned common = all_sides;
    std::uint32_t i = 0;
    for (; i + at_once <= tile.block_count && common; i += at_once)
        for (std::uint32_t j = 0; j < at_once; ++j) common &= sides[blocks[i + j]];
    for (; i < tile.block_count && common; ++i) common &= sides[blocks[i]];
    return common != 0;
}

// Of an empty `out`. `tiles` are those of the mesh; null: there are no blocks. Takes time linear in the tets,
// and n log n in the faces. Throws what the memory throws.
void make_surface_features(const Topology& topology, const Positions& positions, const Tiles* tiles,
                           SurfaceFeatures& out);

} // namespace vox
