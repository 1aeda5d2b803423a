// Edits of a mesh that is in tiles. The last tet of a tile fills the gap that a tet leaves. A new tet joins
// its neighbours while their tile has room, else a new tile at the end. The tiles stay correct, but become
// less compact: after enough changes they must be made again.
#pragma once

#include "base/lists.hpp"
#include "base/scene.hpp"
#include "mesh/tet_changes.hpp"
#include "mesh/tiled_mesh.hpp"

#include <cstdint>
#include <span>

namespace vox {

// Applies changes. `body` and `tets_of`, which lists the tets at each vertex, are the state after them. If it
// returns false, or throws what the memory throws, `mesh` must be made again. The boundary is emptied if it
// no longer pays.
bool repair(TiledMesh& mesh, const Body& body, std::span<const TetChange> changes, const IndexLists& tets_of);

// Adds the vertices [count_before, count_after), which are in no tet yet. If it returns false, or throws what
// the memory throws, `mesh` must be made again.
bool add_vertices(TiledMesh& mesh, std::uint32_t count_before, std::uint32_t count_after);

// Removes a vertex that cannot make contacts from Boundary::loose.
void remove_loose(Boundary& boundary, std::uint32_t vertex) noexcept;

} // namespace vox
