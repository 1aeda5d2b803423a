#include "mesh.hpp"

namespace vox {

Mesh::Mesh(const vox_mesh_desc& desc, const Body& view, std::pmr::memory_resource* memory)
    : tets_(view.tets.begin(), view.tets.end(), memory), copied_(memory), tiles_(memory),
      positions_(view.positions), user_data_(desc.user_data), vertex_count_(view.vertex_count),
      flags_(desc.flags) {
    if ((flags_ & VOX_MESH_COPY_POSITIONS) && positions_.data) {
        copied_.reserve(vertex_count_);
        for (std::uint32_t v = 0; v < vertex_count_; ++v) copied_.push_back(positions_[v]);
        positions_ = {reinterpret_cast<const std::byte*>(copied_.data()), sizeof(Vec3f)};
    }
}

void Mesh::make_tiles() {
    if (has_tiles_) return;
    tiles_.prepare(body(VOX_NULL_MESH));
    has_tiles_ = true;
}

void Mesh::bind(const Positions& positions) noexcept {
    positions_ = positions;
    copied_ = std::pmr::vector<Vec3f>(copied_.get_allocator());
}

Body Mesh::body(vox_mesh id) const noexcept {
    return {.mesh_id = id,
            .vertex_count = vertex_count_,
            .positions = positions_,
            .tets = tets_,
            .self_collision = (flags_ & VOX_MESH_SELF_COLLISION) != 0};
}

} // namespace vox
