// Scenes for the tests and the benchmarks of the engines: meshes with what the engines prepare of them.
#pragma once

#include "fast/engine.hpp"
#include "internal/meshes.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <deque>
#include <memory_resource>
#include <utility>
#include <vector>

namespace vox::test {

// Bodies over meshes, ready for both engines. Meshes stay where they are.
class Scene {
public:
    explicit Scene(std::pmr::memory_resource* memory = std::pmr::get_default_resource()) : memory_(memory) {}

    Mesh& add(Mesh mesh, bool self_collision = false) {
        meshes_.push_back(std::move(mesh));
        self_.push_back(self_collision);
        return meshes_.back();
    }

    std::deque<Mesh>& meshes() { return meshes_; }

    // Takes the bodies' views and prepares their tiles; again after a mesh was added.
    void prepare() {
        bodies_.clear();
        tiled_.clear();
        states_.clear();
        prepared_.clear();
        for (std::size_t i = 0; i < meshes_.size(); ++i) {
            const Mesh& mesh = meshes_[i];
            vox::Body body;
            body.mesh_id = std::uint32_t(i + 1);
            body.vertex_count = std::uint32_t(mesh.positions.size());
            body.positions = {reinterpret_cast<const std::byte*>(mesh.positions.data()), sizeof(vox::Vec3f)};
            body.tets = mesh.tets;
            body.self_collision = self_[i];
            bodies_.push_back(body);
            vox::TiledMesh& tiled = tiled_.emplace_back(memory_);
            vox::make_tiled_mesh(body, tiled);
            vox::fast::MeshState& state = states_.emplace_back(memory_);
            state.update(tiled, 1, body.vertex_count);
            prepared_.push_back({&tiled.tiles, &tiled.boundary, &state});
        }
    }

    std::vector<vox::Body>& bodies() { return bodies_; }
    const std::vector<vox::fast::PreparedBody>& prepared() const { return prepared_; }
    std::vector<const vox::Tiles*> tiles() const {
        std::vector<const vox::Tiles*> tiles;
        for (const vox::fast::PreparedBody& body : prepared_) tiles.push_back(body.tiles);
        return tiles;
    }

private:
    std::pmr::memory_resource* memory_;
    std::deque<Mesh> meshes_;
    std::deque<bool> self_;
    std::vector<vox::Body> bodies_;
    std::deque<vox::TiledMesh> tiled_;
    std::deque<vox::fast::MeshState> states_;
    std::vector<vox::fast::PreparedBody> prepared_;
};

// Hits as comparable numbers, sorted.
using Key = std::array<std::uint32_t, 5>;

template <class Hits>
std::vector<Key> keys(const Hits& hits) {
    std::vector<Key> out;
    out.reserve(hits.size());
    for (const vox::Hit& h : hits) out.push_back({h.body_a, h.vertex, h.body_b, h.tet, h.interior});
    std::sort(out.begin(), out.end());
    return out;
}

} // namespace vox::test
