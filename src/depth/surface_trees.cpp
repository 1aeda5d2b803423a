#include "depth/surface_trees.hpp"
#include "base/array.hpp"

#include <algorithm>

namespace vox::depth {

auto SurfaceTrees::place(std::uint32_t mesh_id) noexcept -> Tree* {
    return std::ranges::lower_bound(trees_, mesh_id, {}, &Tree::mesh_id);
}

void SurfaceTrees::add(std::uint32_t mesh_id) {
    const auto at = place(mesh_id);
    if (at != trees_.end() && at->mesh_id == mesh_id) return;
    trees_.insert(at, {mesh_id, SurfaceTree(trees_.memory())});
}

SurfaceTree& SurfaceTrees::operator[](std::uint32_t mesh_id) noexcept { return place(mesh_id)->tree; }

void SurfaceTrees::topology_changed(std::uint32_t mesh_id) noexcept {
    const auto at = place(mesh_id);
    if (at != trees_.end() && at->mesh_id == mesh_id) at->tree.invalidate();
}

void SurfaceTrees::forget(std::uint32_t mesh_id) noexcept {
    erase_if(trees_, [mesh_id](const Tree& tree) { return tree.mesh_id == mesh_id; });
}

void SurfaceTrees::forget_all() noexcept { trees_ = Array<Tree>(trees_.memory()); }

} // namespace vox::depth
