// The trees over surfaces that were searched, one for each such mesh, kept from step to step. Depths of
// vertices and of edges share them.
#pragma once

#include "base/array.hpp"
#include "depth/closest.hpp"

#include <cstdint>
#include <memory_resource>

namespace vox::depth {

class SurfaceTrees {
public:
    explicit SurfaceTrees(std::pmr::memory_resource* memory) : trees_(memory) {}

    // Adds one for a mesh, unless it has one. Throws what the memory throws.
    void add(std::uint32_t mesh_id);
    // That of a mesh that has one, until another is added or forgotten. It is to be fitted by update() before
    // it is searched, also where positions are those of the last time: it refers to the arrays of the mesh.
    SurfaceTree& operator[](std::uint32_t mesh_id) noexcept;

    void topology_changed(std::uint32_t mesh_id) noexcept;
    void forget(std::uint32_t mesh_id) noexcept;
    void forget_all() noexcept;

private:
    struct Tree {
        std::uint32_t mesh_id;
        SurfaceTree tree;
    };
    // The place of a mesh's tree, or where it would be.
    Tree* place(std::uint32_t mesh_id) noexcept;

    Array<Tree> trees_; // by body id
};

} // namespace vox::depth
