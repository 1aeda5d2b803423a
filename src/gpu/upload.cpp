#include "gpu/upload.hpp"

#include "base/library.hpp"

#include <algorithm>
#include <vector>

namespace vox::gpu {
namespace {

struct MeshTets {
    std::vector<Tet> tets;
    std::vector<u64> off; // as bits; empty if all are on
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

Positions positions_of(const vox_body_info& info) {
    Positions positions;
    positions.data = static_cast<const std::byte*>(info.positions.data);
    positions.byte_stride = info.positions.byte_stride ? info.positions.byte_stride : 3 * sizeof(float);
    if (const u64 stride = info.positions.component_byte_stride; stride > sizeof(float))
        positions.component_gap = stride - sizeof(float);
    return positions;
}

void read_body(const vox_grid* grid, vox_body id, SceneBuilder& to) {
    const vox_body_info info = info_of(grid, id);
    if (info.shape != VOX_SHAPE_NONE) return; // shapes have no contacts
    const vox_filter& filter = info.filter;
    MeshForDevice mesh{id, static_cast<u32>(info.positions.count)};
    mesh.self_collision = (filter.flags & VOX_FILTER_SELF_COLLISION) != 0;
    mesh.filter = {filter.category ? filter.category : 1, filter.mask ? filter.mask : ~u64{0}, filter.group,
                   filter.world};
    mesh.enabled = info.enabled != 0;
    MeshTets tets;
    if (mesh.enabled) {
        check_supported(id, info);
        tets = tets_of(grid, id);
        mesh.positions = positions_of(info);
        mesh.tets = tets.tets;
        mesh.off = tets.off;
    }
    to.add(mesh);
}

} // namespace

SceneData read_grids(std::span<const vox_grid* const> grids, double cell_size) {
    SceneBuilder builder(cell_size);
    for (const vox_grid* grid : grids) {
        builder.begin_scene();
        u64 count = 0;
        check(vox_grid_get_bodies(grid, nullptr, 0, &count));
        std::vector<vox_body> ids(count);
        check(vox_grid_get_bodies(grid, ids.data(), count, &count));
        for (const vox_body id : ids) read_body(grid, id, builder);
        builder.end_scene();
    }
    return builder.take();
}

} // namespace vox::gpu
