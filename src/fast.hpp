// The fast engine: the same hits as the reference engine, found tile by tile. See src/README.md for the flow;
// each stage is a file in fast/.
#pragma once

#include "fast/pairs.hpp"
#include "fast/query.hpp"
#include "fast/stream.hpp"
#include "fast/surface.hpp"
#include "fast/tiles.hpp"
#include "fast/winding.hpp"
#include "fast/window.hpp"
#include "scene.hpp"

#include <vox/vox.h>

#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

// What the engine prepares of a mesh's topology, once. An empty one is prepared for an empty mesh.
struct FastMesh : fast::Tiles {
    explicit FastMesh(std::pmr::memory_resource* memory) noexcept : Tiles(memory), surface(memory) {}

    fast::Surface surface; // of bodies with self-collision

    // The positions decide how compact tiles are, nothing else; they may move later. Throws std::bad_alloc
    // (or what the memory throws) and leaves this as it was then.
    void prepare(const Body& body);
};

struct FastSettings {
    double cell_size = 0; // 0: chosen for each window of cells from the tiles that query it
    bool winding = true;  // cull self-collision by winding numbers where it pays
};

// The engine's buffers live here from step to step, so that the steady state allocates nothing.
class Fast {
public:
    explicit Fast(std::pmr::memory_resource* memory);
    Fast(const Fast&) = delete;
    Fast& operator=(const Fast&) = delete;

    // As Reference::detect: appends a Hit for every vertex in a closed tetrahedron that does not own it, in
    // any order. `prepared` are the tiles of each body. Throws Error(NON_FINITE) naming mesh and vertex; sets
    // the counters from `cells` to `skipped_degenerate` (degenerate tetrahedra with a vertex in their box)
    // and the stage times from `bin_ns` to `narrow_ns` (here: exact decisions alone).
    void detect(std::span<const Body> bodies, std::span<const FastMesh* const> prepared,
                const FastSettings& settings, std::pmr::vector<Hit>& hits, vox_counters& counters,
                vox_profile& profile);

    // The cell size of the last window of the last step that had one; 0 before.
    double cell_size() const noexcept { return cell_size_; }

private:
    struct BodyState {
        const float* positions;           // packed
        std::uint32_t first_block;        // in block_boxes_
        std::uint32_t first_super;        // in super_boxes_
        std::uint32_t first_tile;         // in tile_boxes_ and tile_known_
        bool super_known;                 // super_boxes_ are made
        bool tiles_known;                 // all of tile_boxes_ are
        bool self;                        // some vertices of the window may be in tets of the same body
        double inverse_sides, tile_count; // of the tiles that will query its window
        fast::Box own;                    // where vertices of the window may be in tets of the same body
        fast::Window window;
    };
    // Vertices of body a may be in tets of body b, and then are in `region`.
    struct Reach {
        std::uint32_t a, b;
        fast::Box region;
    };
    struct Step;

    void stream(Step& step);
    void pack(const Body& body, std::size_t first);
    void know_super_tiles(Step& step, std::uint32_t body);
    void reach(Step& step, Reach& reach);
    void make_window(Step& step, std::uint32_t body, std::span<const Reach> reaches);
    bool cull_by_winding(Step& step, std::uint32_t body);
    void activate_blocks(const Step& step, std::uint32_t body);
    void sample_tiles(const Step& step, std::uint32_t body, double& inverse_sides, double& count);
    double cell_size(const Step& step, std::uint32_t body);
    void query(Step& step, std::uint32_t body, std::span<const std::uint32_t> reaching);

    std::pmr::vector<float> packed_; // positions of bodies whose own are strided
    std::pmr::vector<BodyState> states_;
    std::pmr::vector<fast::Box> body_boxes_, block_boxes_, super_boxes_, tile_boxes_;
    std::pmr::vector<std::uint8_t> tile_known_; // tile_boxes_ is of this step
    fast::PairBuffers pair_buffers_;
    std::pmr::vector<fast::Pair> pairs_;
    std::pmr::vector<Reach> reaches_;          // sorted by a, then b
    std::pmr::vector<std::uint32_t> by_b_;     // their indices sorted by b, then a
    std::pmr::vector<std::uint32_t> first_of_; // buffer of that sort
    fast::Certificate certificate_;
    std::pmr::vector<std::uint8_t> active_; // blocks with vertices that may be in tets of the same body
    fast::Points points_;                   // of one body, before they are binned
    fast::Bins bins_;
    std::pmr::vector<fast::Source> sources_, near_; // all of a body, and those near a super-tile
    std::pmr::vector<std::uint32_t> stamps_;
    std::pmr::vector<fast::QueryScratch> scratch_;
    std::pmr::vector<std::uint64_t> degenerate_; // body << 32 | tet
    double cell_size_ = 0;
};

} // namespace vox
