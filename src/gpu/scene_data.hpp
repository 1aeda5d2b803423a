// Meshes as arrays for a device: bodies, tiles and tetrahedra. Meshes with the same tetrahedra share these.
#pragma once

#include "gpu/scene.hpp"
#include "mesh/tiles.hpp"

#include <map>
#include <span>
#include <vector>

namespace vox::gpu {

struct SceneData {
    u32 vertex_count = 0;
    bool any_filter = false;
    std::vector<BodyOfScene> bodies; // those of scene i are [first_body[i], first_body[i + 1])
    std::vector<u32> first_body;
    std::vector<CellsOfBody> cells;
    std::vector<u32> vertex_body;
    std::vector<TileOfBody> tiles;
    std::vector<u32> tile_vertices, tile_tets, corners;
    std::vector<Tet> tets;
};

struct MeshForDevice {
    u32 id;
    u32 vertex_count;
    Positions positions{}; // floats, of which tiles and cells are made
    std::span<const Tet> tets{};
    std::span<const u64> off{}; // as bits; empty if all are on
    bool enabled = true, self_collision = false;
    PairFilter filter{};
};

class SceneBuilder {
public:
    // `cell_size` 0: chosen for each scene.
    explicit SceneBuilder(double cell_size) : cell_size_(cell_size) {}

    void begin_scene();
    // Throws Error(LIMIT).
    void add(const MeshForDevice& mesh);
    void end_scene();
    SceneData take(); // after the last scene

private:
    // Where the tiles and tetrahedra of a mesh lie, for others with the same ones.
    struct SharedTiles {
        u32 vertex_count, first_tet, tet_count;
        std::vector<u64> off;
        std::vector<TileOfBody> tiles;
    };
    const SharedTiles& tiles_of(const MeshForDevice& mesh);
    bool is_same(const SharedTiles& known, const MeshForDevice& mesh) const;
    SharedTiles make_tiles_of(const MeshForDevice& mesh);
    void add_tiles(const SharedTiles& shared, u32 body, const Positions& positions);

    double cell_size_;
    SceneData out_;
    TileSize sides_;                        // of the scene
    std::multimap<u64, SharedTiles> known_; // by a hash of their tets
};

} // namespace vox::gpu
