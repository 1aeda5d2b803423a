// Each tile of kind a collects the features of kind b near it, ascending, and compares its own 64 boxes with
// each of them at once. The answers are bits, kept the other way round: the partners of each feature of the
// tile. When all tiles have counted theirs, they know where their lists go.
#include "surface/pairs.hpp"

#include "base/bits.hpp"
#include "base/room.hpp"
#include "base/vectors.hpp"
#include "surface/compare_boxes.hpp"
#include "surface/suggest.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vox {

namespace {

constexpr std::size_t word_bits = 64;
constexpr std::size_t least_tiles = 8; // that a worker takes at once

unsigned lowest_lane(std::uint64_t lanes) noexcept { return static_cast<unsigned>(std::countr_zero(lanes)); }

// The box of a feature as vox_motion.radius has it.
struct ExactBox {
    ExactBox(const SurfaceMotion& motion, std::span<const std::uint32_t> corners) noexcept {
        Vec3d low = motion.from[corners[0]], high = low;
        for (const std::uint32_t v : corners) {
            low = min(low, min(motion.from[v], motion.to[v]));
            high = max(high, max(motion.from[v], motion.to[v]));
        }
        const double r = motion.radius;
        const bool d = motion.doubles;
        lo = {lower_side(low.x, r, d), lower_side(low.y, r, d), lower_side(low.z, r, d)};
        hi = {upper_side(high.x, r, d), upper_side(high.y, r, d), upper_side(high.z, r, d)};
    }
    bool overlaps(const ExactBox& other) const noexcept {
        return lo.x <= other.hi.x && lo.y <= other.hi.y && lo.z <= other.hi.z && other.lo.x <= hi.x &&
               other.lo.y <= hi.y && other.lo.z <= hi.z;
    }

    Vec3d lo, hi;
};

// Bit i of word k and bit k of word i change places: by halves, quarters and so on (H. S. Warren, Hacker's
// Delight, ch. 7).
void transpose(std::uint64_t* words) noexcept {
    std::uint64_t low = 0xffffffff;
    for (unsigned width = word_bits / 2; width != 0; width /= 2, low ^= low << width)
        for (unsigned part = 0; part < word_bits; part += 2 * width)
            for (unsigned k = part; k < part + width; ++k) {
                const std::uint64_t changed = (words[k] >> width ^ words[k + width]) & low;
                words[k] ^= changed << width;
                words[k + width] ^= changed;
            }
}

} // namespace

struct PairSearch::Task {
    const SurfaceTopology& topology;
    const SurfaceMotion& motion;
    const FeatureTiles &a, &b;
    bool same; // kind
    std::uint32_t first, count;
    CompareBoxes* compare;
    CullSome* cull;
};

PairSearch::PairSearch(std::pmr::memory_resource* memory) noexcept
    : tiles_{FeatureTiles(memory), FeatureTiles(memory), FeatureTiles(memory)}, vertex_boxes_(memory),
      grid_(memory), workers_(memory), found_of_(memory), counts_(memory) {}

void PairSearch::release_buffers() noexcept {
    const auto release = [](auto& vector) {
        vector.clear();
        vector.shrink_to_fit();
    };
    for (Worker& worker : workers_)
        std::apply([&](auto&... buffers) { (release(buffers), ...); }, worker.buffers());
    release(found_of_);
    release(counts_);
}

const FeatureTiles& PairSearch::tiles(const SurfaceTopology& topology, const SurfaceMotion& motion,
                                      vox_feature kind) {
    const auto k = static_cast<std::size_t>(kind);
    const auto is_same = [](const SurfaceMotion& x, const SurfaceMotion& y) {
        return x.from.data() == y.from.data() && x.to.data() == y.to.data() && x.radius == y.radius &&
               x.doubles == y.doubles;
    };
    if (!is_same(boxes_are_of_, motion)) {
        boxes_are_of_ = {};
        has_boxes_ = {};
        make_vertex_boxes(motion, vertex_boxes_);
        boxes_are_of_ = motion;
    }
    FeatureTiles& tiles = tiles_[k];
    if (has_boxes_[k]) return tiles;
    const bool is_new = tiles.tile_count() == 0;
    if (is_new) make_feature_tiles(topology, kind, motion.from, tiles);
    make_boxes(vertex_boxes_, tiles);
    const double looseness = looseness_of(tiles);
    if (is_new) {
        tiles.looseness = looseness;
    } else if (looseness > 2 * tiles.looseness) { // what was close together has parted
        make_feature_tiles(topology, kind, motion.from, tiles);
        make_boxes(vertex_boxes_, tiles);
        tiles.looseness = std::max(looseness / 2, looseness_of(tiles));
    }
    has_boxes_[k] = true;
    return tiles;
}

// By the model, again when the tiles have grown or shrunk by a tenth. The cost is flat around its minimum.
double PairSearch::choose_cell_size(vox_feature a, vox_feature b) {
    const FeatureTiles &tiles_a = tiles_[static_cast<std::size_t>(a)],
                       &tiles_b = tiles_[static_cast<std::size_t>(b)];
    double sum = 0;
    std::size_t count = 0;
    for (const FeatureTiles* tiles : {&tiles_a, &tiles_b})
        for (const Box& box : tiles->tile_boxes) {
            const double side = std::max({double{box.hi[0]} - box.lo[0], double{box.hi[1]} - box.lo[1],
                                          double{box.hi[2]} - box.lo[2]});
            if (!(side < 1e300)) continue;
            sum += side;
            ++count;
        }
    if (!(sum > 0)) return 1;
    const double side = sum / static_cast<double>(count);
    constexpr std::size_t few_tiles = 64; // for which any size does, and the model takes longer than they do
    if (tiles_a.tile_count() + tiles_b.tile_count() < few_tiles ||
        count < tiles_a.tile_count() + tiles_b.tile_count())
        return side;
    ChosenSize& chosen = chosen_[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)];
    if (!(side < 1.1 * chosen.side && chosen.side < 1.1 * side)) {
        chosen.cell_size =
            suggest_for_tiles(tiles_a, tiles_b, vertex_boxes_.get_allocator().resource()).cell_size;
        chosen.side = side;
    }
    return chosen.cell_size;
}

// Drops those of worker.found that provably stay apart.
void PairSearch::cull_found(const Task& task, std::uint32_t tile, std::uint64_t asked, Worker& worker) {
    if (worker.found.empty()) return;
    const FeatureTiles &a = task.a, &b = task.b;
    const std::size_t first_slot = std::size_t{tile} * features_a_tile;
    const auto filled =
        static_cast<std::size_t>(std::find(a.features.data() + first_slot,
                                           a.features.data() + first_slot + features_a_tile, no_feature) -
                                 (a.features.data() + first_slot));
    const CullFrame frame = frame_around(
        task.motion, std::span(a.corners).subspan(first_slot * a.corner_count, filled * a.corner_count));
    for (std::uint64_t lanes = asked; lanes != 0; lanes &= lanes - 1) {
        const unsigned lane = lowest_lane(lanes);
        set_lane(frame, task.motion, a.corners_at(tile * features_a_tile + lane), lane, worker.tile);
    }
    const float apart = apart_in(frame, task.motion);
    CullBatch& batch = worker.batch;
    for (std::size_t begin = 0, end = 0; begin < worker.found.size(); begin = end) {
        std::size_t count = 0;
        for (; end < worker.found.size() && end - begin < batch.partners.size() && count < most_pairs_culled;
             ++end) {
            Found& found = worker.found[end];
            const auto partner = static_cast<std::uint32_t>(end - begin);
            batch.partners[partner] = partner_in(frame, task.motion, b.corners_at(b.slots[found.partner]));
            for (std::uint64_t lanes = found.lanes; lanes != 0; lanes &= lanes - 1) {
                batch.pair_lanes[count] = lowest_lane(lanes);
                batch.pair_partners[count++] = partner;
            }
            found.lanes = 0;
        }
        const std::size_t kept =
            task.cull({worker.tile, batch.partners.data(), a.corner_count, b.corner_count, apart,
                       batch.pair_lanes.data(), batch.pair_partners.data(), count});
        worker.culled += count - kept;
        for (std::size_t i = 0; i < kept; ++i)
            worker.found[begin + batch.pair_partners[i]].lanes |= std::uint64_t{1} << batch.pair_lanes[i];
    }
    std::erase_if(worker.found, [](const Found& found) { return found.lanes == 0; });
}

void PairSearch::search_tile(const Task& task, std::uint32_t tile, Worker& worker) {
    const FeatureTiles &a = task.a, &b = task.b;
    const std::uint32_t* const features = a.features.data() + std::size_t{tile} * features_a_tile;
    std::uint64_t asked = 0;
    for (unsigned lane = 0; lane < features_a_tile; ++lane)
        asked |= std::uint64_t{features[lane] - task.first < task.count} << lane;
    if (asked == 0) return;
    const std::uint32_t lowest = features[lowest_lane(asked)];

    // Features of b near this tile, as bits, so that they come out ascending.
    const Box& box = a.tile_boxes[tile];
    const float six[6] = {box.lo[0], box.lo[1], box.lo[2], box.hi[0], box.hi[1], box.hi[2]};
    const float* const of_tile = six;
    std::size_t first_word = worker.listed_words.size(), last_word = 0, most_near = 0;
    grid_.around(box, [&](std::uint32_t other) {
        if (worker.seen[other] == tile + 1) return;
        worker.seen[other] = tile + 1;
        if (!overlap(box, b.tile_boxes[other])) return;
        ++worker.tile_pairs;
        std::uint64_t near, close;
        task.compare(b.boxes_of(other), &of_tile, 1, 1, 0, &near, &close);
        most_near += bit_count(near);
        const std::uint32_t* const others = b.features.data() + std::size_t{other} * features_a_tile;
        for (; near != 0; near &= near - 1) {
            const std::uint32_t f = others[lowest_lane(near)];
            if (f == no_feature) break; // an endless box overlaps empty ones too
            if (task.same && f <= lowest) continue;
            worker.listed[f / word_bits] |= std::uint64_t{1} << f % word_bits;
            const std::size_t word = f / (word_bits * word_bits);
            worker.listed_words[word] |= std::uint64_t{1} << f / word_bits % word_bits;
            first_word = std::min(first_word, word);
            last_word = std::max(last_word, word);
        }
    });
    worker.near.resize(most_near);
    worker.boxes.resize(most_near);
    std::size_t count = 0;
    for (std::size_t w = first_word; w <= last_word; ++w) {
        for (std::uint64_t words = worker.listed_words[w]; words != 0; words &= words - 1) {
            const std::size_t word = w * word_bits + lowest_lane(words);
            for (std::uint64_t bits = worker.listed[word]; bits != 0; bits &= bits - 1) {
                const std::uint32_t slot = b.slots[word * word_bits + lowest_lane(bits)];
                worker.near[count] = slot;
                worker.boxes[count++] = b.boxes_of(slot / features_a_tile) + slot % features_a_tile;
            }
            worker.listed[word] = 0;
        }
        worker.listed_words[w] = 0;
    }
    if (count == 0) return;
    worker.boxes_compared += count;
    worker.masks.resize(count);
    worker.close.resize(count);
    // Each side of a box of doubles is less than 2 floats inside the float that bounds it.
    float largest = 0;
    for (const float side : six) largest = std::max(largest, std::abs(side));
    task.compare(a.boxes_of(tile), worker.boxes.data(), features_a_tile, count,
                 largest * 0x1p-20f + 0x1p-140f, worker.masks.data(), worker.close.data());

    const auto mark_corners = [&](bool on) {
        for (std::uint64_t lanes = asked; lanes != 0; lanes &= lanes - 1) {
            const unsigned lane = lowest_lane(lanes);
            for (const std::uint32_t v : a.corners_at(tile * features_a_tile + lane)) {
                std::uint64_t &exact = worker.around[v], &folded = worker.around_folded[v % folded_vertices];
                exact = on ? exact | std::uint64_t{1} << lane : 0;
                folded = on ? folded | std::uint64_t{1} << lane : 0;
            }
        }
    };
    mark_corners(true);
    worker.found.clear();
    // Those that overlap, without a branch that nobody could predict.
    unsigned below = 0; // lanes with features below the partner
    std::size_t overlapping = 0;
    for (std::size_t i = 0; i < count; ++i) {
        std::uint64_t lanes = worker.masks[i] & asked;
        if (task.same) { // each pair once
            const std::uint32_t partner = b.features[worker.near[i]];
            while (below < features_a_tile && features[below] < partner) ++below;
            if (below < features_a_tile) lanes &= (std::uint64_t{1} << below) - 1;
        }
        worker.near[overlapping] = worker.near[i];
        worker.masks[overlapping] = lanes;
        worker.close[overlapping] = worker.close[i];
        overlapping += lanes != 0;
    }
    for (std::size_t i = 0; i < overlapping; ++i) {
        std::uint64_t lanes = worker.masks[i];
        const std::uint32_t slot = worker.near[i];
        const auto corners = b.corners_at(slot);
        std::uint64_t maybe_around = 0;
        for (const std::uint32_t v : corners) maybe_around |= worker.around_folded[v % folded_vertices];
        if (lanes & maybe_around)
            for (const std::uint32_t v : corners) lanes &= ~worker.around[v];
        if (task.topology.has_patches())
            for (std::uint64_t left = lanes; left != 0; left &= left - 1)
                if (!task.topology.may_meet(a.corners_at(tile * features_a_tile + lowest_lane(left)),
                                            corners))
                    lanes &= ~(left & -left);
        if (const std::uint64_t unsure = lanes & worker.close[i]; unsure != 0 && task.motion.doubles) {
            const ExactBox exact(task.motion, corners);
            for (std::uint64_t left = unsure; left != 0; left &= left - 1) {
                const auto own = a.corners_at(tile * features_a_tile + lowest_lane(left));
                if (!exact.overlaps(ExactBox(task.motion, own))) lanes &= ~(left & -left);
            }
        }
        if (lanes == 0) continue;
        worker.overlaps += bit_count(lanes);
        worker.found.push_back({lanes, b.features[slot]});
    }
    mark_corners(false);
    if (task.motion.cull) cull_found(task, tile, asked, worker);
    keep_found(tile, worker);
}

// From the lanes of each partner to the partners of each lane, 64 by 64.
void PairSearch::keep_found(std::uint32_t tile, Worker& worker) {
    const std::size_t count = worker.found.size(), blocks = (count + word_bits - 1) / word_bits;
    found_of_[tile].count = count;
    if (count == 0) return;
    reserve_sparingly(worker.kept_partners, worker.kept_partners.size() + count);
    for (const Found& found : worker.found) worker.kept_partners.push_back(found.partner);
    const std::size_t first = worker.kept.size();
    reserve_sparingly(worker.kept, first + blocks * word_bits);
    worker.kept.resize(first + blocks * word_bits);
    std::uint64_t* const kept = worker.kept.data() + first;
    for (std::size_t i = 0; i < count; ++i) kept[i] = worker.found[i].lanes;
    std::uint32_t* const counts = counts_.data() + std::size_t{tile} * features_a_tile;
    for (std::size_t block = 0; block < blocks; ++block) {
        std::uint64_t* const words = kept + block * word_bits;
        transpose(words);
        for (unsigned lane = 0; lane < features_a_tile; ++lane) counts[lane] += bit_count(words[lane]);
    }
}

void PairSearch::run(const SurfaceTopology& topology, const SurfaceMotion& motion, vox_feature a,
                     vox_feature b, std::uint32_t first, std::uint32_t count, double cell_size,
                     Workers& workers, FeaturePairs& out) {
    counters_ = {};
    out.first = first;
    out.count = 0;
    out.offsets.assign(std::size_t{count} + 1, 0u);
    const FeatureTiles &tiles_a = tiles(topology, motion, a), &tiles_b = tiles(topology, motion, b);
    out.count = count;
    if (tiles_a.tile_count() == 0 || tiles_b.tile_count() == 0 || count == 0) {
        out.partners.clear();
        return;
    }
    grid_.fill(tiles_b.tile_boxes, cell_size > 0 ? cell_size : choose_cell_size(a, b));
    counters_.cell_size = grid_.cell_size();
    counters_.cells = grid_.occupied();

    workers_.grow(workers.count());
    const std::size_t words = topology.count(b) / word_bits + 1;
    for (Worker& worker : workers_) {
        worker.seen.assign(tiles_b.tile_count(), 0u);
        worker.listed.assign(words, 0u);
        worker.listed_words.assign(words / word_bits + 1, 0u);
        worker.around.assign(topology.vertex_count, 0u);
        worker.around_folded.fill(0);
        worker.kept.clear();
        worker.kept_partners.clear();
        worker.tile_pairs = worker.boxes_compared = worker.overlaps = worker.culled = 0;
    }
    counts_.assign(tiles_a.features.size(), 0u);
    found_of_.resize(tiles_a.tile_count());
    const Task task{topology, motion, tiles_a, tiles_b, a == b, first, count, compare_boxes(), cull_some()};
    workers.for_ranges(tiles_a.tile_count(), least_tiles,
                       [&](std::size_t begin, std::size_t end, std::uint32_t w) {
                           Worker& worker = workers_[w];
                           for (std::size_t t = begin; t < end; ++t) {
                               found_of_[t] = {w, worker.kept.size(), worker.kept_partners.size(), 0};
                               search_tile(task, static_cast<std::uint32_t>(t), worker);
                           }
                       });
    for (const Worker& worker : workers_) {
        counters_.tile_pairs += worker.tile_pairs;
        counters_.boxes_compared += worker.boxes_compared;
        counters_.overlaps += worker.overlaps;
        counters_.culled += worker.culled;
    }
    for (std::uint32_t i = 0; i < count; ++i)
        out.offsets[i + 1] = out.offsets[i] + counts_[tiles_a.slots[first + i]];
    // What is there already need not be set to 0 again.
    out.partners.resize(static_cast<std::size_t>(out.offsets[count]));
    workers.for_ranges(
        tiles_a.tile_count(), least_tiles, [&](std::size_t begin, std::size_t end, std::uint32_t) {
            for (std::size_t t = begin; t < end; ++t) {
                const TileFound& of = found_of_[t];
                if (of.count == 0) continue;
                const std::uint64_t* const kept = workers_[of.worker].kept.data() + of.first_word;
                const std::uint32_t* const partners =
                    workers_[of.worker].kept_partners.data() + of.first_partner;
                for (unsigned lane = 0; lane < features_a_tile; ++lane) {
                    const std::uint32_t f = tiles_a.features[t * features_a_tile + lane];
                    if (f - first >= count) continue; // also an empty lane
                    std::uint32_t* next = out.partners.data() + out.offsets[f - first];
                    for (std::size_t i = 0; i < of.count; i += word_bits)
                        for (std::uint64_t bits = kept[i + lane]; bits != 0; bits &= bits - 1)
                            *next++ = partners[i + lowest_lane(bits)];
                }
            }
        });
    workers_.level();
}

} // namespace vox
