// What is prepared from a mesh's tetrahedra to search them: tiles, boundary, and, for edits, where everything
// is.
#pragma once

#include "base/array.hpp"
#include "base/lists.hpp"
#include "base/scene.hpp"
#include "mesh/boundary.hpp"
#include "mesh/tiles.hpp"

#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

struct TetChange;

// Where tetrahedra and triangles are. The first edit makes the lists.
struct TilePlaces {
    explicit TilePlaces(std::pmr::memory_resource* memory) noexcept
        : of_tet(memory), room(memory), triangles(memory), changed_at(memory) {}

    static constexpr std::uint32_t none = ~0u;
    Array<std::uint32_t> of_tet; // 64 * tile + place in the tile, or none
    std::uint32_t tile_of(std::uint32_t tet) const noexcept { return of_tet[tet] / tile_size; }
    struct Room {
        std::uint8_t tets, vertices; // how many fit into a tile without moving its lists
    };
    Array<Room> room;
    IndexLists triangles;                // the boundary's, by their lowest vertex
    std::uint32_t first_young_super = 0; // super-tiles and vertices from here on came with edits
    std::uint32_t first_young_vertex = 0;
    std::uint64_t changes = 0;       // how many tets changed since the tiles were made
    Array<std::uint64_t> changed_at; // for each super-tile, `changes` when a tet last joined it
};

// An empty mesh has no tiles.
struct TiledMesh {
    explicit TiledMesh(std::pmr::memory_resource* memory) noexcept
        : tiles(memory), boundary(memory), places(memory) {}

    Tiles tiles;
    Boundary boundary; // empty without self-collision, and if it does not pay
    TilePlaces places;
};

// The positions only decide how compact tiles are; they may move later. `facets` are those of the body's
// tets; if null, they are matched here if needed. If it throws what the memory throws, `out` is unchanged.
void make_tiled_mesh(const Body& body, TiledMesh& out, const MatchedFacets* facets = nullptr);

// ---- edits (tile_repair.cpp) ---------------------------------------------------------------------------

// Edits of a mesh that is in tiles. The last tet of a tile fills the gap that a tet leaves. A new tet joins
// its neighbours while their tile has room, else a new tile at the end. The tiles stay correct, but become
// less compact: after enough changes they must be made again.

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
