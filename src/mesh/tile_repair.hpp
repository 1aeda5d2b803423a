// Edits of a mesh that is in tiles: a tet that goes leaves a gap that the last one of its tile fills, one
// that comes goes where its neighbours are while there is room, and else into a new tile at the end. The
// tiles stay right whatever is done, but lose their shape bit by bit: after so many changes they are to be
// made anew.
#pragma once

#include "base/scene.hpp"
#include "mesh/boundary.hpp"
#include "mesh/tet_changes.hpp"
#include "mesh/tiles.hpp"

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

// Where things are; all but the counts is made at the first edit.
struct TilePlaces {
    explicit TilePlaces(std::pmr::memory_resource* memory) noexcept
        : of_tet(memory), room(memory), triangles(memory) {}

    static constexpr std::uint32_t none = ~0u;
    std::pmr::vector<std::uint32_t> of_tet; // 64 * tile + place in it, or none
    std::uint32_t tile_of(std::uint32_t tet) const noexcept { return of_tet[tet] / tile_size; }
    struct Room {
        std::uint8_t tets, vertices; // that a tile has room for where it lies
    };
    std::pmr::vector<Room> room;
    IndexLists triangles;                     // of the surface, by their lowest vertex
    std::uint32_t first_young_super = 0; // super-tiles and vertices from here on came with edits
    std::uint32_t first_young_vertex = 0;
    std::uint64_t changes = 0; // of tets since the tiles were made
};

// Follows changes of `body`, which is as it is now, around each vertex `tets_of` it. False, or what the
// memory throws: tiles, surface and places are to be made anew. The surface is emptied when it does not pay
// any more.
bool repair(Tiles& tiles, Boundary& surface, TilePlaces& places, const Body& body,
            std::span<const TetChange> changes, const IndexLists& tets_of);

// Takes in vertices that no tet names yet, [count_before, count_after), count_before > 0. What the memory
// throws: as above.
void add_vertices(Tiles& tiles, Boundary& surface, TilePlaces& places, std::uint32_t count_before,
                  std::uint32_t count_after);

// A vertex that will never make contacts need not be looked at for being of no tet.
void forget_loose(Boundary& surface, std::uint32_t vertex) noexcept;

} // namespace vox
