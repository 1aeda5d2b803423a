// Pairs of features whose boxes overlap: tiles of one kind against a grid of tiles of the other, a box of one
// against 64 at once.
#pragma once

#include "base/array.hpp"
#include "base/bits.hpp"
#include "base/parallel.hpp"
#include "base/per_worker.hpp"
#include "surface/cull.hpp"
#include "surface/feature_tiles.hpp"
#include "surface/lanes.hpp"
#include "surface/motion.hpp"
#include "surface/tile_grid.hpp"
#include "surface/topology.hpp"

#include <vox/vox_surface.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
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

// Numbers of features, sorted without comparing any two: each is a bit, and its place is the number of bits
// before it.
class ListedFeatures {
public:
    explicit ListedFeatures(std::pmr::memory_resource* memory) noexcept : words_(memory), used_(memory) {}
    auto buffers() { return std::tie(words_, used_); }

    // Makes room for numbers below `end`, none of which is listed then.
    void reset(std::size_t end) {
        words_.assign(end / word_bits + 1, Word{});
        used_.assign(end / square + 1, 0u);
        first_ = used_.size();
        last_ = 0;
    }
    // Lists f if `listed` is 1, without a branch, and does nothing if it is 0.
    void add(std::uint32_t f, std::uint64_t listed) noexcept {
        const std::size_t word = f / word_bits;
        words_[word].features |= listed << f % word_bits;
        used_[f / square] |= listed << word % word_bits;
        first_ = std::min<std::size_t>(first_, f / square);
        last_ = std::max<std::size_t>(last_, f / square);
    }
    // When all are listed, before place_of().
    void count() noexcept {
        std::uint32_t before = 0;
        for_each_word([&](Word& word) {
            word.before = before;
            before += bit_count(word.features);
        });
    }
    // How many of those listed are below f.
    std::uint32_t place_of(std::uint32_t f) const noexcept {
        const Word& word = words_[f / word_bits];
        return word.before + bit_count(word.features & ((std::uint64_t{1} << f % word_bits) - 1));
    }
    void clear() noexcept {
        for_each_word([](Word& word) { word.features = 0; });
        for (std::size_t i = first_; i <= last_; ++i) used_[i] = 0;
        first_ = used_.size();
        last_ = 0;
    }

private:
    static constexpr std::size_t word_bits = 64, square = word_bits * word_bits;
    struct Word {
        std::uint64_t features = 0;
        std::uint32_t before = 0; // features in earlier words
    };

    template <class Visit>
    void for_each_word(Visit&& visit) noexcept {
        for (std::size_t i = first_; i <= last_; ++i)
            for (std::uint64_t left = used_[i]; left != 0; left &= left - 1)
                visit(words_[i * word_bits + static_cast<std::size_t>(std::countr_zero(left))]);
    }

    Array<Word> words_;
    Array<std::uint64_t> used_;        // words that list any, as bits
    std::size_t first_ = 0, last_ = 0; // of `used_`, that hold any
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
        // Lanes of all vertices that share a remainder.
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
