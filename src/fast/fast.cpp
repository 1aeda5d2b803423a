// The stages in order. Per body A: the tiles of every body that overlaps it, culled by super-tile, then by
// tile; the vertices of A that may be in them, binned once for all those bodies; the queries.
#include "fast.hpp"

#include "error.hpp"
#include "predicates.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

namespace vox {

using fast::Box;

struct Fast::Step {
    std::span<const Body> bodies;
    std::span<const FastMesh* const> prepared;
    const FastSettings& settings;
    std::pmr::vector<Hit>& hits;
    vox_counters& counters;
    vox_profile& profile;
};

namespace {

// Edge length of a cell in mean box sides of a tile: the optimum is flat from 0.4 to 0.9.
constexpr double cells_per_tile = 0.6;
// Most cells of a window, by vertices in it.
constexpr std::size_t cells_per_vertex = 4;
// A cell size asked for is kept up to this many times the automatic one: beyond it, every tile would meet
// every vertex.
constexpr double largest_factor = 16;

std::uint64_t nanoseconds() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
}

std::uint32_t block_count(std::uint32_t vertices) {
    return (vertices + fast::block_size - 1) / fast::block_size;
}

[[noreturn]] void throw_non_finite(std::span<const Body> bodies) {
    for (const Body& body : bodies)
        for (std::uint32_t v = 0; v < body.vertex_count; ++v) {
            const Vec3f p = body.positions[v];
            if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)))
                throw Error(VOX_ERROR_NON_FINITE,
                            format("mesh %u, vertex %u: position (%g, %g, %g) is not finite", body.mesh_id, v,
                                   double{p.x}, double{p.y}, double{p.z}));
        }
    throw Error(VOX_ERROR_INTERNAL, "positions changed during the step");
}

// Turns findings into hits: the exact part of the narrow phase.
class Decide final : public fast::Findings {
public:
    Decide(std::span<const Body> bodies, std::uint32_t a, std::uint32_t b, std::pmr::vector<Hit>& hits,
           std::pmr::vector<std::uint64_t>& degenerate)
        : a_(bodies[a]), b_(bodies[b]), body_a_(a), body_b_(b), hits_(hits), degenerate_(degenerate) {}

    void take(std::span<const fast::Finding> findings) override {
        const std::uint64_t start = nanoseconds();
        for (const fast::Finding& f : findings) {
            Containment where = Containment::interior;
            if (!f.certain) {
                const Tet& tet = b_.tets[f.tet];
                where = locate(a_.positions[f.vertex], b_.positions[tet.v[0]], b_.positions[tet.v[1]],
                               b_.positions[tet.v[2]], b_.positions[tet.v[3]], exact_tests);
                if (where == Containment::degenerate)
                    degenerate_.push_back(std::uint64_t{body_b_} << 32 | f.tet);
                if (where == Containment::degenerate || where == Containment::outside) continue;
            }
            Hit hit{};
            hit.body_a = body_a_;
            hit.vertex = f.vertex;
            hit.body_b = body_b_;
            hit.tet = f.tet;
            hit.interior = where == Containment::interior;
            hits_.push_back(hit);
        }
        time_ns += nanoseconds() - start;
    }

    std::uint64_t exact_tests = 0, time_ns = 0;

private:
    const Body &a_, &b_;
    std::uint32_t body_a_, body_b_;
    std::pmr::vector<Hit>& hits_;
    std::pmr::vector<std::uint64_t>& degenerate_;
};

} // namespace

Fast::Fast(std::pmr::memory_resource* memory)
    : packed_(memory), states_(memory), body_boxes_(memory), block_boxes_(memory), super_boxes_(memory),
      tile_boxes_(memory), tile_known_(memory), order_(memory), pairs_(memory), partners_(memory),
      tile_list_(memory), list_boxes_(memory), block_marks_(memory), points_(memory), window_(memory),
      stamps_(memory), scratch_(memory), degenerate_(memory) {}

void Fast::detect(std::span<const Body> bodies, std::span<const FastMesh* const> prepared,
                  const FastSettings& settings, std::pmr::vector<Hit>& hits, vox_counters& counters,
                  vox_profile& profile) {
    counters.cells = counters.entries = counters.fullest_cell = 0;
    counters.visited_cells = counters.visited_entries = counters.candidates = 0;
    counters.exact_tests = counters.skipped_degenerate = 0;
    profile.bin_ns = profile.broad_ns = profile.narrow_ns = 0;
    if (scratch_.empty()) scratch_.resize(1);
    scratch_[0].finding_count = 0;
    scratch_[0].counters = {};
    degenerate_.clear();

    Step step{bodies, prepared, settings, hits, counters, profile};
    const std::uint64_t start = nanoseconds();
    stream(step);
    profile.bin_ns = nanoseconds() - start;

    fast::find_pairs(body_boxes_, order_, pairs_);
    std::size_t first = 0;
    for (std::uint32_t a = 0; a < bodies.size(); ++a) {
        std::size_t last = first;
        while (last < pairs_.size() && pairs_[last].a == a) ++last;
        detect_body(step, a, std::span(pairs_).subspan(first, last - first));
        first = last;
    }

    const fast::QueryCounters& counted = scratch_[0].counters;
    counters.visited_cells = counted.visited_cells;
    counters.visited_entries = counted.visited_points;
    counters.candidates = counted.candidates;
    std::sort(degenerate_.begin(), degenerate_.end());
    counters.skipped_degenerate =
        static_cast<std::uint64_t>(std::unique(degenerate_.begin(), degenerate_.end()) - degenerate_.begin());
    profile.broad_ns = nanoseconds() - start - profile.bin_ns - profile.narrow_ns;
}

// Packed positions of a body, and its boxes.
void Fast::stream(Step& step) {
    std::size_t blocks = 0, supers = 0, tiles = 0, strided = 0;
    states_.resize(step.bodies.size());
    body_boxes_.resize(step.bodies.size());
    const auto is_packed = [](const Body& body) {
        return body.positions.byte_stride == sizeof(Vec3f) &&
               reinterpret_cast<std::uintptr_t>(body.positions.data) % alignof(float) == 0;
    };
    for (std::size_t b = 0; b < step.bodies.size(); ++b) {
        const Body& body = step.bodies[b];
        states_[b] = {nullptr, static_cast<std::uint32_t>(blocks), static_cast<std::uint32_t>(supers),
                      static_cast<std::uint32_t>(tiles), false};
        blocks += block_count(body.vertex_count);
        supers += step.prepared[b]->super_tile_count();
        tiles += step.prepared[b]->tiles.size();
        if (!is_packed(body)) strided += body.vertex_count;
    }
    block_boxes_.resize(blocks);
    super_boxes_.resize(supers);
    tile_boxes_.resize(tiles);
    tile_known_.assign(tiles, 0);
    packed_.resize(3 * strided);

    bool finite = true;
    strided = 0;
    for (std::size_t b = 0; b < step.bodies.size(); ++b) {
        const Body& body = step.bodies[b];
        BodyState& state = states_[b];
        body_boxes_[b] = fast::empty_box;
        if (body.vertex_count == 0) continue;
        if (is_packed(body)) {
            state.positions = reinterpret_cast<const float*>(body.positions.data);
        } else {
            pack(body, strided);
            state.positions = packed_.data() + 3 * strided;
            strided += body.vertex_count;
        }
        finite &= fast::stream_boxes(state.positions, body.vertex_count,
                                     block_boxes_.data() + state.first_block, body_boxes_[b]);
    }
    if (!finite) throw_non_finite(step.bodies);
}

void Fast::pack(const Body& body, std::size_t first) {
    float* out = packed_.data() + 3 * first;
    for (std::uint32_t v = 0; v < body.vertex_count; ++v) {
        const Vec3f p = body.positions[v];
        *out++ = p.x;
        *out++ = p.y;
        *out++ = p.z;
    }
}

// Boxes that hold the super-tiles: of the blocks their vertices are in.
void Fast::know_super_tiles(Step& step, std::uint32_t body) {
    BodyState& state = states_[body];
    if (state.super_known) return;
    state.super_known = true;
    const FastMesh& mesh = *step.prepared[body];
    const Box* blocks = block_boxes_.data() + state.first_block;
    for (std::uint32_t s = 0; s < mesh.super_tile_count(); ++s) {
        Box box = fast::empty_box;
        for (std::uint32_t i = mesh.block_begin[s]; i < mesh.block_begin[s + 1]; ++i)
            fast::add(box, blocks[mesh.blocks[i]]);
        super_boxes_[state.first_super + s] = box;
    }
}

// Lists the tiles that meet partner.region and shrinks it to the part that they cover.
void Fast::select_tiles(Step& step, Partner& partner) {
    know_super_tiles(step, partner.body);
    const BodyState& state = states_[partner.body];
    const FastMesh& mesh = *step.prepared[partner.body];
    const auto tiles = static_cast<std::uint32_t>(mesh.tiles.size());
    Box covered = fast::empty_box;
    partner.first = tile_list_.size();
    for (std::uint32_t s = 0; s < mesh.super_tile_count(); ++s) {
        if (!fast::overlap(super_boxes_[state.first_super + s], partner.region)) continue;
        const std::uint32_t end = std::min(tiles, (s + 1) * fast::super_tile_size);
        for (std::uint32_t t = s * fast::super_tile_size; t < end; ++t) {
            Box& box = tile_boxes_[state.first_tile + t];
            if (!tile_known_[state.first_tile + t]) {
                fast::tile_boxes(mesh, state.positions, std::span(&t, 1), &box);
                tile_known_[state.first_tile + t] = 1;
            }
            if (!fast::overlap(box, partner.region)) continue;
            tile_list_.push_back(t);
            list_boxes_.push_back(box);
            fast::add(covered, box);
        }
    }
    partner.count = tile_list_.size() - partner.first;
    fast::intersect(partner.region, covered);
}

// Marks the blocks of a body that meet the region of a partner.
void Fast::mark_blocks(const Step& step, std::uint32_t body, bool all) {
    const std::uint32_t blocks = block_count(step.bodies[body].vertex_count);
    block_marks_.assign(blocks, all ? 1 : 0);
    if (all) return;
    const Box* boxes = block_boxes_.data() + states_[body].first_block;
    for (const Partner& partner : partners_)
        for (std::uint32_t b = 0; b < blocks; ++b) block_marks_[b] |= fast::overlap(boxes[b], partner.region);
}

// From the mean side of tiles that will query the window.
double Fast::automatic_cell_size(const Step& step, std::uint32_t body, bool self) const {
    double sides = 0, count = 0;
    const auto take = [&](const Box& box) {
        for (int a = 0; a < 3; ++a) sides += double{box.hi[a]} - double{box.lo[a]};
        count += 3;
    };
    const std::size_t listed = list_boxes_.size();
    for (std::size_t i = 0; i < 64 && i < listed; ++i)
        take(list_boxes_[i * listed / std::min<std::size_t>(64, listed)]);
    if (self) {
        const FastMesh& mesh = *step.prepared[body];
        const std::size_t tiles = mesh.tiles.size(), samples = std::min<std::size_t>(64, tiles);
        for (std::size_t i = 0; i < samples; ++i) {
            const auto t = static_cast<std::uint32_t>(i * tiles / samples);
            Box box;
            fast::tile_boxes(mesh, states_[body].positions, std::span(&t, 1), &box);
            take(box);
        }
    }
    return count > 0 ? cells_per_tile * sides / count : 0;
}

void Fast::detect_body(Step& step, std::uint32_t a, std::span<const fast::Pair> pairs) {
    const Body& body = step.bodies[a];
    const BodyState& state = states_[a];
    const bool self = body.self_collision && !body.tets.empty();

    partners_.clear();
    tile_list_.clear();
    list_boxes_.clear();
    for (const fast::Pair& pair : pairs) {
        if (step.bodies[pair.b].tets.empty()) continue;
        Partner partner{pair.b, body_boxes_[a], 0, 0};
        fast::intersect(partner.region, body_boxes_[pair.b]);
        // Only as far as blocks of A reach into it.
        Box reach = fast::empty_box;
        const Box* blocks = block_boxes_.data() + state.first_block;
        for (std::uint32_t b = 0; b < block_count(body.vertex_count); ++b)
            if (fast::overlap(blocks[b], partner.region)) fast::add(reach, blocks[b]);
        fast::intersect(partner.region, reach);
        if (fast::is_empty(partner.region)) continue;
        select_tiles(step, partner);
        if (partner.count) partners_.push_back(partner);
    }
    if (partners_.empty() && !self) return;

    // Vertices that may be in a tile.
    const std::uint64_t start = nanoseconds();
    mark_blocks(step, a, self);
    Box region = self ? body_boxes_[a] : fast::empty_box;
    for (const Partner& partner : partners_) fast::add(region, partner.region);
    points_.count = 0;
    points_.reserve(static_cast<std::size_t>(std::count(block_marks_.begin(), block_marks_.end(), 1)) *
                    fast::block_size);
    for (std::uint32_t b = 0; b < block_marks_.size(); ++b)
        if (block_marks_[b])
            fast::collect(state.positions, b * fast::block_size,
                          std::min(body.vertex_count, (b + 1) * fast::block_size), region, points_);
    if (points_.count) {
        const double automatic = automatic_cell_size(step, a, self);
        cell_size_ = step.settings.cell_size > 0
                         ? std::min(step.settings.cell_size, largest_factor * automatic)
                         : automatic;
        const Box box = fast::bounds(points_);
        window_.lattice = fast::make_lattice(box, cell_size_, cells_per_vertex * points_.count + 64);
        fast::bin(points_, window_);
        step.counters.cells += window_.occupied_cells;
        step.counters.entries += points_.count;
        step.counters.fullest_cell = std::max(step.counters.fullest_cell, window_.fullest_cell);
        // Tiles that meet the vertices' box.
        for (Partner& partner : partners_) {
            std::size_t kept = partner.first;
            for (std::size_t i = partner.first; i < partner.first + partner.count; ++i)
                if (fast::overlap(list_boxes_[i], box)) {
                    tile_list_[kept] = tile_list_[i];
                    list_boxes_[kept++] = list_boxes_[i];
                }
            partner.count = kept - partner.first;
        }
    }
    step.profile.bin_ns += nanoseconds() - start;
    if (!points_.count) return;

    for (const Partner& partner : partners_) {
        fast::Query query{};
        query.tiles = step.prepared[partner.body];
        query.positions = states_[partner.body].positions;
        query.list = tile_list_.data() + partner.first;
        query.boxes = list_boxes_.data() + partner.first;
        query.count = partner.count;
        this->query(step, a, partner.body, query);
    }
    if (self) {
        // The stamps of a tile must not be mistaken for another's, also not after the tag has run over.
        if (stamps_.size() < body.vertex_count) stamps_.resize(body.vertex_count, 0);
        constexpr std::size_t most_tiles = 1u << 25;
        const FastMesh& mesh = *step.prepared[a];
        for (std::size_t first = 0; first < mesh.tiles.size(); first += most_tiles) {
            fast::Query query{};
            query.tiles = &mesh;
            query.positions = state.positions;
            query.first = static_cast<std::uint32_t>(first);
            query.count = std::min(most_tiles, mesh.tiles.size() - first);
            query.stamps = stamps_.data();
            if ((scratch_[0].tag >> 6) + query.count >= 1u << 26) {
                std::fill(stamps_.begin(), stamps_.end(), 0u);
                scratch_[0].tag = 0;
            }
            this->query(step, a, a, query);
        }
    }
}

void Fast::query(Step& step, std::uint32_t body_a, std::uint32_t body_b, fast::Query& query) {
    query.window = &window_;
    Decide decide(step.bodies, body_a, body_b, step.hits, degenerate_);
    fast::query_tiles(query, scratch_[0], decide);
    fast::flush(scratch_[0], decide);
    step.counters.exact_tests += decide.exact_tests;
    step.profile.narrow_ns += decide.time_ns;
}

} // namespace vox
