// What is prepared of the tetrahedra of a mesh while they stay as they are. Small meshes whose tetrahedra are
// equal share it: a scene of a million fragments has few different ones.
#pragma once

#include "base/scene.hpp"
#include "mesh/tiled_mesh.hpp"
#include "mesh/topology.hpp"

#include <cstdint>
#include <memory>
#include <memory_resource>
#include <set>
#include <span>
#include <vector>

namespace vox {

class SharedTets;

struct PreparedTets {
    explicit PreparedTets(std::pmr::memory_resource* memory) noexcept
        : tets(memory), topology(memory), tiled(memory) {}

    std::pmr::vector<Tet> tets; // empty where those of the caller are borrowed
    Topology topology;
    TiledMesh tiled;
    bool has_topology = false, has_tiles = false;
};

// The tetrahedra that small meshes share, each while a mesh has them. It has to outlive these meshes.
class SharedTets {
public:
    explicit SharedTets(std::pmr::memory_resource* memory) noexcept : all_(memory) {}
    SharedTets(const SharedTets&) = delete;
    SharedTets& operator=(const SharedTets&) = delete;

    // Of so many vertices: one block, one tile, which do not depend on positions.
    static constexpr std::uint32_t most_vertices = block_size;
    static constexpr std::size_t most_tets = 16;

    // Those equal to `tets`. Throws what the memory throws.
    std::shared_ptr<PreparedTets> find_or_add(std::span<const Tet> tets, std::uint32_t vertex_count);

private:
    struct Shared;
    struct Key {
        std::span<const Tet> tets;
        std::uint32_t vertex_count;

        bool operator<(const Key& other) const noexcept;
    };
    struct Before {
        using is_transparent = void;
        bool operator()(const Shared* a, const Shared* b) const noexcept;
        bool operator()(const Key& a, const Shared* b) const noexcept;
        bool operator()(const Shared* a, const Key& b) const noexcept;
    };

    std::pmr::set<Shared*, Before> all_;
};

} // namespace vox
