// Vertices of one body that are near faces of the surface of another one, or meet the boxes of these while
// both move: what proximities and impacts begin with. For both engines alike.
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "base/per_worker.hpp"
#include "base/scene.hpp"
#include "fast/step_scene.hpp"
#include "grid/surface_features.hpp"
#include "grid/surface_search.hpp"

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <tuple>

namespace vox {

// Vertices of body a and the surface of body b.
struct VertexFacePair {
    std::uint32_t a, b;
    std::span<const std::uint32_t> vertices; // of a, ascending
    const SurfaceFeatures* surface;          // of b
};

// A vertex, by its place in VertexFacePair::vertices, and those faces of a tile whose boxes it meets, as
// bits.
struct NearFaces {
    static constexpr std::uint32_t at_once = 64; // at most so many vertices of a tile are looked at together

    std::uint32_t place, faces;
};

class VertexFaceSearch {
protected:
    explicit VertexFaceSearch(std::pmr::memory_resource* memory);
    ~VertexFaceSearch() = default;

    // Finds vertices and faces of different bodies that may collide, and of which one moved since the last
    // step, as far as the engine knows; no such pair that is within `margin` is left out.
    void find_near(const StepScene& scene, double margin, KeptFeatures& kept);
    // Finds likewise vertices and faces that may meet on their straight way from the previous positions,
    // those without data standing still, to the present ones. Throws MeshError with NON_FINITE or LIMIT for a
    // previous position.
    void find_meeting(const StepScene& scene, std::span<const Positions> previous, KeptFeatures& kept);

private:
    // Takes those vertices of body a, in ascending order, out of the list that are of no interest to faces of
    // body b.
    virtual void leave_out(std::uint32_t a, std::uint32_t b, Array<std::uint32_t>& vertices) const = 0;
    // Between begin() and end() of a worker is what it finds in some tiles of a pair, tile by tile. Calls of
    // different workers may be concurrent.
    virtual void begin(const VertexFacePair& pair, std::uint32_t worker) = 0;
    virtual void visit(const SurfaceTile& tile, std::span<NearFaces> near, std::uint32_t worker) = 0;
    virtual void end(std::uint32_t worker) = 0;
    // For a search for meetings: the time after which a meeting of this vertex, given by its place, would not
    // be reported.
    virtual double latest(std::uint32_t place, std::uint32_t worker) noexcept = 0;

    struct Lists {
        explicit Lists(std::pmr::memory_resource* memory)
            : tiles(memory), blocks(memory), vertices(memory), first_of_run(memory), runs(memory),
              moving_runs(memory), moving_groups(memory) {}
        auto buffers() {
            return std::tuple_cat(
                runs.buffers(), std::tie(tiles, blocks, vertices, first_of_run, moving_runs, moving_groups));
        }

        Array<std::uint32_t> tiles, blocks;
        Array<std::uint32_t> vertices;     // of body a, in runs: those of a block
        Array<std::uint32_t> first_of_run; // in vertices, and the end
        GroupedBoxes runs;
        Array<MovingBox> moving_runs, moving_groups; // the same; none where both bodies stand still
    };

    void move_bodies(const StepScene& scene, std::span<const Positions> previous);
    void find_pairs(const StepScene& scene, const fast::PairRules& rules);
    void search(const StepScene& scene, KeptFeatures& kept);
    bool moves(const fast::Pair& pair) const noexcept {
        return bodies_[pair.a].before || bodies_[pair.b].before;
    }
    std::size_t list(const fast::Pair& pair, Lists& lists) const;
    void sort_by_motion(const fast::Pair& pair, Array<std::uint32_t>& tiles) const;
    void make_runs(const SearchedBody& body, bool moves, Lists& lists) const;
    void search_tiles(const fast::Pair& pair, const Lists& lists, std::size_t first, std::size_t last,
                      std::uint32_t worker);

    // One search.
    Array<float> packed_;                  // previous positions
    Array<Box> block_boxes_, group_boxes_; // of bodies that move from there
    SearchedBodies bodies_;
    Array<Box> body_boxes_;
    fast::PairBuffers pair_buffers_;
    Array<fast::Pair> pairs_; // vertices of a, faces of b
    PerWorker<Lists> lists_;  // of each worker
};

} // namespace vox
