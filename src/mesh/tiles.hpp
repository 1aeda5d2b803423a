// The tetrahedra of a mesh in tiles. A tile is at most 64 neighbouring tetrahedra over at most 64 vertices,
// so that a corner is an 8-bit index into the tile's own vertices, and a set of its tetrahedra is one 64-bit
// mask.
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "base/lists.hpp"
#include "base/scene.hpp"

#include <algorithm>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

inline constexpr std::uint32_t tile_size = 64;       // most tets, and most vertices, of a tile
inline constexpr std::uint32_t super_tile_size = 16; // tiles of a super-tile, about
inline constexpr std::uint32_t block_size = 8;       // most vertices of a block

struct Tile {
    std::uint32_t first_tet;    // in Tiles::tets
    std::uint32_t first_vertex; // in Tiles::vertices and Tiles::own; a multiple of four
    std::uint8_t tet_count;     // 1 to 64; 0 if all were switched off
    std::uint8_t vertex_count;  // 1 to 64; the list is padded with its last vertex to a multiple of four
    bool holds_last_vertex;     // the mesh's: 16 bytes from its position on reach past the caller's array

    // A bit for each tet.
    std::uint64_t all_tets() const noexcept {
        return tet_count == 0 ? 0 : ~std::uint64_t{0} >> (64u - tet_count);
    }
};

struct Tiles {
    explicit Tiles(std::pmr::memory_resource* memory) noexcept
        : tiles(memory), corners(memory), tets(memory), vertices(memory), own(memory), block_first(memory),
          super_first(memory), blocks(memory) {}

    Array<Tile> tiles;
    Array<std::uint8_t> corners;   // 4 * 64 a tile: corner 0 of its tets, then corner 1, 2, 3
    Array<std::uint32_t> tets;     // the caller's tet index, tile after tile
    Array<std::uint32_t> vertices; // the caller's vertex index, tile after tile
    // For each of `vertices`: the tile's tets that have it as a corner. Empty for bodies without
    // self-collision, and mostly for those culled by winding numbers: the lookup then finds these tets
    // itself.
    Array<std::uint64_t> own;
    // Blocks: runs of vertices in the caller's numbering, mostly close together in space. Block i is vertices
    // [block_first[i], block_first[i + 1]).
    Array<std::uint32_t> block_first;
    // Super-tile s is tiles [super_first[s], super_first[s + 1]), a subtree of the k-d tree.
    Array<std::uint32_t> super_first;
    IndexLists blocks; // for each super-tile those that contain its vertices, ascending

    const std::uint8_t* corners_of(std::size_t tile) const noexcept {
        return corners.data() + tile * 4 * tile_size;
    }
    std::uint32_t block_count() const noexcept { return intervals(block_first); }
    std::uint32_t super_tile_count() const noexcept { return intervals(super_first); }
    std::uint32_t block_of(std::uint32_t vertex) const noexcept { return interval(block_first, vertex); }
    std::uint32_t super_tile_of(std::uint32_t tile) const noexcept { return interval(super_first, tile); }

private:
    // The number of intervals between ends; 0 before make_tiles().
    static std::uint32_t intervals(const Array<std::uint32_t>& ends) noexcept {
        return ends.empty() ? 0 : static_cast<std::uint32_t>(ends.size() - 1);
    }
    // The interval that a number is in.
    static std::uint32_t interval(const Array<std::uint32_t>& ends, std::uint32_t of) noexcept {
        return static_cast<std::uint32_t>(std::upper_bound(ends.begin(), ends.end(), of) - ends.begin() - 1);
    }
};

// Splits `tets` by a k-d tree over their centroids. Positions only decide how compact the tiles are: they may
// have any values, and may move later. Tetrahedra that are `off` (bits) are in no tile. If it throws what the
// memory throws, `out` is empty.
void make_tiles(std::span<const Tet> tets, std::uint32_t vertex_count, Positions positions, Tiles& out,
                std::span<const std::uint64_t> off = {});

// Writes block_first alone.
void cut_blocks(std::uint32_t vertex_count, Positions positions, Tiles& out);

// Into which parts a range of items of the tree is cut, until they fit into a tile.
inline constexpr std::uint32_t target_tets =
    60; // a little below 64, so that tiles of an uneven cut still fit
constexpr std::uint32_t lower_part(std::uint32_t count) noexcept {
    const std::uint32_t parts = std::max(2u, (count + target_tets - 1) / target_tets);
    return static_cast<std::uint32_t>(std::uint64_t{count} * (parts / 2) / parts);
}

// The harmonic mean of the sides of tiles: a few that reach across the world have little weight.
struct TileSize {
    double inverse_sum = 0, count = 0;

    // Adds `tiles` tiles of the size of `box`.
    void add(const Box& box, double tiles = 1) noexcept {
        const double sides = (double{box.hi[0]} - double{box.lo[0]}) +
                             (double{box.hi[1]} - double{box.lo[1]}) +
                             (double{box.hi[2]} - double{box.lo[2]});
        if (!(sides > 0)) return;
        inverse_sum += tiles * (3 / sides);
        count += tiles;
    }
    void add(const TileSize& other) noexcept {
        inverse_sum += other.inverse_sum;
        count += other.count;
    }
    double mean() const noexcept { return count > 0 ? count / inverse_sum : 0; }
};

} // namespace vox
