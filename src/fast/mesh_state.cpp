#include "fast/mesh_state.hpp"

#include "fast/step.hpp"

#include <utility>

namespace vox::fast {

void MeshState::make_room(const Tiles& tiles, std::uint32_t vertex_count) {
    last_positions.positions.resize(std::size_t{vertex_count} * 3);
    last_positions.parts.resize((tiles.block_count() + piece_blocks - 1) / piece_blocks);
}

void MeshState::update(const TiledMesh& mesh, std::uint32_t version, std::uint32_t vertex_count) {
    if (version_ != version) {
        MeshState made(last_positions.positions.memory());
        made.make_room(mesh.tiles, vertex_count);
        made.version_ = version;
        made.changes_ = mesh.places.changes;
        *this = std::move(made);
        return;
    }
    make_room(mesh.tiles, vertex_count);
    for (std::uint32_t s = 0; changes_ < mesh.places.changes && s < orientation.shapes.size(); ++s)
        if (mesh.places.changed_at[s] > changes_) orientation.forget(s);
    if (!orientation.shapes.empty()) orientation.prepare(mesh.tiles);
    changes_ = mesh.places.changes;
}

} // namespace vox::fast
