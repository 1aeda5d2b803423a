#include "gpu/upload.hpp"

#include "base/library.hpp"
#include "gpu/kernels/cells.hpp"
#include "mesh/tiles.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <memory_resource>

namespace vox::gpu {
namespace {

// A cell is this much of the harmonic mean of tile sides: between 0.7 and 1.0, times on an H200 are within 3
// % of the best (docs/gpu.md).
constexpr double sides_of_cell = 0.85;

struct MeshTets {
    std::vector<Tet> tets;
    std::vector<u64> off; // as bits; empty if all are on
};

// Where the tiles and tetrahedra of a mesh lie, for others with the same ones.
struct SharedTiles {
    u32 vertex_count, first_tet, tet_count;
    std::vector<u64> off;
    std::vector<TileOfBody> tiles;
};

vox_body_info info_of(const vox_grid* grid, vox_body id) {
    vox_body_info info;
    info.struct_size = sizeof info;
    check(vox_body_get_info(grid, id, &info));
    return info;
}

MeshTets tets_of(const vox_grid* grid, vox_body id) {
    u64 count = 0;
    check(vox_mesh_get_tets(grid, id, nullptr, nullptr, 0, &count));
    MeshTets mesh;
    mesh.tets.resize(count);
    std::vector<u8> enabled(count);
    if (count) check(vox_mesh_get_tets(grid, id, mesh.tets[0].v, enabled.data(), count, &count));
    for (u64 t = 0; t < count; ++t) {
        if (enabled[t]) continue;
        mesh.off.resize((count + 63) / 64);
        mesh.off[t / 64] |= u64{1} << (t % 64);
        mesh.tets[t] = {}; // what it had may be no vertex of the mesh
    }
    return mesh;
}

void check_supported(vox_body id, const vox_body_info& info) {
    const auto unsupported = [&](const char* what) {
        throw Error(VOX_ERROR_UNSUPPORTED,
                    format("body %u has %s, which the GPU's kernels do not know yet", id, what));
    };
    static constexpr double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    if (!std::equal(identity, identity + 12, info.transform)) unsupported("a transform");
    if (info.positions.format != VOX_FORMAT_FLOAT) unsupported("positions in double precision");
    const bool self = (info.filter.flags & VOX_FILTER_SELF_COLLISION) != 0;
    if (self && info.filter.self_rings) unsupported("self_rings");
    if (self && info.filter.self_rest_distance > 0) unsupported("a self_rest_distance");
    if (!info.positions.data)
        throw Error(
            VOX_ERROR_INVALID_STATE,
            format("body %u has no positions, of which its tiles are made: bind some, the rest pose say",
                   id));
}

class Reader {
public:
    explicit Reader(double cell_size) : cell_size_(cell_size) {}

    void read(const vox_grid* grid) {
        const auto scene = static_cast<u32>(out.first_body.size());
        const auto first = static_cast<u32>(out.bodies.size());
        out.first_body.push_back(first);
        u64 count = 0;
        check(vox_grid_get_bodies(grid, nullptr, 0, &count));
        std::vector<vox_body> ids(count);
        check(vox_grid_get_bodies(grid, ids.data(), count, &count));
        sides_ = TileSize();
        for (const vox_body id : ids) read_body(grid, id, scene);
        const double size = cell_size_ > 0 ? cell_size_ : sides_of_cell * sides_.mean();
        const double inverse = size > 0 ? 1 / size : 0;
        constexpr double most = std::numeric_limits<float>::max();
        const auto end = static_cast<u32>(out.bodies.size());
        for (u32 b = first; b < end; ++b) {
            out.cells[b].inverse = static_cast<float>(std::min(inverse, most));
            out.bodies[b].first_of_scene = first;
            out.bodies[b].end_of_scene = end;
        }
    }

    SceneData out;

private:
    void read_body(const vox_grid* grid, vox_body id, u32 scene) {
        const vox_body_info info = info_of(grid, id);
        if (info.shape != VOX_SHAPE_NONE) return; // shapes have no contacts
        const u64 vertices = info.positions.count;
        if (out.vertex_count + vertices > most_vertices)
            throw Error(VOX_ERROR_LIMIT, format("the scenes have more than %u vertices", most_vertices));
        BodyOfScene body{};
        body.id = id;
        body.first_vertex = out.vertex_count;
        body.vertex_count = static_cast<u32>(vertices);
        body.self_collision = (info.filter.flags & VOX_FILTER_SELF_COLLISION) != 0;
        const vox_filter filter = info.filter;
        body.filter = {filter.category ? filter.category : 1, filter.mask ? filter.mask : ~u64{0},
                       filter.group, filter.world};
        out.any_filter = out.any_filter || !(body.filter == PairFilter{});
        const auto number = static_cast<u32>(out.bodies.size());
        if (info.enabled) {
            check_supported(id, info);
            const SharedTiles& tiles = tiles_of(tets_of(grid, id), info);
            body.first_tet = tiles.first_tet;
            add_tiles(tiles, number, info);
        }
        out.vertex_count += body.vertex_count;
        out.vertex_body.insert(out.vertex_body.end(), body.vertex_count, number);
        out.bodies.push_back(body);
        out.cells.push_back({info.enabled ? scene : none, 0});
    }

    void add_tiles(const SharedTiles& shared, u32 body, const vox_body_info& info) {
        if (out.tiles.size() + shared.tiles.size() > most_tiles)
            throw Error(VOX_ERROR_LIMIT,
                        format("the scenes have more than %u tiles of about 60 tets", most_tiles));
        const Positions positions = positions_of(info);
        for (TileOfBody tile : shared.tiles) {
            tile.body = body;
            out.tiles.push_back(tile);
            Box box = empty_box;
            for (u32 i = 0; i < tile.vertex_count; ++i) {
                const Vec3f p = positions.floats(out.tile_vertices[tile.first_vertex + i]);
                const float at[3] = {p.x, p.y, p.z};
                for (int a = 0; a < 3; ++a) {
                    box.lo[a] = std::min(box.lo[a], at[a]);
                    box.hi[a] = std::max(box.hi[a], at[a]);
                }
            }
            if (has_ends(box)) sides_.add(box);
        }
    }

    static Positions positions_of(const vox_body_info& info) {
        Positions positions;
        positions.data = static_cast<const std::byte*>(info.positions.data);
        positions.byte_stride = info.positions.byte_stride ? info.positions.byte_stride : 3 * sizeof(float);
        if (const u64 stride = info.positions.component_byte_stride; stride > sizeof(float))
            positions.component_gap = stride - sizeof(float);
        return positions;
    }

    const SharedTiles& tiles_of(const MeshTets& mesh, const vox_body_info& info) {
        u64 hash = info.positions.count;
        for (const Tet& tet : mesh.tets)
            for (const u32 v : tet.v) hash = (hash ^ v) * 0x9fb21c651e98df25u, hash ^= hash >> 29;
        const auto [begin, end] = known_.equal_range(hash);
        for (auto at = begin; at != end; ++at)
            if (is_same(at->second, mesh, info)) return at->second;
        return known_.emplace(hash, make_tiles_of(mesh, info))->second;
    }
    bool is_same(const SharedTiles& known, const MeshTets& mesh, const vox_body_info& info) const {
        return known.vertex_count == info.positions.count && known.tet_count == mesh.tets.size() &&
               known.off == mesh.off &&
               (mesh.tets.empty() || std::memcmp(&out.tets[known.first_tet], mesh.tets.data(),
                                                 mesh.tets.size() * sizeof(Tet)) == 0);
    }

    SharedTiles make_tiles_of(const MeshTets& mesh, const vox_body_info& info) {
        SharedTiles shared{static_cast<u32>(info.positions.count),
                           static_cast<u32>(out.tets.size()),
                           static_cast<u32>(mesh.tets.size()),
                           mesh.off,
                           {}};
        if (out.tets.size() + mesh.tets.size() > VOX_MAX_TETS)
            throw Error(VOX_ERROR_LIMIT, format("the scenes have more than %u different tets", VOX_MAX_TETS));
        out.tets.insert(out.tets.end(), mesh.tets.begin(), mesh.tets.end());
        if (mesh.tets.empty()) return shared;
        Tiles tiles(std::pmr::new_delete_resource());
        make_tiles(mesh.tets, shared.vertex_count, positions_of(info), tiles, mesh.off);
        for (std::size_t t = 0; t < tiles.tiles.size(); ++t) {
            const Tile& tile = tiles.tiles[t];
            shared.tiles.push_back({static_cast<u32>(out.tile_vertices.size()),
                                    static_cast<u32>(out.tile_tets.size()), 0, tile.vertex_count,
                                    tile.tet_count});
            const u8* corners = tiles.corners_of(t);
            for (u32 i = 0; i < tile.tet_count; ++i) {
                u32 word = 0;
                for (u32 k = 0; k < 4; ++k) word |= u32{corners[k * tile_size + i]} << (8 * k);
                out.corners.push_back(word);
                out.tile_tets.push_back(tiles.tets[tile.first_tet + i]);
            }
            for (u32 i = 0; i < tile.vertex_count; ++i)
                out.tile_vertices.push_back(tiles.vertices[tile.first_vertex + i]);
        }
        return shared;
    }

    double cell_size_;
    TileSize sides_;
    std::multimap<u64, SharedTiles> known_; // by a hash of their tets
};

} // namespace

SceneData read_grids(std::span<const vox_grid* const> grids, double cell_size) {
    Reader reader(cell_size);
    for (const vox_grid* grid : grids) reader.read(grid);
    reader.out.first_body.push_back(static_cast<u32>(reader.out.bodies.size()));
    return std::move(reader.out);
}

} // namespace vox::gpu
