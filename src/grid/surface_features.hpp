// The vertices, edges and faces of the surface of a mesh, in tiles: what the searches over surfaces look at.
// Made from the topology; the positions at that time only decide how compact the tiles are.
#pragma once

#include "base/array.hpp"
#include "fast/step_scene.hpp"

#include <vox/vox.h>

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
          faces(memory), edges(memory), tets(memory), facets(memory) {}

    Array<SurfaceTile> tiles;
    Array<SurfaceGroup> groups;
    Array<std::uint32_t> vertices; // of the mesh
    // The blocks that hold the vertices of a tile, and the groups of blocks (fast::group_blocks) that hold
    // those of a group of tiles.
    Array<std::uint32_t> blocks, block_groups;
    // Indices of vertices of the tile; those of a face in the order of facet_corners.
    Array<std::array<std::uint8_t, 3>> faces;
    Array<std::array<std::uint8_t, 2>> edges;
    Array<std::uint32_t> tets;  // of each face, the one behind it; of doubled ones the lowest
    Array<std::uint8_t> facets; // of each face, which of the tetrahedron it is
};

// The features of each mesh that a search came upon, made once for all searches.
class KeptFeatures {
public:
    explicit KeptFeatures(std::pmr::memory_resource* memory) noexcept : meshes_(memory) {}

    // Those of a body, made anew where the mesh has changed; others may move. Takes time linear in the tets,
    // and n log n in the faces. Throws what the memory throws.
    const SurfaceFeatures& of(const StepScene& scene, std::uint32_t body);

    void forget(vox_body mesh) noexcept; // one that is gone, or whose tetrahedra are others
    void forget_all() noexcept { meshes_.clear(); }

private:
    struct Kept {
        vox_body mesh;
        SurfaceVersion version;
        SurfaceFeatures features;
    };
    Array<Kept> meshes_; // by id
};

} // namespace vox
