// The edges and faces of the surface of a mesh, in tiles: what the search for edge contacts looks at. Made
// from the topology; the positions at that time only decide how compact the tiles are.
#pragma once

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

// Of an empty `out`. `tiles` are those of the mesh; null: there are no blocks. Takes time linear in the tets,
// and n log n in the faces. Throws what the memory throws.
void make_surface_features(const Topology& topology, const Positions& positions, const Tiles* tiles,
                           SurfaceFeatures& out);

} // namespace vox
