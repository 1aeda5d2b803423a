#include "gpu/scene_data.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory_resource>

namespace vox::gpu {

// A cell is this much of the harmonic mean of tile sides: between 0.7 and 1.0, times on an H200 are within 3
// % of the best (docs/gpu.md).
constexpr double sides_of_cell = 0.85;

void SceneBuilder::begin_scene() {
    out_.first_body.push_back(static_cast<u32>(out_.bodies.size()));
    sides_ = TileSize();
}

void SceneBuilder::end_scene() {
    const double size = cell_size_ > 0 ? cell_size_ : sides_of_cell * sides_.mean();
    const double inverse = size > 0 ? 1 / size : 0;
    constexpr double most = std::numeric_limits<float>::max();
    const u32 first = out_.first_body.back();
    const auto end = static_cast<u32>(out_.bodies.size());
    for (u32 b = first; b < end; ++b) {
        out_.cells[b].inverse = static_cast<float>(std::min(inverse, most));
        out_.bodies[b].first_of_scene = first;
        out_.bodies[b].end_of_scene = end;
    }
}

SceneData SceneBuilder::take() {
    out_.first_body.push_back(static_cast<u32>(out_.bodies.size()));
    return std::move(out_);
}

void SceneBuilder::add(const MeshForDevice& mesh) {
    if (u64{out_.vertex_count} + mesh.vertex_count > most_vertices)
        throw Error(VOX_ERROR_LIMIT, format("the scenes have more than %u vertices", most_vertices));
    BodyOfScene body{};
    body.id = mesh.id;
    body.first_vertex = out_.vertex_count;
    body.vertex_count = mesh.vertex_count;
    body.self_collision = mesh.self_collision;
    body.filter = mesh.filter;
    out_.any_filter = out_.any_filter || !(body.filter == PairFilter{});
    const auto number = static_cast<u32>(out_.bodies.size());
    if (mesh.enabled) {
        const SharedTiles& tiles = tiles_of(mesh);
        body.first_tet = tiles.first_tet;
        add_tiles(tiles, number, mesh.positions);
    }
    out_.vertex_count += body.vertex_count;
    out_.vertex_body.insert(out_.vertex_body.end(), body.vertex_count, number);
    out_.bodies.push_back(body);
    const auto scene = static_cast<u32>(out_.first_body.size() - 1);
    out_.cells.push_back({mesh.enabled ? scene : none, 0});
}

void SceneBuilder::add_tiles(const SharedTiles& shared, u32 body, const Positions& positions) {
    if (out_.tiles.size() + shared.tiles.size() > most_tiles)
        throw Error(VOX_ERROR_LIMIT,
                    format("the scenes have more than %u tiles of about 60 tets", most_tiles));
    for (TileOfBody tile : shared.tiles) {
        tile.body = body;
        out_.tiles.push_back(tile);
        Box box = empty_box;
        for (u32 i = 0; i < tile.vertex_count; ++i) {
            const Vec3f p = positions.floats(out_.tile_vertices[tile.first_vertex + i]);
            const float at[3] = {p.x, p.y, p.z};
            for (int a = 0; a < 3; ++a) {
                box.lo[a] = std::min(box.lo[a], at[a]);
                box.hi[a] = std::max(box.hi[a], at[a]);
            }
        }
        if (has_ends(box)) sides_.add(box);
    }
}

const SceneBuilder::SharedTiles& SceneBuilder::tiles_of(const MeshForDevice& mesh) {
    u64 hash = mesh.vertex_count;
    for (const Tet& tet : mesh.tets)
        for (const u32 v : tet.v) hash = (hash ^ v) * 0x9fb21c651e98df25u, hash ^= hash >> 29;
    const auto [begin, end] = known_.equal_range(hash);
    for (auto at = begin; at != end; ++at)
        if (is_same(at->second, mesh)) return at->second;
    return known_.emplace(hash, make_tiles_of(mesh))->second;
}

bool SceneBuilder::is_same(const SharedTiles& known, const MeshForDevice& mesh) const {
    return known.vertex_count == mesh.vertex_count && known.tet_count == mesh.tets.size() &&
           std::ranges::equal(known.off, mesh.off) &&
           (mesh.tets.empty() ||
            std::memcmp(&out_.tets[known.first_tet], mesh.tets.data(), mesh.tets.size() * sizeof(Tet)) == 0);
}

SceneBuilder::SharedTiles SceneBuilder::make_tiles_of(const MeshForDevice& mesh) {
    SharedTiles shared{mesh.vertex_count,
                       static_cast<u32>(out_.tets.size()),
                       static_cast<u32>(mesh.tets.size()),
                       {mesh.off.begin(), mesh.off.end()},
                       {}};
    if (out_.tets.size() + mesh.tets.size() > VOX_MAX_TETS)
        throw Error(VOX_ERROR_LIMIT, format("the scenes have more than %u different tets", VOX_MAX_TETS));
    out_.tets.insert(out_.tets.end(), mesh.tets.begin(), mesh.tets.end());
    if (mesh.tets.empty()) return shared;
    Tiles tiles(std::pmr::new_delete_resource());
    make_tiles(mesh.tets, shared.vertex_count, mesh.positions, tiles, mesh.off);
    for (std::size_t t = 0; t < tiles.tiles.size(); ++t) {
        const Tile& tile = tiles.tiles[t];
        shared.tiles.push_back({static_cast<u32>(out_.tile_vertices.size()),
                                static_cast<u32>(out_.tile_tets.size()), 0, tile.vertex_count,
                                tile.tet_count});
        const u8* corners = tiles.corners_of(t);
        for (u32 i = 0; i < tile.tet_count; ++i) {
            u32 word = 0;
            for (u32 k = 0; k < 4; ++k) word |= u32{corners[k * tile_size + i]} << (8 * k);
            out_.corners.push_back(word);
            out_.tile_tets.push_back(tiles.tets[tile.first_tet + i]);
        }
        for (u32 i = 0; i < tile.vertex_count; ++i)
            out_.tile_vertices.push_back(tiles.vertices[tile.first_vertex + i]);
    }
    return shared;
}

} // namespace vox::gpu
