// One inserted mesh: topology (copied), positions (borrowed or copied), settings.
#pragma once

#include "fast.hpp"
#include "scene.hpp"

#include <vox/vox.h>

#include <memory_resource>
#include <vector>

namespace vox {

class Mesh {
public:
    // An empty slot's mesh.
    explicit Mesh(std::pmr::memory_resource* memory) noexcept
        : tets_(memory), copied_(memory), tiles_(memory) {}
    // A copy of a checked desc: `view` are its arrays (mesh_check.hpp).
    Mesh(const vox_mesh_desc& desc, const Body& view, std::pmr::memory_resource* memory);

    Mesh(Mesh&&) noexcept = default;
    Mesh& operator=(Mesh&&) noexcept = default;

    // Makes the fast engine's tiles, once; needs positions.
    void make_tiles();
    const FastMesh& tiles() const noexcept { return tiles_; }

    // Borrows positions; a copy made at insertion is released.
    void bind(const Positions& positions) noexcept;

    bool has_positions() const noexcept { return vertex_count_ == 0 || positions_.data != nullptr; }
    std::uint32_t vertex_count() const noexcept { return vertex_count_; }
    std::uint64_t tet_count() const noexcept { return tets_.size(); }
    std::uint64_t user_data() const noexcept { return user_data_; }

    Body body(vox_mesh id) const noexcept;

private:
    std::pmr::vector<Tet> tets_;
    std::pmr::vector<Vec3f> copied_;
    FastMesh tiles_;
    bool has_tiles_ = false;
    Positions positions_;
    std::uint64_t user_data_ = 0;
    std::uint32_t vertex_count_ = 0;
    std::uint32_t flags_ = 0;
};

} // namespace vox
