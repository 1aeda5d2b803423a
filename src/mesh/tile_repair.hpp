// Edits of a mesh that is in tiles. The last tet of a tile fills the gap that a tet leaves. A new tet joins
// its neighbours while their tile has room, else a new tile at the end. The tiles stay correct whatever is
// done, but become less compact: after enough changes they are to be made anew.
#pragma once

#include "base/lists.hpp"
#include "base/scene.hpp"
#include "mesh/tet_changes.hpp"
#include "mesh/tiled_mesh.hpp"

#include <cstdint>
#include <span>

namespace vox {

// Applies changes of `body`, which is the state after them; `tets_of` lists the tets at each vertex. When it
// returns false, or throws what the memory throws, `mesh` is to be made anew. The boundary is emptied when it
// does not pay any more.
bool repair(TiledMesh& mesh, const Body& body, std::span<const TetChange> changes, const IndexLists& tets_of);

// Adds vertices that no tet names yet, [count_before, count_after). When it returns false, or throws what the
// memory throws, `mesh` is to be made anew.
bool add_vertices(TiledMesh& mesh, std::uint32_t count_before, std::uint32_t count_after);

// A vertex that will never make contacts need not be looked at for belonging to no tet.
void remove_loose(Boundary& boundary, std::uint32_t vertex) noexcept;

} // namespace vox
