// The fast engine: the same hits as the reference engine, found tile by tile. See src/README.md for the flow;
// each stage is a file in fast/.
#pragma once

#include "base/scene.hpp"
#include "cell_size/activity.hpp"
#include "fast/mesh_state.hpp"
#include "fast/pairs.hpp"
#include "fast/query.hpp"
#include "fast/stream.hpp"
#include "fast/winding/certificate.hpp"
#include "fast/window.hpp"
#include "mesh/tile_sides.hpp"

#include <vox/vox.h>

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

class Workers;

struct FastSettings {
    double cell_size = 0;       // 0: chosen for each window of cells from the tiles that query it
    bool winding = true;        // cull self-collision by winding numbers where it pays
    Workers* workers = nullptr; // that share the work; null: none, all is done on the calling thread
    // Leave out what cannot have changed: pairs of bodies neither of which moved since the last step, whose
    // hits the caller has. For the same engine and states of meshes as in the last step, meshes that are new or
    // gone excepted, and not after a step that failed.
    bool carry = false;
};

// The engine's buffers live here from step to step, so that the steady state allocates nothing.
class FastEngine {
public:
    explicit FastEngine(std::pmr::memory_resource* memory);
    FastEngine(const FastEngine&) = delete;
    FastEngine& operator=(const FastEngine&) = delete;

    // As ReferenceEngine::detect: appends a Hit for every vertex in a closed tetrahedron that does not own it, in
    // any order. `prepared` is what there is of each body. Throws Error(NON_FINITE) naming mesh and vertex; sets
    // the counters from `cells` to `skipped_degenerate` (degenerate tetrahedra with a vertex in their box)
    // and the stage times from `bin_ns` to `narrow_ns` (here: exact decisions alone, of the worker that took
    // longest over them). Nothing but times and the order of hits depends on the workers. With more than one,
    // the memory given to the constructor and that of `hits` are used by many threads at once.
    void detect(std::span<const Body> bodies, std::span<const fast::PreparedBody> prepared,
                const FastSettings& settings, std::pmr::vector<Hit>& hits, vox_counters& counters,
                vox_profile& profile);

    // Whether a body of the last step had to be looked at: all of them unless FastSettings::carry.
    bool moved(std::size_t body) const noexcept { return states_[body].moved; }

    // What the last step had to do for a body of `vertices` that is there since; all for others. Where
    // winding numbers cleared most of it, the rest is not worth a thought.
    Activity activity(std::size_t body, std::uint32_t vertices) const noexcept {
        if (body >= states_.size()) return {};
        const BodyState& state = states_[body];
        return {state.moved, state.self && state.binned > vertices / 2};
    }

    // What the last step found near each other, for the cost model: good while the bodies are those of that
    // step. The box of a body, as rounded; where vertices in its windows may be in its own tets, empty: nowhere.
    const Box& box(std::size_t body) const noexcept { return body_boxes_[body]; }
    Box own_region(std::size_t body) const noexcept {
        const BodyState& state = states_[body];
        return state.self && state.bins ? state.own : empty_box;
    }
    // Calls visit(a, b, region), sorted by a, then b: vertices of a in the region may be in tets of b.
    template <class Visit>
    void for_reaches(Visit&& visit) const {
        for (const Reach& reach : reaches_)
            if (!is_empty(reach.region)) visit(reach.a, reach.b, reach.region);
    }
    // Calls visit(points, first, count) for the vertices in each window of a body.
    template <class Visit>
    void for_binned(std::size_t body, Visit&& visit) const {
        const BodyState& state = states_[body];
        if (!state.bins) return;
        for (std::uint32_t w = state.root; w < state.bins->windows[state.root].end; ++w) {
            const fast::Window& window = state.bins->windows[w];
            if (window.count) visit(state.bins->points, window.first_point, window.count);
        }
    }
    // Calls visit(box) for the tiles of a body that were looked at and meet a region.
    template <class Visit>
    void for_tiles(std::size_t body, const Box& region, Visit&& visit) const {
        const std::size_t end =
            body + 1 < states_.size() ? states_[body + 1].first_tile : tile_boxes_.size();
        for (std::size_t t = states_[body].first_tile; t < end; ++t)
            if (tile_known_[t] && overlap(tile_boxes_[t], region)) visit(tile_boxes_[t]);
    }

    // The cell size of the last window of the last step that had one; 0 before.
    double cell_size() const noexcept { return cell_size_; }

private:
    static constexpr std::uint32_t none = ~0u;
    struct BodyState {
        const float* positions;    // packed; rounded, when floats are not enough
        std::uint32_t first_super; // in super_boxes_
        std::uint32_t first_tile;  // in tile_boxes_ and tile_known_
        std::uint32_t first_block; // in block_boxes_
        std::uint32_t first_move;  // in block_moves_, if `tracked`
        bool rounded;              // `positions` are
        bool moved;                // or may have, since the last step
        bool reached;           // by others: super_boxes_ and the tile_boxes_ are made where they meet them
        bool supers_known;      // super_boxes_ are
        bool tracked;           // block_moves_ are made
        bool self;              // some vertices of the window may be in tets of the same body
        std::uint32_t binned;   // vertices in the windows
        Box own;          // where vertices of the window may be in tets of the same body
        std::uint32_t buffers;  // in large_buffers_, or none
        const fast::Bins* bins; // of its windows; null: there are none
        std::uint32_t root;     // of their tree, in bins->windows
        double cell_size;       // of the windows
    };
    // Vertices of body a may be in tets of body b, and then are in `region`.
    struct Reach {
        std::uint32_t a, b;
        Box region;
        TileSize sides; // of the tiles that will query the window of a for b
    };
    // Blocks or super-tiles [first, last) of a body.
    struct Piece {
        std::uint32_t body, first, last;
    };
    // Bodies [first, last), whose windows share buffers: always the same ones, so that the buffers find their
    // size.
    struct Group {
        std::uint32_t first, last;
    };
    static constexpr std::size_t group_vertices = 2048; // that make up a group
    // What it takes to make the windows of a body.
    struct WindowBuffers {
        explicit WindowBuffers(std::pmr::memory_resource* memory);

        fast::Certificate certificate;
        std::pmr::vector<std::uint8_t> active; // blocks with vertices that may be in tets of the same body
        fast::Points points;                   // before they are binned
        std::pmr::vector<std::uint32_t> cell_of;
    };
    // The buffers of a worker.
    struct alignas(64) Worker {
        explicit Worker(std::pmr::memory_resource* memory);

        WindowBuffers windows;                        // of bodies that have none of their own
        std::pmr::vector<fast::Source> sources, near; // of a piece of a body, and of a super-tile
        std::pmr::vector<std::uint32_t> stamps;
        std::pmr::vector<fast::QueryScratch> scratch;                 // one, once it is needed
        std::uint64_t exact_tests = 0, filtered = 0, decision_ns = 0; // of the step
    };
    struct Step;
    class ExactDecisions;

    void prepare(Step& step);
    void stream(Step& step);
    bool stream(const Step& step, const Piece& piece, Box& box, std::uint8_t& moved);
    bool may_certify(const Step& step, std::uint32_t body) const noexcept;
    void follow_turning(Step& step);
    void find_reaches(Step& step);
    void shrink_to_blocks(const Step& step, Reach& reach) const;
    void shrink_to_tiles(const Step& step, Reach& reach) const;
    void sort_reaches(const Step& step);
    std::span<const std::uint32_t> reaching(std::uint32_t b) const noexcept; // in reaches_
    bool knows_sides(const Step& step, std::uint32_t body) const noexcept;
    void find_sides(const Step& step, const Piece& piece);
    void know_super_tiles(const Step& step, const Piece& piece);
    void know_tiles(const Step& step, const Piece& piece);
    void make_windows(Step& step);
    void make_window(const Step& step, std::uint32_t body, fast::Bins& bins, Worker& worker,
                     Workers* helpers);
    bool cull_by_winding(const Step& step, std::uint32_t body, fast::Certificate& certificate,
                         std::uint64_t& exact_tests, Workers* helpers);
    void activate_blocks(const Step& step, std::uint32_t body, WindowBuffers& buffers) const;
    void level_buffers();
    void sample_tiles(const Step& step, std::uint32_t body, TileSize& sides);
    void query(Step& step, const Piece& piece, Worker& worker);

    std::pmr::vector<BodyState> states_;
    std::pmr::vector<Box> body_boxes_, block_boxes_, super_boxes_, tile_boxes_;
    std::pmr::vector<Box> block_moves_;      // around displacements from the reference of the body
    std::pmr::vector<std::uint8_t> super_upright_; // all tets of a super-tile are surely positive
    std::pmr::vector<std::uint8_t> tile_known_;    // tile_boxes_ is of this step
    std::pmr::vector<Box> reached_regions_;  // of each body, around the regions where others reach it
    std::pmr::vector<std::uint8_t> block_sides_;   // of block_boxes_, from there: sides_of()
    std::pmr::vector<Piece> block_pieces_, super_pieces_;
    std::pmr::vector<Box> piece_boxes_; // of block_pieces_
    std::pmr::vector<std::uint8_t> piece_moved_;
    fast::PairBuffers pair_buffers_;
    std::pmr::vector<fast::Pair> pairs_;
    std::pmr::vector<Reach> reaches_;            // sorted by a, then b
    std::pmr::vector<std::uint32_t> by_b_;       // their indices sorted by b, then a
    std::pmr::vector<std::uint32_t> first_of_b_; // of each body in by_b_, and the end
    std::pmr::vector<std::uint32_t> first_of_a_; // of each body in reaches_, and the end
    std::pmr::vector<Group> groups_;
    std::pmr::vector<fast::Bins> bins_; // of the windows of each group
    std::pmr::vector<Worker> workers_;
    std::pmr::vector<WindowBuffers> large_buffers_; // of bodies that are more than a worker's share
    std::pmr::vector<std::uint64_t> degenerate_;    // body << 32 | tet
    double cell_size_ = 0;
};

} // namespace vox
