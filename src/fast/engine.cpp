// The stages in order. For each body A: the tiles of every body that overlaps it, culled by super-tile, then
// by tile; the vertices of A that may be in them, binned once for all those bodies; the queries. The workers
// share each stage: pieces of bodies, pairs of bodies or whole bodies at a time, each with results of its
// own.
#include "fast/engine.hpp"

#include "base/bits.hpp"
#include "base/clock.hpp"
#include "base/error.hpp"
#include "exact/predicates.hpp"
#include "fast/sides.hpp"
#include "fast/step.hpp"
#include "mesh/check.hpp"
#include "mesh/filter.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

namespace vox {


namespace {

constexpr std::uint32_t piece_supers = 8; // of a piece of a body, at most

template <class Pieces>
void add_pieces(std::uint32_t body, std::uint32_t count, std::uint32_t most, Pieces& pieces) {
    for (std::uint32_t first = 0; first < count; first += most)
        pieces.push_back({body, first, std::min(first + most, count)});
}

// Far from zero floats are far apart: bodies whose positions are rounded anyway are rounded around a point
// among them. Zero where that is near enough, seen from a few of their vertices: it matters to the time
// alone.
Vec3d choose_origin(std::span<const Body> bodies) {
    constexpr std::uint32_t samples = 8;
    constexpr double far = 256; // sizes away
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double lo[3] = {infinity, infinity, infinity}, hi[3] = {-infinity, -infinity, -infinity};
    for (const Body& body : bodies) {
        if (!body.positions.rounded()) continue;
        for (std::uint32_t i = 0; i < std::min(samples, body.vertex_count); ++i) {
            const Vec3d p = body.positions.exact(std::uint64_t{i} * body.vertex_count / samples);
            const double x[3] = {p.x, p.y, p.z};
            for (int a = 0; a < 3; ++a) {
                lo[a] = std::min(lo[a], x[a]);
                hi[a] = std::max(hi[a], x[a]);
            }
        }
    }
    double origin[3] = {};
    for (int a = 0; a < 3; ++a) {
        const double middle = lo[a] / 2 + hi[a] / 2;
        if (std::abs(middle) > far * (hi[a] - lo[a]) && std::isfinite(middle)) origin[a] = middle;
    }
    return {origin[0], origin[1], origin[2]};
}

[[noreturn]] void throw_non_finite(std::span<const Body> bodies) {
    for (const Body& body : bodies) check_finite(body);
    throw Error(VOX_ERROR_INTERNAL, "positions changed during the step");
}

} // namespace

// Turns findings into hits: the exact part of the narrow phase.
class FastEngine::ExactDecisions final : public fast::Findings {
public:
    ExactDecisions(FastEngine& engine, Step& step, std::uint32_t body, Worker& worker)
        : engine_(engine), step_(step), body_(body), worker_(worker), tets_(step.bodies[body].tets),
          self_filter_(step.bodies[body].self_filter) {}

    void take(std::span<const fast::Finding> findings) override {
        const std::uint64_t start = nanoseconds();
        Hit hits[64];
        std::size_t count = 0;
        for (const fast::Finding& f : findings) {
            Containment where = Containment::interior;
            if (!f.certain) {
                where = decide(f);
                if (where == Containment::degenerate || where == Containment::outside) continue;
            }
            if (f.body == body_ && self_filter_ && self_filter_->skips(f.vertex, tets_[f.tet])) {
                ++worker_.filtered;
                continue;
            }
            // In place and as a whole: bit fields set one by one are slow to read back.
            hits[count++] = {
                f.body,   f.vertex, body_, f.tet & 0x7fffffffu, where == Containment::interior ? 1u : 0u,
                f.weights};
            if (count == std::size(hits)) {
                append(std::span(hits, count));
                count = 0;
            }
        }
        append(std::span(hits, count));
        worker_.decision_ns += nanoseconds() - start;
    }

private:
    Containment decide(const fast::Finding& f) {
        const Tet& tet = tets_[f.tet];
        const Positions& q = step_.bodies[body_].positions;
        const Containment where =
            locate(step_.bodies[f.body].positions.exact(f.vertex), q.exact(tet.v[0]), q.exact(tet.v[1]),
                   q.exact(tet.v[2]), q.exact(tet.v[3]), worker_.exact_tests);
        if (where == Containment::degenerate) {
            const std::lock_guard lock(step_.mutex);
            engine_.degenerate_.push_back(std::uint64_t{body_} << 32 | f.tet);
        }
        return where;
    }

    // One list for all workers: how much room it needs does not depend on which of them found what.
    void append(std::span<const Hit> hits) {
        if (hits.empty()) return;
        const std::lock_guard lock(step_.mutex);
        // A quarter more at a time: there may be many, and twice as much room would be held for good.
        const std::size_t count = step_.hits.size() + hits.size();
        if (step_.hits.capacity() < count) step_.hits.reserve(count + count / 4);
        step_.hits.insert(step_.hits.end(), hits.begin(), hits.end());
    }

    FastEngine& engine_;
    Step& step_;
    std::uint32_t body_; // of the tets
    Worker& worker_;
    std::span<const Tet> tets_;
    const SelfFilter* self_filter_;
};

FastEngine::WindowBuffers::WindowBuffers(std::pmr::memory_resource* memory)
    : certificate(memory), active(memory), points(memory), cell_of(memory) {}

FastEngine::Worker::Worker(std::pmr::memory_resource* memory)
    : windows(memory), sources(memory), near(memory), stamps(memory), scratch(memory) {}

FastEngine::FastEngine(std::pmr::memory_resource* memory)
    : states_(memory), body_boxes_(memory), block_boxes_(memory), super_boxes_(memory), tile_boxes_(memory),
      block_moves_(memory), super_upright_(memory), tile_known_(memory), reached_regions_(memory),
      block_sides_(memory), block_pieces_(memory), super_pieces_(memory), piece_boxes_(memory),
      piece_moved_(memory), pair_buffers_(memory), pairs_(memory), reaches_(memory), by_b_(memory),
      first_of_b_(memory), first_of_a_(memory), groups_(memory), bins_(memory), workers_(memory),
      large_buffers_(memory), degenerate_(memory) {}

void FastEngine::detect(std::span<const Body> bodies, std::span<const fast::PreparedBody> prepared,
                  const FastSettings& settings, std::pmr::vector<Hit>& hits, vox_counters& counters,
                  vox_profile& profile) {
    Step step{bodies, prepared, settings, hits};
    const std::uint64_t start = nanoseconds();
    prepare(step);
    stream(step);
    follow_turning(step);
    const std::uint64_t streamed = nanoseconds();
    find_reaches(step);
    const std::uint64_t reached = nanoseconds();
    make_windows(step);
    const std::uint64_t binned = nanoseconds();
    std::size_t tiles = 0;
    for (const fast::PreparedBody& body : prepared) tiles += body.tiles->tiles.size();
    step.for_ranges(super_pieces_.size(), tiles, 32,
                    [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
                        for (std::size_t p = begin; p < end; ++p)
                            query(step, super_pieces_[p], workers_[worker]);
                    });

    level_buffers();

    // Sums, and largest ones: which worker did what does not matter.
    counters.cells = counters.entries = counters.fullest_cell = 0;
    counters.visited_cells = counters.visited_entries = counters.candidates = 0;
    counters.exact_tests = counters.filtered = counters.moved_meshes = 0;
    for (const BodyState& state : states_) counters.moved_meshes += state.moved;
    profile.bin_ns = (streamed - start) + (binned - reached);
    profile.narrow_ns = 0;
    for (const fast::Bins& bins : bins_) {
        counters.cells += bins.occupied_cells;
        counters.entries += bins.points.count;
        counters.fullest_cell = std::max(counters.fullest_cell, bins.fullest_cell);
    }
    for (const Worker& worker : workers_) {
        counters.exact_tests += worker.exact_tests;
        counters.filtered += worker.filtered;
        profile.narrow_ns = std::max(profile.narrow_ns, worker.decision_ns);
        if (worker.scratch.empty()) continue;
        const fast::QueryCounters& counted = worker.scratch[0].counters;
        counters.visited_cells += counted.visited_cells;
        counters.visited_entries += counted.visited_points;
        counters.candidates += counted.candidates;
    }
    std::sort(degenerate_.begin(), degenerate_.end());
    counters.skipped_degenerate =
        static_cast<std::uint64_t>(std::unique(degenerate_.begin(), degenerate_.end()) - degenerate_.begin());
    profile.broad_ns = nanoseconds() - start - profile.bin_ns - profile.narrow_ns;
}

// Lays out the buffers.
void FastEngine::prepare(Step& step) {
    while (workers_.size() < step.worker_count()) workers_.emplace_back(workers_.get_allocator().resource());
    for (Worker& worker : workers_) {
        worker.exact_tests = worker.filtered = worker.decision_ns = 0;
        if (worker.scratch.empty()) continue;
        worker.scratch[0].finding_count = 0;
        worker.scratch[0].counters = {};
    }
    degenerate_.clear();

    step.origin = choose_origin(step.bodies);
    const bool moved_origin = step.origin.x != 0 || step.origin.y != 0 || step.origin.z != 0;
    std::size_t blocks = 0, supers = 0, tiles = 0, moves = 0;
    states_.resize(step.bodies.size());
    groups_.clear();
    std::size_t vertices = group_vertices;
    block_pieces_.clear();
    super_pieces_.clear();
    for (std::uint32_t b = 0; b < step.bodies.size(); ++b) {
        const Tiles& mesh = *step.prepared[b].tiles;
        fast::MeshState& kept = *step.prepared[b].state;
        states_[b] = {};
        states_[b].buffers = none;
        states_[b].rounded = moved_origin || step.bodies[b].positions.rounded();
        kept.last_positions.expect(states_[b].rounded);
        states_[b].positions = !states_[b].rounded && fast::is_packed(step.bodies[b].positions)
                                   ? reinterpret_cast<const float*>(step.bodies[b].positions.data)
                                   : kept.last_positions.positions.data();
        states_[b].moved = !step.settings.carry;
        states_[b].first_block = static_cast<std::uint32_t>(blocks);
        states_[b].first_super = static_cast<std::uint32_t>(supers);
        states_[b].first_tile = static_cast<std::uint32_t>(tiles);
        states_[b].tracked = may_certify(step, b) && kept.orientation.is_known;
        states_[b].first_move = static_cast<std::uint32_t>(moves);
        if (states_[b].tracked) moves += mesh.block_count();
        blocks += mesh.block_count();
        supers += mesh.super_tile_count();
        tiles += mesh.tiles.size();
        add_pieces(b, mesh.block_count(), piece_blocks, block_pieces_);
        add_pieces(b, mesh.super_tile_count(), piece_supers, super_pieces_);
        if (vertices >= group_vertices) {
            groups_.push_back({b, b});
            vertices = 0;
        }
        groups_.back().last = b + 1;
        vertices += step.bodies[b].vertex_count;
    }
    // Each worker may meet any body: one that is more than its share of all gets buffers of its own, so that
    // all buffers together are no more than twice what one worker per body would need.
    std::size_t all_vertices = 0;
    for (const Body& body : step.bodies) all_vertices += body.vertex_count;
    std::uint32_t large = 0;
    for (std::size_t b = 0; b < step.bodies.size() && step.worker_count() > 1; ++b)
        if (std::size_t{step.bodies[b].vertex_count} * step.worker_count() > all_vertices)
            states_[b].buffers = large++;
    while (large_buffers_.size() < large)
        large_buffers_.emplace_back(large_buffers_.get_allocator().resource());
    while (bins_.size() < groups_.size()) bins_.emplace_back(bins_.get_allocator().resource());
    for (fast::Bins& bins : bins_) bins.clear();
    block_boxes_.resize(blocks);
    block_moves_.resize(moves);
    block_sides_.resize(blocks);
    super_boxes_.resize(supers);
    super_upright_.resize(supers);
    tile_boxes_.resize(tiles);
    tile_known_.assign(tiles, 0);
}

// Gives the buffers of all workers the same room: in a later step each may have to do what another did in
// this one.
void FastEngine::level_buffers() {
    if (workers_.size() == 1) return;
    const auto level = [this](auto&& buffer) {
        std::size_t most = 0;
        for (Worker& worker : workers_) most = std::max(most, buffer(worker).capacity());
        for (Worker& worker : workers_) buffer(worker).reserve(most);
    };
    level([](Worker & w) -> auto& { return w.sources; });
    level([](Worker & w) -> auto& { return w.near; });
    level([](Worker & w) -> auto& { return w.stamps; });
    level([](Worker & w) -> auto& { return w.scratch; });
    level([](Worker & w) -> auto& { return w.windows.active; });
    level([](Worker & w) -> auto& { return w.windows.cell_of; });
    level([](Worker & w) -> auto& { return w.windows.points.x; });
    level([](Worker & w) -> auto& { return w.windows.points.y; });
    level([](Worker & w) -> auto& { return w.windows.points.z; });
    level([](Worker & w) -> auto& { return w.windows.points.id; });
    level([](Worker & w) -> auto& { return w.windows.certificate.directions; });
    level([](Worker & w) -> auto& { return w.windows.certificate.components.runs; });
    level([](Worker & w) -> auto& { return w.windows.certificate.components.rows; });
    level([](Worker & w) -> auto& { return w.windows.certificate.touched; });
    level([](Worker & w) -> auto& { return w.windows.certificate.bad; });
    level([](Worker & w) -> auto& { return w.windows.certificate.certified; });
    level([](Worker & w) -> auto& { return w.windows.certificate.with_next; });
}

// Packed positions of the bodies, their boxes, and which of them moved.
void FastEngine::stream(Step& step) {
    std::atomic<bool> finite{true};
    piece_boxes_.resize(block_pieces_.size());
    piece_moved_.resize(block_pieces_.size());
    step.for_ranges(block_pieces_.size(), block_boxes_.size(), piece_blocks,
                    [&](std::size_t begin, std::size_t end, std::uint32_t) {
                        for (std::size_t p = begin; p < end; ++p)
                            if (!stream(step, block_pieces_[p], piece_boxes_[p], piece_moved_[p]))
                                finite.store(false, std::memory_order_relaxed);
                    });
    if (!finite) throw_non_finite(step.bodies);
    body_boxes_.assign(step.bodies.size(), empty_box);
    for (std::size_t p = 0; p < block_pieces_.size(); ++p) {
        const std::uint32_t body = block_pieces_[p].body;
        add(body_boxes_[body], piece_boxes_[p]);
        states_[body].moved |= piece_moved_[p] != 0;
    }
}

bool FastEngine::stream(const Step& step, const Piece& piece, Box& box, std::uint8_t& moved) {
    const Positions& positions = step.bodies[piece.body].positions;
    const BodyState& state = states_[piece.body];
    fast::MeshState& kept = *step.prepared[piece.body].state;
    const std::span<const std::uint32_t> first =
        std::span(step.prepared[piece.body].tiles->block_first).subspan(piece.first, piece.last - piece.first + 1);
    const std::uint32_t begin = first.front(), end = first.back();
    const std::size_t part = piece.first / piece_blocks;
    const bool packed = !state.rounded && fast::is_packed(positions);
    if (state.rounded)
        fast::round_positions(positions, step.origin, begin, end, kept.last_positions.positions.data());
    else if (!packed)
        moved = !fast::copy_strided(kept.last_positions, part, positions, begin, end);
    Box* boxes = block_boxes_.data() + state.first_block + piece.first;
    const bool finite = state.tracked
                            ? fast::stream_boxes(state.positions, kept.orientation.reference.data(), first, boxes,
                                                 block_moves_.data() + state.first_move + piece.first, box)
                            : fast::stream_boxes(state.positions, first, boxes, box);
    if (packed) moved = !fast::compare_packed(kept.last_positions, part, state.positions, begin, end, box);
    if (state.rounded) moved = !fast::compare_exact(kept.last_positions, part, positions, begin, end, box);
    return finite;
}

// Bodies whose surface may tell which of their vertices can be in their own tets.
bool FastEngine::may_certify(const Step& step, std::uint32_t body) const noexcept {
    return step.settings.winding && step.bodies[body].self_collision &&
           step.prepared[body].boundary->is_closed;
}

// The boxes of the super-tiles of such bodies, and which of these hold no tet that may have turned over.
void FastEngine::follow_turning(Step& step) {
    std::size_t tiles = 0;
    for (std::uint32_t b = 0; b < step.bodies.size(); ++b) {
        states_[b].supers_known = states_[b].moved && may_certify(step, b);
        if (states_[b].supers_known) tiles += step.prepared[b].tiles->tiles.size();
    }
    if (tiles == 0) return;
    step.for_ranges(super_pieces_.size(), tiles, 256, [&](std::size_t begin, std::size_t end, std::uint32_t) {
        for (std::size_t p = begin; p < end; ++p) {
            const Piece& piece = super_pieces_[p];
            const BodyState& state = states_[piece.body];
            if (!state.supers_known) continue;
            const Tiles& mesh = *step.prepared[piece.body].tiles;
            fast::follow(mesh, step.prepared[piece.body].state->orientation, block_boxes_.data() + state.first_block,
                         state.tracked ? block_moves_.data() + state.first_move : nullptr,
                         state.rounded ? fast::slack_of_rounding(body_boxes_[piece.body]) : 0, piece.first,
                         piece.last, super_boxes_.data() + state.first_super,
                         super_upright_.data() + state.first_super);
        }
    });
}

// Which vertices may be in tets of which other bodies.
void FastEngine::find_reaches(Step& step) {
    fast::find_pairs(body_boxes_, pair_buffers_, pairs_);
    reaches_.clear();
    if (reaches_.capacity() < pairs_.size()) reaches_.reserve(pairs_.size() + pairs_.size() / 8);
    for (const fast::Pair& pair : pairs_) {
        if (step.bodies[pair.b].tets.empty() || !collide(step.bodies[pair.a], step.bodies[pair.b])) continue;
        if (!states_[pair.a].moved && !states_[pair.b].moved) continue;
        Reach reach{pair.a, pair.b, body_boxes_[pair.a], {}};
        intersect(reach.region, body_boxes_[pair.b]);
        reaches_.push_back(reach);
    }
    std::size_t blocks = 0, tiles = 0;
    for (const Reach& reach : reaches_) blocks += step.prepared[reach.a].tiles->block_count();
    step.for_ranges(reaches_.size(), blocks, 4096, [&](std::size_t begin, std::size_t end, std::uint32_t) {
        for (std::size_t r = begin; r < end; ++r) shrink_to_blocks(step, reaches_[r]);
    });
    std::erase_if(reaches_, [](const Reach& reach) { return is_empty(reach.region); });
    sort_reaches(step);

    reached_regions_.assign(step.bodies.size(), empty_box);
    for (const Reach& reach : reaches_) {
        states_[reach.b].reached = true;
        add(reached_regions_[reach.b], reach.region);
        tiles += step.prepared[reach.b].tiles->tiles.size();
    }
    step.for_ranges(block_pieces_.size(), reaches_.empty() ? 0 : block_boxes_.size(), 4 * piece_blocks,
                    [&](std::size_t begin, std::size_t end, std::uint32_t) {
                        for (std::size_t p = begin; p < end; ++p) find_sides(step, block_pieces_[p]);
                    });
    step.for_ranges(super_pieces_.size(), reaches_.empty() ? 0 : tile_boxes_.size(), 256,
                    [&](std::size_t begin, std::size_t end, std::uint32_t) {
                        for (std::size_t p = begin; p < end; ++p) know_tiles(step, super_pieces_[p]);
                    });
    step.for_ranges(reaches_.size(), tiles, 4096, [&](std::size_t begin, std::size_t end, std::uint32_t) {
        for (std::size_t r = begin; r < end; ++r) shrink_to_tiles(step, reaches_[r]);
    });
}

// Shrinks the region where the bodies' boxes overlap to what blocks of a reach of it.
void FastEngine::shrink_to_blocks(const Step& step, Reach& reach) const {
    Box reached = empty_box;
    const Box* blocks = block_boxes_.data() + states_[reach.a].first_block;
    const std::uint32_t count = step.prepared[reach.a].tiles->block_count();
    for (std::uint32_t i = 0; i < count; i += fast::most_boxes) {
        std::uint64_t met =
            fast::find_overlaps(blocks + i, std::min(fast::most_boxes, count - i), reach.region);
        for (; met; met &= met - 1)
            add(reached, blocks[i + static_cast<std::uint32_t>(std::countr_zero(met))]);
    }
    intersect(reach.region, reached);
}

// Where each body begins in reaches_, and the same by b: counted, summed, placed.
void FastEngine::sort_reaches(const Step& step) {
    first_of_a_.assign(step.bodies.size() + 1, 0);
    first_of_b_.assign(step.bodies.size() + 2, 0);
    for (const Reach& r : reaches_) {
        ++first_of_a_[r.a + 1];
        ++first_of_b_[r.b + 2];
    }
    std::partial_sum(first_of_a_.begin(), first_of_a_.end(), first_of_a_.begin());
    std::partial_sum(first_of_b_.begin(), first_of_b_.end(), first_of_b_.begin());
    by_b_.resize(reaches_.size());
    for (std::uint32_t r = 0; r < reaches_.size(); ++r) by_b_[first_of_b_[reaches_[r].b + 1]++] = r;
}

std::span<const std::uint32_t> FastEngine::reaching(std::uint32_t b) const noexcept {
    return std::span(by_b_).subspan(first_of_b_[b], first_of_b_[b + 1] - first_of_b_[b]);
}

// Bodies whose super-tiles matter only where others reach them.
bool FastEngine::knows_sides(const Step& step, std::uint32_t body) const noexcept {
    return states_[body].reached && !step.bodies[body].self_collision;
}

// Where the blocks of a body lie, seen from the region where others reach it: a byte tells most super-tiles
// to be out of reach, and is less to read than a box.
void FastEngine::find_sides(const Step& step, const Piece& piece) {
    if (!knows_sides(step, piece.body)) return;
    const std::size_t first = states_[piece.body].first_block;
    const Box region = reached_regions_[piece.body];
    fast::find_sides(&block_boxes_[first + piece.first], piece.last - piece.first, region,
                     &block_sides_[first + piece.first]);
}

// Boxes that hold super-tiles: of the blocks their vertices are in; empty where all those blocks lie on one
// side of what matters.
void FastEngine::know_super_tiles(const Step& step, const Piece& piece) {
    const BodyState& state = states_[piece.body];
    const Tiles& mesh = *step.prepared[piece.body].tiles;
    const Box* blocks = block_boxes_.data() + state.first_block;
    const std::uint8_t* sides = block_sides_.data() + state.first_block;
    const bool knows_sides = this->knows_sides(step, piece.body);
    const auto out_of_reach = [&](std::span<const std::uint32_t> of) {
        constexpr std::size_t at_once = 8; // between branches
        unsigned common = all_sides;
        std::size_t i = 0;
        for (; i + at_once <= of.size() && common; i += at_once)
            for (std::size_t j = 0; j < at_once; ++j) common &= sides[of[i + j]];
        for (; i < of.size() && common; ++i) common &= sides[of[i]];
        return common != 0;
    };
    for (std::uint32_t s = piece.first; s < piece.last; ++s) {
        Box box = empty_box;
        const std::span<const std::uint32_t> of = std::as_const(mesh.blocks)[s];
        if (!knows_sides || !out_of_reach(of))
            for (const std::uint32_t block : of) add(box, blocks[block]);
        super_boxes_[state.first_super + s] = box;
    }
}

// The boxes of the super-tiles of a body, and of all tiles in those that others reach.
void FastEngine::know_tiles(const Step& step, const Piece& piece) {
    const BodyState& state = states_[piece.body];
    if (!state.reached) return;
    if (!state.supers_known) know_super_tiles(step, piece);
    const Tiles& mesh = *step.prepared[piece.body].tiles;
    const std::span<const std::uint32_t> reaches = reaching(piece.body);
    for (std::uint32_t s = piece.first; s < piece.last; ++s) {
        const Box& box = super_boxes_[state.first_super + s];
        if (std::any_of(reaches.begin(), reaches.end(),
                        [&](std::uint32_t r) { return overlap(box, reaches_[r].region); }))
            fast::tile_boxes(mesh, state.positions, mesh.super_first[s], mesh.super_first[s + 1],
                             tile_boxes_.data() + state.first_tile, tile_known_.data() + state.first_tile);
    }
}

// Shrinks the region to what tiles of b cover.
void FastEngine::shrink_to_tiles(const Step& step, Reach& reach) const {
    const BodyState& state = states_[reach.b];
    const Tiles& mesh = *step.prepared[reach.b].tiles;
    const std::uint32_t super_tiles = mesh.super_tile_count();
    const Box* boxes = tile_boxes_.data() + state.first_tile;
    Box covered = empty_box;
    for (std::uint32_t s = 0; s < super_tiles; ++s) {
        if (!overlap(super_boxes_[state.first_super + s], reach.region)) continue;
        for (std::uint32_t t = mesh.super_first[s]; t < mesh.super_first[s + 1]; ++t) {
            if (!overlap(boxes[t], reach.region)) continue;
            add(covered, boxes[t]);
            reach.sides.add(boxes[t]);
        }
    }
    intersect(reach.region, covered);
    if (is_empty(reach.region)) reach.region = empty_box;
}

// Tiles of a body against the windows of the bodies that reach it.
void FastEngine::query(Step& step, const Piece& piece, Worker& worker) {
    const std::uint32_t b = piece.body;
    const BodyState& state = states_[b];
    const bool self = state.self && state.bins;
    const std::span<const std::uint32_t> reaches = reaching(b);
    if (!self && reaches.empty()) return;
    if (!state.reached && !state.supers_known) know_super_tiles(step, piece);
    const Box* super_boxes = super_boxes_.data() + state.first_super;
    Box box = empty_box;
    for (std::uint32_t s = piece.first; s < piece.last; ++s) add(box, super_boxes[s]);

    std::pmr::vector<fast::Source>& sources = worker.sources;
    sources.clear();
    const auto add = [&](std::uint32_t a, const Box& region) {
        Box both = box;
        intersect(both, region);
        if (!states_[a].bins || is_empty(both)) return;
        fast::for_windows(*states_[a].bins, states_[a].root, both, [&](const fast::Window& window) {
            fast::Source source{window, region, a};
            intersect(source.region, window.box);
            sources.push_back(source);
        });
    };
    if (self) add(b, state.own);
    for (const std::uint32_t r : reaches) add(reaches_[r].a, reaches_[r].region);
    if (sources.empty()) return;

    const Tiles& mesh = *step.prepared[b].tiles;
    fast::Query query{};
    query.tiles = &mesh;
    query.positions = state.positions;
    query.boxes = tile_boxes_.data() + state.first_tile;
    query.known = tile_known_.data() + state.first_tile;
    query.rounded = state.rounded;
    for (const fast::Source& source : sources) query.rounded |= states_[source.body].rounded;
    if (worker.scratch.empty()) worker.scratch.resize(1);
    fast::QueryScratch& scratch = worker.scratch[0];
    scratch.finding_count = 0; // another piece may have failed and left some
    if (self) {
        const std::size_t vertices = step.bodies[b].vertex_count;
        if (worker.stamps.size() < vertices) worker.stamps.resize(vertices, 0);
        // The stamps of a tile must not be mistaken for another's, also not after the tag has run over.
        if ((scratch.tag >> 6) + mesh.tiles.size() >= 1u << 26) {
            std::fill(worker.stamps.begin(), worker.stamps.end(), 0u);
            scratch.tag = 0;
        }
    }
    ExactDecisions decide(*this, step, b, worker);
    std::pmr::vector<fast::Source>& near = worker.near;
    for (std::uint32_t s = piece.first; s < piece.last; ++s) {
        near.clear();
        for (const fast::Source& source : sources) {
            if (!overlap(super_boxes[s], source.region)) continue;
            if (source.body == b) { // where most of a body is certified, few meet what is left
                Box met = super_boxes[s];
                intersect(met, source.region);
                if (!fast::holds_point(source.window, met)) continue;
            }
            near.push_back(source);
        }
        if (near.empty()) continue;
        query.stamps = near[0].body == b ? worker.stamps.data() : nullptr;
        fast::query_tiles(query, near, mesh.super_first[s], mesh.super_first[s + 1], scratch, decide);
    }
    fast::flush(scratch, decide);
}

} // namespace vox
