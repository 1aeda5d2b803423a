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
constexpr std::size_t cells_per_vertex = 2;
// A cell size asked for is kept up to this many times the automatic one: beyond it, every tile would meet
// every vertex.
constexpr double largest_factor = 16;
// Self-collision is culled by winding numbers from this many tets, and this many tets a boundary triangle,
// on; in cells of so many mean box sides of a tile.
constexpr std::size_t min_winding_tets = 2000;
constexpr std::size_t max_surface = 8;
constexpr double winding_cells_per_tile = 0.8;

std::uint64_t nanoseconds() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
}

// The harmonic mean of the sides of tiles: a few that reach across the world do not count.
void add_tile(const Box& box, double& inverse_sides, double& count) {
    const double sides = (double{box.hi[0]} - double{box.lo[0]}) + (double{box.hi[1]} - double{box.lo[1]}) +
                         (double{box.hi[2]} - double{box.lo[2]});
    if (!(sides > 0)) return;
    inverse_sides += 3 / sides;
    count += 1;
}

double mean_side(double inverse_sides, double count) { return count > 0 ? count / inverse_sides : 0; }

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
    Decide(std::span<const Body> bodies, std::uint32_t body, std::pmr::vector<Hit>& hits,
           std::pmr::vector<std::uint64_t>& degenerate)
        : bodies_(bodies), body_(body), hits_(hits), degenerate_(degenerate) {}

    void take(std::span<const fast::Finding> findings) override {
        const std::uint64_t start = nanoseconds();
        for (const fast::Finding& f : findings) {
            Containment where = Containment::interior;
            if (!f.certain) {
                const Tet& tet = bodies_[body_].tets[f.tet];
                const Positions& q = bodies_[body_].positions;
                where = locate(bodies_[f.body].positions[f.vertex], q[tet.v[0]], q[tet.v[1]], q[tet.v[2]],
                               q[tet.v[3]], exact_tests);
                if (where == Containment::degenerate)
                    degenerate_.push_back(std::uint64_t{body_} << 32 | f.tet);
                if (where == Containment::degenerate || where == Containment::outside) continue;
            }
            Hit hit{};
            hit.body_a = f.body;
            hit.vertex = f.vertex;
            hit.body_b = body_;
            hit.tet = f.tet;
            hit.interior = where == Containment::interior;
            hits_.push_back(hit);
        }
        time_ns += nanoseconds() - start;
    }

    std::uint64_t exact_tests = 0, time_ns = 0;

private:
    std::span<const Body> bodies_;
    std::uint32_t body_; // of the tets
    std::pmr::vector<Hit>& hits_;
    std::pmr::vector<std::uint64_t>& degenerate_;
};

} // namespace

void FastMesh::prepare(const Body& body) {
    FastMesh made(surface.triangles.get_allocator().resource());
    fast::make_tiles(body.tets, body.vertex_count, body.positions, made);
    if (body.self_collision) {
        fast::make_surface(body.tets, body.vertex_count, body.positions, made, made.surface);
        // A surface that is most of the body never pays.
        if (made.surface.triangles.size() * max_surface > body.tets.size() ||
            body.tets.size() < min_winding_tets)
            made.surface = fast::Surface(surface.triangles.get_allocator().resource());
    }
    *this = std::move(made);
}

Fast::Fast(std::pmr::memory_resource* memory)
    : packed_(memory), states_(memory), body_boxes_(memory), block_boxes_(memory), super_boxes_(memory),
      tile_boxes_(memory), tile_known_(memory), pair_buffers_(memory), pairs_(memory), reaches_(memory),
      by_b_(memory), first_of_(memory), certificate_(memory), active_(memory), points_(memory), bins_(memory),
      sources_(memory), near_(memory), stamps_(memory), scratch_(memory), degenerate_(memory) {}

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

    fast::find_pairs(body_boxes_, pair_buffers_, pairs_);
    reaches_.clear();
    for (const fast::Pair& pair : pairs_) {
        if (bodies[pair.b].tets.empty()) continue;
        Reach reached{pair.a, pair.b, body_boxes_[pair.a]};
        fast::intersect(reached.region, body_boxes_[pair.b]);
        reach(step, reached);
        if (!fast::is_empty(reached.region)) reaches_.push_back(reached);
    }

    const std::uint64_t reached = nanoseconds();
    std::size_t first = 0;
    for (std::uint32_t a = 0; a < bodies.size(); ++a) {
        std::size_t last = first;
        while (last < reaches_.size() && reaches_[last].a == a) ++last;
        make_window(step, a, std::span(reaches_).subspan(first, last - first));
        first = last;
    }
    counters.cells = bins_.occupied_cells;
    counters.entries = bins_.points.count;
    counters.fullest_cell = bins_.fullest_cell;
    profile.bin_ns += nanoseconds() - reached;

    // Sorted by b, then a: counted, summed, placed.
    first_of_.assign(bodies.size() + 1, 0);
    for (const Reach& r : reaches_) ++first_of_[r.b + 1];
    std::partial_sum(first_of_.begin(), first_of_.end(), first_of_.begin());
    by_b_.resize(reaches_.size());
    for (std::uint32_t r = 0; r < reaches_.size(); ++r) by_b_[first_of_[reaches_[r].b]++] = r;
    for (std::uint32_t b = 0; b < bodies.size(); ++b) {
        const std::uint32_t begin = b == 0 ? 0 : first_of_[b - 1];
        query(step, b, std::span(by_b_).subspan(begin, first_of_[b] - begin));
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
        states_[b] = {};
        states_[b].first_block = static_cast<std::uint32_t>(blocks);
        states_[b].first_super = static_cast<std::uint32_t>(supers);
        states_[b].first_tile = static_cast<std::uint32_t>(tiles);
        blocks += step.prepared[b]->block_count();
        supers += step.prepared[b]->super_tile_count();
        tiles += step.prepared[b]->tiles.size();
        if (!is_packed(body)) strided += body.vertex_count;
    }
    block_boxes_.resize(blocks);
    super_boxes_.resize(supers);
    tile_boxes_.resize(tiles);
    tile_known_.assign(tiles, 0);
    packed_.resize(3 * strided);
    bins_.clear();

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
        finite &= fast::stream_boxes(state.positions, body.vertex_count, step.prepared[b]->block_first,
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

// Boxes that hold the super-tiles: of their tiles where those are known, else of the blocks their vertices
// are in.
void Fast::know_super_tiles(Step& step, std::uint32_t body) {
    BodyState& state = states_[body];
    if (state.super_known) return;
    state.super_known = true;
    const FastMesh& mesh = *step.prepared[body];
    if (state.tiles_known) {
        for (std::uint32_t s = 0; s < mesh.super_tile_count(); ++s) {
            Box box = fast::empty_box;
            for (std::uint32_t t = mesh.super_first[s]; t < mesh.super_first[s + 1]; ++t)
                fast::add(box, tile_boxes_[state.first_tile + t]);
            super_boxes_[state.first_super + s] = box;
        }
        return;
    }
    const Box* blocks = block_boxes_.data() + state.first_block;
    for (std::uint32_t s = 0; s < mesh.super_tile_count(); ++s) {
        Box box = fast::empty_box;
        for (std::uint32_t i = mesh.block_begin[s]; i < mesh.block_begin[s + 1]; ++i)
            fast::add(box, blocks[mesh.blocks[i]]);
        super_boxes_[state.first_super + s] = box;
    }
}

// Shrinks the region where the bodies' boxes overlap to what blocks of a reach of it, and that to what tiles
// of b cover.
void Fast::reach(Step& step, Reach& reach) {
    Box reached = fast::empty_box;
    const Box* blocks = block_boxes_.data() + states_[reach.a].first_block;
    const std::uint32_t count = step.prepared[reach.a]->block_count();
    for (std::uint32_t i = 0; i < count; ++i)
        if (fast::overlap(blocks[i], reach.region)) fast::add(reached, blocks[i]);
    fast::intersect(reach.region, reached);
    if (fast::is_empty(reach.region)) return;

    know_super_tiles(step, reach.b);
    const BodyState& state = states_[reach.b];
    const FastMesh& mesh = *step.prepared[reach.b];
    const std::uint32_t super_tiles = mesh.super_tile_count();
    Box* boxes = tile_boxes_.data() + state.first_tile;
    std::uint8_t* known = tile_known_.data() + state.first_tile;
    Box covered = fast::empty_box;
    double inverse_sides = 0, number = 0;
    for (std::uint32_t s = 0; s < super_tiles; ++s) {
        if (!fast::overlap(super_boxes_[state.first_super + s], reach.region)) continue;
        const std::uint32_t first = mesh.super_first[s], last = mesh.super_first[s + 1];
        fast::tile_boxes(mesh, state.positions, first, last, boxes, known);
        for (std::uint32_t t = first; t < last; ++t) {
            if (!fast::overlap(boxes[t], reach.region)) continue;
            fast::add(covered, boxes[t]);
            add_tile(boxes[t], inverse_sides, number);
        }
    }
    fast::intersect(reach.region, covered);
    states_[reach.a].inverse_sides += inverse_sides;
    states_[reach.a].tile_count += number;
}

// add_tile() for some tiles of a body.
void Fast::sample_tiles(const Step& step, std::uint32_t body, double& inverse_sides, double& count) {
    const FastMesh& mesh = *step.prepared[body];
    const BodyState& state = states_[body];
    const auto tiles = static_cast<std::uint32_t>(mesh.tiles.size()), samples = std::min(64u, tiles);
    for (std::uint32_t i = 0; i < samples; ++i) {
        const auto t = static_cast<std::uint32_t>(std::uint64_t{i} * tiles / samples);
        fast::tile_boxes(mesh, state.positions, t, t + 1, tile_boxes_.data() + state.first_tile,
                         tile_known_.data() + state.first_tile);
        const Box& box = tile_boxes_[state.first_tile + t];
        add_tile(box, inverse_sides, count);
    }
}

// From the mean side of the tiles that will query the window of a body.
double Fast::cell_size(const Step& step, std::uint32_t body) {
    BodyState& state = states_[body];
    if (state.self) sample_tiles(step, body, state.inverse_sides, state.tile_count);
    const double automatic = cells_per_tile * mean_side(state.inverse_sides, state.tile_count);
    const double wanted = step.settings.cell_size;
    return wanted > 0 ? std::min(wanted, largest_factor * automatic) : automatic;
}

// Whether winding numbers tell which vertices may be in the body's own tets; then they are in certificate_.
bool Fast::cull_by_winding(Step& step, std::uint32_t b) {
    const FastMesh& mesh = *step.prepared[b];
    if (!step.settings.winding || !mesh.surface.is_closed) return false;
    BodyState& state = states_[b];
    double inverse_sides = 0, count = 0;
    sample_tiles(step, b, inverse_sides, count);
    const fast::WindingBody body{mesh,
                                 mesh.surface,
                                 state.positions,
                                 body_boxes_[b],
                                 winding_cells_per_tile * mean_side(inverse_sides, count),
                                 tile_boxes_.data() + state.first_tile,
                                 tile_known_.data() + state.first_tile};
    if (!fast::certify(body, certificate_, step.counters.exact_tests)) return false;
    state.tiles_known = true;
    return true;
}

// Marks the blocks with vertices that are not certified.
void Fast::activate_blocks(const Step& step, std::uint32_t b) {
    const FastMesh& mesh = *step.prepared[b];
    const BodyState& state = states_[b];
    const std::uint32_t count = mesh.block_count();
    active_.assign(count, 0);
    const std::pmr::vector<std::uint32_t>& first = mesh.block_first;
    for (const std::uint32_t v : mesh.surface.loose)
        active_[static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), v) - first.begin() -
                                         1)] = 1;
    if (certificate_.complete) return;
    const Box* blocks = block_boxes_.data() + state.first_block;
    for (std::uint32_t i = 0; i < count; ++i) {
        bool near = true;
        for (int a = 0; a < 3; ++a)
            near = near && certificate_.lattice.cell(blocks[i].lo[a], a) <= certificate_.last[a] &&
                   certificate_.lattice.cell(blocks[i].hi[a], a) >= certificate_.first[a];
        for (std::uint32_t v = first[i]; near && v < first[i + 1] && !active_[i]; ++v)
            active_[i] = !certificate_.holds(state.positions + std::size_t{v} * 3);
    }
}

// The window of the vertices of a body that reach another one, or that may be in tets of the same body.
void Fast::make_window(Step& step, std::uint32_t a, std::span<const Reach> reaches) {
    const Body& body = step.bodies[a];
    BodyState& state = states_[a];
    const bool self = body.self_collision && !body.tets.empty();
    if (body.vertex_count == 0 || (reaches.empty() && !self)) return;

    const bool culled = self && cull_by_winding(step, a);
    const Box* blocks = block_boxes_.data() + state.first_block;
    const std::pmr::vector<std::uint32_t>& first = step.prepared[a]->block_first;
    const std::uint32_t count = step.prepared[a]->block_count();
    Box own =
        self && !culled ? body_boxes_[a] : fast::empty_box; // of the vertices that may be in the same body
    if (culled) {
        activate_blocks(step, a);
        for (std::uint32_t b = 0; b < count; ++b)
            if (active_[b]) fast::add(own, blocks[b]);
    }
    state.self = !fast::is_empty(own);
    Box region = own;
    for (const Reach& reach : reaches) fast::add(region, reach.region);
    if (fast::is_empty(region)) return;

    points_.count = 0;
    points_.reserve(body.vertex_count);
    const auto is_wanted = [&](std::uint32_t b) {
        if (culled ? active_[b] != 0 : self) return true;
        for (const Reach& reach : reaches)
            if (fast::overlap(blocks[b], reach.region)) return true;
        return false;
    };
    for (std::uint32_t b = 0; b < count;) { // runs of wanted blocks
        const std::uint32_t begin = b;
        while (b < count && is_wanted(b)) ++b;
        if (b > begin)
            fast::collect(state.positions, first[begin], first[b], region, points_);
        else
            ++b;
    }
    if (points_.count == 0) return;
    cell_size_ = cell_size(step, a);
    const Box box = fast::bounds(points_);
    const fast::Lattice lattice =
        fast::make_lattice(points_, box, cell_size_, cells_per_vertex * std::size_t{points_.count} + 64);
    state.window = fast::bin(points_, lattice, box, bins_);
    state.own = own;
    fast::intersect(state.own, box);
}

// The tiles of a body against the windows of the bodies that reach it.
void Fast::query(Step& step, std::uint32_t b, std::span<const std::uint32_t> reaching) {
    const Body& body = step.bodies[b];
    const BodyState& state = states_[b];
    const bool self = state.self && state.window.count;
    sources_.clear();
    if (self) {
        know_super_tiles(step, b);
        sources_.push_back({state.window, state.own, b});
    }
    for (const std::uint32_t r : reaching) {
        const Reach& reach = reaches_[r];
        const fast::Window& window = states_[reach.a].window;
        fast::Source source{window, reach.region, reach.a};
        fast::intersect(source.region, window.box);
        if (window.count && !fast::is_empty(source.region)) sources_.push_back(source);
    }
    if (sources_.empty()) return;

    const FastMesh& mesh = *step.prepared[b];
    const std::uint32_t super_tiles = mesh.super_tile_count();
    fast::Query query{};
    query.tiles = &mesh;
    query.positions = state.positions;
    query.bins = &bins_;
    query.boxes = tile_boxes_.data() + state.first_tile;
    query.known = tile_known_.data() + state.first_tile;
    fast::QueryScratch& scratch = scratch_[0];
    if (self) {
        if (stamps_.size() < body.vertex_count) stamps_.resize(body.vertex_count, 0);
        // The stamps of a tile must not be mistaken for another's, also not after the tag has run over.
        if ((scratch.tag >> 6) + mesh.tiles.size() >= 1u << 26) {
            std::fill(stamps_.begin(), stamps_.end(), 0u);
            scratch.tag = 0;
        }
    }
    Decide decide(step.bodies, b, step.hits, degenerate_);
    for (std::uint32_t s = 0; s < super_tiles; ++s) {
        near_.clear();
        for (std::size_t i = 0; i < sources_.size(); ++i)
            if (fast::overlap(super_boxes_[state.first_super + s], sources_[i].region))
                near_.push_back(sources_[i]);
        if (near_.empty()) continue;
        query.stamps = near_[0].body == b ? stamps_.data() : nullptr;
        fast::query_tiles(query, near_, mesh.super_first[s], mesh.super_first[s + 1], scratch, decide);
    }
    fast::flush(scratch, decide);
    step.counters.exact_tests += decide.exact_tests;
    step.profile.narrow_ns += decide.time_ns;
}

} // namespace vox
