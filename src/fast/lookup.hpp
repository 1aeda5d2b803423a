// The lookup: the vertices of windows against the tetrahedra of tiles.
#pragma once

#include "base/array.hpp"
#include "fast/broad_phase.hpp"
#include "fast/windows.hpp"
#include "mesh/tiles.hpp"

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <tuple>

namespace vox::fast {

// A vertex in the box of a tetrahedron that the float filter did not exclude.
struct Finding {
    std::uint32_t body;        // of the vertex
    std::uint32_t vertex;      // the caller's indices
    std::uint32_t tet : 31;    // or its place in Tiles::tets (TiledBody)
    std::uint32_t certain : 1; // strictly inside; else exact arithmetic has to decide
};

struct LookupCounters {
    std::uint64_t visited_cells = 0;
    std::uint64_t visited_points = 0;
    std::uint64_t candidates = 0; // (vertex, tetrahedron) pairs that passed the exact box test
};

// Receives findings, a full buffer at a time.
class Findings {
public:
    virtual void take(std::span<const Finding> findings) = 0;

protected:
    ~Findings() = default;
};

// The vertices of a tile.
struct TileVertices {
    alignas(64) float x[tile_size], y[tile_size], z[tile_size];
};

// Buffers of a worker, for one tile at a time. About 14 KiB.
struct alignas(64) LookupScratch : TileVertices {
    static constexpr std::uint32_t most_candidates = 256; // handled at a time
    static constexpr std::uint32_t most_pairs = 1024;
    static constexpr std::uint32_t most_findings = 128;

    // The tile. Its vertices again as x, y, z and an unused float, where that is faster to look up.
    alignas(64) float xyz[4 * tile_size];
    alignas(64) std::uint32_t corners[tile_size]; // the four local vertices of a tet, 8 bits each
    alignas(64) std::uint8_t quantised[3][tile_size];
    alignas(64) std::uint8_t lo[3][tile_size], side[3][tile_size]; // boxes of the tets
    alignas(64) std::uint64_t own[tile_size] = {}; // Tiles::own of its vertices, where stamps are in use
    // Candidates: points in the tile's box.
    alignas(64) float candidate_x[most_candidates + 64], candidate_y[most_candidates + 64],
        candidate_z[most_candidates + 64];
    alignas(64) std::uint32_t candidate_id[most_candidates + 64];
    alignas(64) std::uint32_t candidate_body[most_candidates + 64];
    alignas(64) std::uint8_t candidate_quantised[3][most_candidates + 64];
    // Candidates in the box of some tet. Their coordinates move up to these places in candidate_x, _y, _z.
    alignas(
        64) std::uint64_t masks[most_candidates + 64]; // the tets in whose box the candidate is, one at least
    alignas(64) std::uint32_t meeting[most_candidates + 64]; // the place where its other properties stayed
    // Pairs: place of the candidate << 6 | tet.
    alignas(64) std::uint32_t pairs[most_pairs + 64];
    Finding findings[most_findings];
    std::uint32_t finding_count = 0;
    // For self-collision: stamps[v] is tag << 6 | local index when v is a vertex of the current tile.
    std::uint32_t tag = 0;
    LookupCounters counters;
};

// Points to test against tiles: those of a window that are in `region`.
struct Source {
    Window window;
    Box region; // only tiles that meet it are tested
    std::uint32_t body;
};

struct TiledBody {
    const Tiles* tiles;
    const float* positions; // packed, of the body of the tiles
    // Boxes of the tiles of the body. One that is not known is made when it is needed, in `made`, which is
    // where `boxes` points to. `known` is null where all boxes are.
    const Box* boxes;
    Box* made;
    std::uint8_t* known;
    // Not null: the first source, and all of the same body that follow it, hold vertices of the body of the
    // tiles, and tets do not meet their own corners. One word for each vertex, zeroed at first, kept with the
    // scratch.
    std::uint32_t* stamps;
    bool rounded;  // whether some positions of the tiles or the sources are
    bool by_place; // findings have a tet's place in Tiles::tets instead of the caller's index
};

// Finds every point of the sources that is in the closed box of a tet of the tiles [first, last) and not
// certainly, by floats, outside the tet. Full buffers of findings go to `out`; flush() hands over the rest,
// which stays in scratch.
void look_up_tiles(const TiledBody& body, std::span<const Source> sources, std::uint32_t first,
                   std::uint32_t last, LookupScratch& scratch, Findings& out);
void flush(LookupScratch& scratch, Findings& out);

// The buffers of a worker.
struct LookupBuffers {
    explicit LookupBuffers(std::pmr::memory_resource* memory)
        : sources(memory), near(memory), stamps(memory), scratch(memory) {}

    Array<Source> sources, near; // of a piece of a body, and of a super-tile
    Array<std::uint32_t> stamps;
    Array<LookupScratch> scratch; // one, once it is needed

    auto buffers() { return std::tie(sources, near, stamps, scratch); }
};

// Some super-tiles of a body against the windows of the bodies that reach it.
void look_up(const Step& step, const BroadPhase& broad, const Windows& windows, const Piece& piece,
             StepBoxes& boxes, LookupBuffers& buffers, Findings& out);

} // namespace vox::fast
