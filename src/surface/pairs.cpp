// Each tile of kind a compares its own 64 boxes with those of each tile of kind b near it, and puts what
// overlaps in ascending order. The answers are bits, turned the other way round: the partners of each feature
// of the tile. When all tiles have counted theirs, they know where their lists go.
#include "surface/pairs.hpp"

#include "base/room.hpp"
#include "base/vectors.hpp"
#include "surface/suggest.hpp"

#include <cmath>
#include <numeric>

namespace vox {

namespace {

constexpr std::uint64_t all_lanes = ~std::uint64_t{0};
constexpr std::size_t least_tiles = 8; // that a worker takes at once

unsigned lowest_lane(std::uint64_t lanes) noexcept { return static_cast<unsigned>(std::countr_zero(lanes)); }

// Makes it as long as `count`. What was there is lost where there is no room, and else need not be set to 0
// again.
void make_room(Array<std::uint32_t>& vector, std::uint64_t count) {
    if (count > vector.capacity()) {
        vector.clear();
        vector.shrink_to_fit();
        reserve_exactly(vector, count + count / 16);
    }
    vector.resize(static_cast<std::size_t>(count));
}

} // namespace

struct PairSearch::Task {
    const SurfaceTopology& topology;
    const SurfaceMotion& motion;
    const FeatureTiles &a, &b;
    bool same; // kind
    std::uint32_t first, count;
    std::uint64_t* ends; // of the list of each feature asked about; first, how long it is
};

// A tile of kind a as it is searched.
struct PairSearch::TileSearch {
    std::uint32_t first_slot = 0;
    std::uint64_t asked = 0;  // lanes
    std::uint32_t lowest = 0; // feature that is asked about
    // Where floats that bound boxes of doubles differ by more, these have their order. 0: the boxes are
    // floats.
    float close_by = 0;
};

PairSearch::PairSearch(std::pmr::memory_resource* memory) noexcept
    : tiles_{FeatureTiles(memory), FeatureTiles(memory), FeatureTiles(memory)}, vertex_boxes_(memory),
      grid_(memory), workers_(memory), found_of_(memory) {}

void PairSearch::release_buffers() noexcept {
    const auto release = [](auto& vector) {
        vector.clear();
        vector.shrink_to_fit();
    };
    for (Worker& worker : workers_)
        std::apply([&](auto&... buffers) { (release(buffers), ...); }, worker.buffers());
    release(found_of_);
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

// By the model, once for tiles whose mean side lies between two powers of two: the cost is flat around its
// minimum, and there the size grows with the tiles. A motion, its end and other radii, asked about in turn,
// have tiles of several sizes.
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
    const int octave = std::ilogb(side);
    ChosenSize& chosen = chosen_[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)]
                                [static_cast<std::size_t>(octave) % octaves];
    if (chosen.cell_size == 0 || chosen.octave != octave) {
        const double cell_size = suggest_for_tiles(tiles_a, tiles_b, vertex_boxes_.memory()).cell_size;
        chosen = {octave, side, cell_size};
    }
    return chosen.cell_size * (side / chosen.side);
}

// Drops those of worker.found that provably stay apart.
void PairSearch::cull_found(const Task& task, const TileSearch& tile, Worker& worker) {
    const std::span<Found> found(worker.found.data(), worker.count);
    if (found.empty()) return;
    const FeatureTiles &a = task.a, &b = task.b;
    const std::uint32_t* const features = a.features.data() + tile.first_slot;
    const auto filled =
        static_cast<std::size_t>(std::find(features, features + features_a_tile, no_feature) - features);
    const CullFrame frame =
        frame_around(task.motion, {a.corners_from(tile.first_slot), filled * a.corner_count});
    for (std::uint64_t lanes = tile.asked; lanes != 0; lanes &= lanes - 1) {
        const unsigned lane = lowest_lane(lanes);
        set_lane(frame, task.motion, a.corners_at(tile.first_slot + lane), lane, worker.tile);
    }
    const float apart = apart_in(frame, task.motion);
    CullBatch& batch = worker.batch;
    for (std::size_t begin = 0, end = 0; begin < found.size(); begin = end) {
        std::size_t count = 0;
        for (; end < found.size() && end - begin < batch.partners.size() && count < most_pairs_culled;
             ++end) {
            const auto partner = static_cast<std::uint32_t>(end - begin);
            batch.partners[partner] = partner_in(frame, task.motion, b.corners_at(found[end].slot));
            for (std::uint64_t lanes = found[end].lanes; lanes != 0; lanes &= lanes - 1) {
                batch.pair_lanes[count] = lowest_lane(lanes);
                batch.pair_partners[count++] = partner;
            }
            found[end].lanes = 0;
        }
        const std::size_t kept =
            cull_some({worker.tile, batch.partners.data(), a.corner_count, b.corner_count, apart,
                       batch.pair_lanes.data(), batch.pair_partners.data(), count});
        worker.culled += count - kept;
        for (std::size_t i = 0; i < kept; ++i)
            found[begin + batch.pair_partners[i]].lanes |= std::uint64_t{1} << batch.pair_lanes[i];
    }
    const auto end =
        std::remove_if(found.begin(), found.end(), [](const Found& of) { return of.lanes == 0; });
    worker.count = static_cast<std::size_t>(end - found.begin());
}

// Returns the lanes whose boxes overlap the box of a slot of b: floats that bound them decide, and where
// these cannot tell, the caller's format.
std::uint64_t PairSearch::overlapping(const Task& task, const TileSearch& tile, std::uint64_t lanes,
                                      std::uint32_t slot, Worker& worker) noexcept {
    const FeatureTiles &a = task.a, &b = task.b;
    const FloatOverlaps floats =
        compare_floats(a.boxes_of(tile.first_slot / features_a_tile),
                       b.boxes_of(slot / features_a_tile) + slot % features_a_tile, tile.close_by);
    lanes &= floats.lanes;
    if (!task.motion.doubles || (lanes & floats.close) == 0) return lanes;
    const ExactBox box(task.motion, b.corners_at(slot));
    for (std::uint64_t left = lanes & floats.close; left != 0; left &= left - 1) {
        const unsigned lane = lowest_lane(left);
        if (!(worker.has_exact >> lane & 1))
            worker.exact[lane] = ExactBox(task.motion, a.corners_at(tile.first_slot + lane));
        worker.has_exact |= left & -left;
        if (!box.overlaps(worker.exact[lane])) lanes &= ~(left & -left);
    }
    return lanes;
}

// Appends to worker.near the features of another tile that overlap lanes of this one.
template <unsigned Corners>
void PairSearch::add_near(const Task& task, const TileSearch& tile, std::uint32_t other, Worker& worker) {
    const FeatureTiles& b = task.b;
    const std::uint32_t first_slot = other * features_a_tile;
    const std::uint32_t* const features = b.features.data() + first_slot;
    const std::uint32_t* const corners = b.corners_from(first_slot);
    // Each pair once, and no empty lanes, which an endless box would overlap, too. Both are at one end of the
    // tile.
    const std::uint32_t* const own = task.a.features.data() + tile.first_slot;
    const auto lanes_below = [&](std::uint32_t f) {
        const auto below = std::lower_bound(own, own + features_a_tile, f) - own;
        return below == features_a_tile ? all_lanes : (std::uint64_t{1} << below) - 1;
    };
    const auto lanes_up_to = [&](std::uint32_t f) {
        return static_cast<unsigned>(std::upper_bound(features, features + features_a_tile, f) - features);
    };
    std::uint64_t wanted = all_lanes;
    if (features[features_a_tile - 1] == no_feature) wanted >>= features_a_tile - lanes_up_to(no_feature - 1);
    if (task.same && features[0] <= tile.lowest) {
        const unsigned skipped = lanes_up_to(tile.lowest);
        if (skipped == features_a_tile) return;
        wanted = wanted >> skipped << skipped;
    }
    TileOverlaps& overlaps = worker.overlaps;
    quantise_sides(b.boxes_of(other), worker.quantised, worker.other);
    const std::size_t found = compare_tiles(worker.quantised, tile.asked, worker.other, wanted, overlaps);
    worker.boxes_compared += overlaps.compared;
    std::size_t count = worker.count;
    if (worker.near.size() < count + found) worker.near.resize(count + count / 2 + features_a_tile);
    for (std::size_t i = 0; i < found; ++i) {
        const std::uint32_t lane = overlaps.others[i];
        const std::uint32_t* const v = corners + std::size_t{lane} * Corners;
        std::uint64_t lanes = overlaps.lanes[i], maybe_around = 0;
        for (unsigned c = 0; c < Corners; ++c) maybe_around |= worker.around_folded[v[c] % folded_vertices];
        if (lanes & maybe_around)
            for (unsigned c = 0; c < Corners; ++c) lanes &= ~worker.around[v[c]];
        if (std::uint64_t open = lanes & overlaps.open[i]; open != 0) {
            if (task.same) lanes &= lanes_below(features[lane]), open &= lanes;
            lanes &= ~open | overlapping(task, tile, open, first_slot + lane, worker);
        }
        worker.near[count] = {lanes, features[lane], first_slot + lane};
        const std::uint64_t is_near = lanes != 0; // nobody could predict a branch
        worker.listed.add(features[lane], is_near);
        count += is_near;
    }
    worker.count = count;
}

// worker.near, ascending, to worker.found.
void PairSearch::sort_near(Worker& worker) {
    if (worker.found.size() < worker.count) worker.found.resize(worker.count + worker.count / 8);
    worker.listed.count();
    for (std::size_t i = 0; i < worker.count; ++i)
        worker.found[worker.listed.place_of(worker.near[i].partner)] = worker.near[i];
    worker.listed.clear();
}

// Drops of worker.found the pairs that belong to the partner, and those that the patches rule out.
void PairSearch::drop_unwanted(const Task& task, const TileSearch& tile, Worker& worker) {
    if (!task.same && !task.topology.has_patches()) return;
    const FeatureTiles &a = task.a, &b = task.b;
    const std::uint32_t* const features = a.features.data() + tile.first_slot;
    unsigned below = 0; // lanes with features below the partner
    std::size_t kept = 0;
    for (std::size_t i = 0; i < worker.count; ++i) {
        auto [lanes, partner, slot] = worker.found[i];
        if (task.same) { // the lower of two features has the pair
            while (below < features_a_tile && features[below] < partner) ++below;
            if (below < features_a_tile) lanes &= (std::uint64_t{1} << below) - 1;
        }
        if (task.topology.has_patches())
            for (std::uint64_t left = lanes; left != 0; left &= left - 1)
                if (!task.topology.may_meet(a.corners_at(tile.first_slot + lowest_lane(left)),
                                            b.corners_at(slot)))
                    lanes &= ~(left & -left);
        worker.found[kept] = {lanes, partner, slot};
        kept += lanes != 0;
    }
    worker.count = kept;
}

void PairSearch::search_tile(const Task& task, std::uint32_t t, Worker& worker) {
    const FeatureTiles &a = task.a, &b = task.b;
    TileSearch tile;
    tile.first_slot = t * features_a_tile;
    const std::uint32_t* const features = a.features.data() + tile.first_slot;
    for (unsigned lane = 0; lane < features_a_tile; ++lane)
        tile.asked |= std::uint64_t{features[lane] - task.first < task.count} << lane;
    if (tile.asked == 0) return;
    tile.lowest = features[lowest_lane(tile.asked)];
    const Box& box = a.tile_boxes[t];
    if (task.motion.doubles) { // each side of a box is less than 2 floats inside the float that bounds it
        float largest = 0;
        for (int i = 0; i < 3; ++i) largest = std::max({largest, std::abs(box.lo[i]), std::abs(box.hi[i])});
        tile.close_by = largest * 0x1p-20f + 0x1p-140f;
    }
    quantise_tile(a.boxes_of(t), box.lo, box.hi, tile.close_by, worker.quantised);
    worker.has_exact = 0;

    const auto for_each_corner = [&](auto&& visit) {
        for (std::uint64_t lanes = tile.asked; lanes != 0; lanes &= lanes - 1)
            for (const std::uint32_t v : a.corners_at(tile.first_slot + lowest_lane(lanes)))
                visit(v, lanes & -lanes);
    };
    worker.around_folded.fill(0);
    for_each_corner([&](std::uint32_t v, std::uint64_t lane) {
        worker.around[v] |= lane;
        worker.around_folded[v % folded_vertices] |= lane;
    });
    worker.count = 0;
    const auto add = b.corner_count == 1 ? add_near<1> : b.corner_count == 2 ? add_near<2> : add_near<3>;
    grid_.around(box, [&](std::uint32_t other) {
        if (worker.seen[other] == t + 1) return;
        worker.seen[other] = t + 1;
        if (!overlap(box, b.tile_boxes[other])) return;
        ++worker.tile_pairs;
        add(task, tile, other, worker);
    });
    for_each_corner([&](std::uint32_t v, std::uint64_t) { worker.around[v] = 0; });
    if (worker.count == 0) return;
    sort_near(worker);
    drop_unwanted(task, tile, worker);
    if (task.motion.cull) cull_found(task, tile, worker);
    keep_found(task, t, worker);
}

void PairSearch::keep_found(const Task& task, std::uint32_t tile, Worker& worker) {
    const std::size_t count = worker.count, blocks = (count + partners_a_block - 1) / partners_a_block;
    found_of_[tile].count = count;
    if (count == 0) return;
    const std::size_t first = worker.kept.size();
    reserve_sparingly(worker.kept, first + blocks * partners_a_block);
    worker.kept.resize(first + blocks * partners_a_block);
    reserve_sparingly(worker.kept_partners, worker.kept_partners.size() + count);
    for (std::size_t i = 0; i < count; ++i) {
        worker.kept[first + i] = worker.found[i].lanes;
        worker.kept_partners.push_back(worker.found[i].partner);
    }
    std::uint32_t counts[features_a_tile] = {};
    turn_blocks(worker.kept.data() + first, blocks, counts);
    for (unsigned lane = 0; lane < features_a_tile; ++lane)
        if (const std::uint32_t f = task.a.features[tile * features_a_tile + lane] - task.first;
            f < task.count)
            task.ends[f] = counts[lane];
}

void PairSearch::write_found(const Task& task, std::size_t tile, FeaturePairs& out) {
    const TileFound& of = found_of_[tile];
    if (of.count == 0) return;
    std::uint32_t *lists[features_a_tile], counts[features_a_tile];
    for (unsigned lane = 0; lane < features_a_tile; ++lane) {
        const std::uint32_t f = task.a.features[tile * features_a_tile + lane] - task.first;
        lists[lane] = nullptr;
        if (f >= task.count) continue; // nor an empty lane
        lists[lane] = out.partners.data() + out.offsets[f];
        counts[lane] = static_cast<std::uint32_t>(out.offsets[f + 1] - out.offsets[f]);
    }
    const Worker& worker = workers_[of.worker];
    write_lists(worker.kept.data() + of.first_word, (of.count + partners_a_block - 1) / partners_a_block,
                worker.kept_partners.data() + of.first_partner, lists, counts);
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
    counters_.cells = grid_.occupied();

    const Task task{topology, motion, tiles_a, tiles_b, a == b, first, count, out.offsets.data() + 1};
    workers_.grow(workers.count());
    for (Worker& worker : workers_) {
        worker.seen.assign(tiles_b.tile_count(), 0u);
        worker.listed.reset(topology.count(b));
        worker.around.assign(topology.vertex_count, 0u);
        worker.kept.clear();
        worker.kept_partners.clear();
        worker.tile_pairs = worker.boxes_compared = worker.culled = 0;
    }
    found_of_.resize(tiles_a.tile_count());
    workers.for_ranges(tiles_a.tile_count(), least_tiles,
                       [&](std::size_t begin, std::size_t end, std::uint32_t w) {
                           Worker& worker = workers_[w];
                           for (std::size_t t = begin; t < end; ++t) {
                               found_of_[t] = {w, worker.kept.size(), worker.kept_partners.size(), 0};
                               search_tile(task, static_cast<std::uint32_t>(t), worker);
                           }
                       });
    for (Worker& worker : workers_) {
        // Its last block may not be full, but is read as one.
        reserve_sparingly(worker.kept_partners, worker.kept_partners.size() + partners_a_block);
        worker.kept_partners.resize(worker.kept_partners.size() + partners_a_block);
        counters_.tile_pairs += worker.tile_pairs;
        counters_.boxes_compared += worker.boxes_compared;
        counters_.culled += worker.culled;
    }
    std::partial_sum(out.offsets.begin(), out.offsets.end(), out.offsets.begin());
    counters_.overlaps = out.offsets[count] + counters_.culled;
    make_room(out.partners, out.offsets[count]);
    workers.for_ranges(tiles_a.tile_count(), least_tiles,
                       [&](std::size_t begin, std::size_t end, std::uint32_t) {
                           for (std::size_t t = begin; t < end; ++t) write_found(task, t, out);
                       });
    workers_.level();
}

} // namespace vox
