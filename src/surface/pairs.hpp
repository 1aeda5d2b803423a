// Pairs of features whose boxes overlap: tiles of one kind against a grid of tiles of the other, a box of one
// against 64 at once.
#pragma once

#include "base/array.hpp"
#include "base/parallel.hpp"
#include "base/per_worker.hpp"
#include "surface/compare_boxes.hpp"
#include "surface/cull.hpp"
#include "surface/feature_tiles.hpp"
#include "surface/listed_features.hpp"
#include "surface/motion.hpp"
#include "surface/tile_grid.hpp"
#include "surface/topology.hpp"

#include <vox/vox_surface.h>

#include <array>
#include <cstdint>
#include <memory_resource>
#include <tuple>

namespace vox {

// The partners of a range of features: those of feature first + i are partners[offsets[i]] to
// partners[offsets[i + 1] - 1], ascending.
struct FeaturePairs {
    explicit FeaturePairs(std::pmr::memory_resource* memory) noexcept : offsets(memory), partners(memory) {}

    std::uint64_t first = 0, count = 0;
    Array<std::uint64_t> offsets;
    Array<std::uint32_t> partners;
};

struct PairCounters {
    std::uint64_t cells = 0, tile_pairs = 0, boxes_compared = 0, overlaps = 0, culled = 0;
};

class PairSearch {
public:
    explicit PairSearch(std::pmr::memory_resource* memory) noexcept;

    // All partners of features [first, first + count) of kind a. `cell_size` 0: chosen.
    void run(const SurfaceTopology& topology, const SurfaceMotion& motion, vox_feature a, vox_feature b,
             std::uint32_t first, std::uint32_t count, double cell_size, Workers& workers, FeaturePairs& out);

    // The tiles of a kind, with the boxes of this motion.
    const FeatureTiles& tiles(const SurfaceTopology& topology, const SurfaceMotion& motion, vox_feature kind);
    // The positions behind the motion that was asked about last have changed.
    void forget_boxes() noexcept { boxes_are_of_ = {}; }
    // Gives back the buffers of a search; the tiles, their boxes and the grid stay.
    void release_buffers() noexcept;

    const PairCounters& counters() const noexcept { return counters_; }

private:
    static constexpr std::size_t folded_vertices = 1024; // a power of two; few enough for the nearest cache

    // A feature of kind b, with its slot, and lanes of a tile of kind a: those that it makes pairs with.
    struct Found {
        std::uint64_t lanes;
        std::uint32_t partner, slot;
    };
    // Partners of a tile, and the pairs that they make with its lanes: few enough to stay in a near cache.
    static constexpr std::size_t most_partners_culled = 256, most_pairs_culled = 2048;
    struct CullBatch {
        std::array<CullPartner, most_partners_culled> partners;
        std::array<std::uint32_t, most_pairs_culled + cull_lanes> pair_lanes, pair_partners;
    };
    struct Worker {
        explicit Worker(std::pmr::memory_resource* memory)
            : seen(memory), listed(memory), near(memory), found(memory), around(memory), kept(memory),
              kept_partners(memory) {}
        auto buffers() {
            return std::tuple_cat(listed.buffers(), std::tie(seen, near, found, around, kept, kept_partners));
        }

        Array<std::uint32_t> seen; // of each tile of b: 1 + the last tile of a that met it
        // Features of b that overlap lanes of a tile: their numbers, in the order of their tiles, and
        // ascending. The first `count` of each are in use.
        ListedFeatures listed;
        Array<Found> near, found;
        std::size_t count = 0;
        Array<std::uint64_t> around; // of each vertex: the lanes that it is a corner of
        // Those of all vertices that share a remainder.
        std::array<std::uint64_t, folded_vertices> around_folded;
        // By all tiles so far: for each 64 partners, those of each lane as bits; and the partners.
        Array<std::uint64_t> kept;
        Array<std::uint32_t> kept_partners;
        QuantisedTile quantised; // the tile, another one, and what overlaps there
        alignas(64) QuantisedSides other;
        TileOverlaps overlaps;
        std::array<ExactBox, features_a_tile> exact; // of lanes of the tile, where they were wanted
        std::uint64_t has_exact = 0;
        CullTile tile; // of the tile, where pairs are culled
        CullBatch batch;
        std::uint64_t tile_pairs = 0, boxes_compared = 0, culled = 0;
    };
    struct TileFound {
        std::uint32_t worker;
        std::uint64_t first_word, first_partner, count; // in its `kept` and `kept_partners`
    };
    struct Task;

    struct TileSearch;

    static std::uint64_t overlapping(const Task& task, const TileSearch& tile, std::uint64_t lanes,
                                     std::uint32_t slot, Worker& worker) noexcept;
    template <unsigned Corners>
    static void add_near(const Task& task, const TileSearch& tile, std::uint32_t other, Worker& worker);
    static void sort_near(Worker& worker);
    static void drop_unwanted(const Task& task, const TileSearch& tile, Worker& worker);
    static void cull_found(const Task& task, const TileSearch& tile, Worker& worker);
    void search_tile(const Task& task, std::uint32_t t, Worker& worker);
    void keep_found(const Task& task, std::uint32_t tile, Worker& worker);
    void write_found(const Task& task, std::size_t tile, FeaturePairs& out);
    double choose_cell_size(vox_feature a, vox_feature b);

    std::array<FeatureTiles, feature_kinds> tiles_;
    std::array<bool, feature_kinds> has_boxes_{};
    SurfaceMotion boxes_are_of_;
    struct ChosenSize {
        int octave = 0;                 // of the side
        double side = 0, cell_size = 0; // the mean side of the tiles that it was chosen for
    };
    static constexpr std::size_t octaves = 4; // that are kept, a power of two
    std::array<std::array<std::array<ChosenSize, octaves>, feature_kinds>, feature_kinds> chosen_;
    Array<Box> vertex_boxes_;
    TileGrid grid_;
    PerWorker<Worker> workers_;
    Array<TileFound> found_of_;
    PairCounters counters_;
};

} // namespace vox
