// Which vertices of a body are binned, and in cells of what size.
#include "base/error.hpp"
#include "fast/sides.hpp"
#include "fast/step.hpp"

#include <algorithm>
#include <bit>

namespace vox {


namespace {

// Edge length of a cell in mean box sides of a tile: the optimum is flat from 0.4 to 0.9.
constexpr double cells_per_tile = 0.6;
// A cell size asked for is kept up to this many times the automatic one: beyond it, every tile would meet
// every vertex.
constexpr double largest_factor = 16;
// The same as cells_per_tile for the winding numbers of self-collision.
constexpr double winding_cells_per_tile = 0.55;
// A body with self-collision of so many tets is worth sharing among the workers; so many such bodies are at
// most, to stay below VOX_MAX_TASKS.
constexpr std::size_t many_tets = 1u << 17;
constexpr std::size_t most_shared = 16;

bool is_large(const Body& body) { return body.self_collision && body.tets.size() >= many_tets; }

} // namespace

// A group of bodies is the work of one worker. Where there are fewer large bodies than workers, these share
// the first part of each.
void FastEngine::make_windows(Step& step) {
    std::size_t vertices = 0, large = 0;
    for (std::size_t a = 0; a < step.bodies.size(); ++a) {
        vertices += step.bodies[a].vertex_count;
        large += states_[a].moved && is_large(step.bodies[a]);
    }
    const bool share = large < step.worker_count() && large <= most_shared;
    for (std::uint32_t g = 0; large && share && g < groups_.size(); ++g)
        for (std::uint32_t a = groups_[g].first; a < groups_[g].last; ++a)
            if (is_large(step.bodies[a])) make_window(step, a, bins_[g], workers_[0], step.settings.workers);
    step.for_ranges(groups_.size(), vertices, 2 * group_vertices,
                    [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
                        for (std::size_t g = begin; g < end; ++g)
                            for (std::uint32_t a = groups_[g].first; a < groups_[g].last; ++a)
                                if (!share || !is_large(step.bodies[a]))
                                    make_window(step, a, bins_[g], workers_[worker], nullptr);
                    });
    for (const BodyState& state : states_)
        if (state.bins) cell_size_ = state.cell_size;
}

// The sides of some tiles of a body.
void FastEngine::sample_tiles(const Step& step, std::uint32_t body, TileSize& sides) {
    const Tiles& mesh = *step.prepared[body].tiles;
    const BodyState& state = states_[body];
    const auto tiles = static_cast<std::uint32_t>(mesh.tiles.size()), samples = std::min(64u, tiles);
    for (std::uint32_t i = 0; i < samples; ++i) {
        const auto t = static_cast<std::uint32_t>(std::uint64_t{i} * tiles / samples);
        fast::tile_boxes(mesh, state.positions, t, t + 1, tile_boxes_.data() + state.first_tile,
                         tile_known_.data() + state.first_tile);
        sides.add(tile_boxes_[state.first_tile + t]);
    }
}

// Whether winding numbers tell which vertices may be in the body's own tets; then they are in
// `certificate`.
bool FastEngine::cull_by_winding(const Step& step, std::uint32_t b, fast::Certificate& certificate,
                           std::uint64_t& exact_tests, Workers* helpers) {
    if (!may_certify(step, b)) return false;
    const fast::PreparedBody& mesh = step.prepared[b];
    const BodyState& state = states_[b];
    TileSize sides;
    sample_tiles(step, b, sides);
    const fast::WindingBody body{*mesh.tiles,
                                 *mesh.boundary,
                                 state.positions,
                                 step.bodies[b].vertex_count,
                                 body_boxes_[b],
                                 winding_cells_per_tile * sides.mean(),
                                 super_boxes_.data() + state.first_super,
                                 super_upright_.data() + state.first_super,
                                 tile_boxes_.data() + state.first_tile,
                                 tile_known_.data() + state.first_tile,
                                 mesh.state->orientation,
                                 helpers,
                                 state.rounded,
                                 step.origin,
                                 step.bodies[b].positions};
    return fast::certify(body, certificate, exact_tests);
}

// Marks the blocks with vertices that are not certified.
void FastEngine::activate_blocks(const Step& step, std::uint32_t b, WindowBuffers& buffers) const {
    const Tiles& mesh = *step.prepared[b].tiles;
    const BodyState& state = states_[b];
    const fast::Certificate& certificate = buffers.certificate;
    std::pmr::vector<std::uint8_t>& active = buffers.active;
    const std::uint32_t count = mesh.block_count();
    active.assign(count, 0);
    const std::pmr::vector<std::uint32_t>& first = mesh.block_first;
    for (const std::uint32_t v : step.prepared[b].boundary->loose)
        active[static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), v) - first.begin() -
                                        1)] = 1;
    if (certificate.complete) return;
    const Box* blocks = block_boxes_.data() + state.first_block;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (certificate.holds(blocks[i])) continue;
        for (std::uint32_t v = first[i]; v < first[i + 1] && !active[i]; ++v)
            active[i] = !certificate.holds(state.positions + std::size_t{v} * 3);
    }
}

// The window of the vertices of a body that reach another one, or that may be in tets of the same body.
void FastEngine::make_window(const Step& step, std::uint32_t a, fast::Bins& bins, Worker& worker,
                       Workers* helpers) {
    const Body& body = step.bodies[a];
    BodyState& state = states_[a];
    const bool self = body.self_collision && state.moved && !body.tets.empty();
    const std::span<const Reach> reaches =
        std::span(reaches_).subspan(first_of_a_[a], first_of_a_[a + 1] - first_of_a_[a]);
    if (body.vertex_count == 0 || (reaches.empty() && !self)) return;

    WindowBuffers& buffers = state.buffers == none ? worker.windows : large_buffers_[state.buffers];
    const bool culled = self && cull_by_winding(step, a, buffers.certificate, worker.exact_tests, helpers);
    const Box* blocks = block_boxes_.data() + state.first_block;
    const std::pmr::vector<std::uint32_t>& first = step.prepared[a].tiles->block_first;
    const std::uint32_t count = step.prepared[a].tiles->block_count();
    Box own =
        self && !culled ? body_boxes_[a] : empty_box; // of the vertices that may be in the same body
    if (culled) {
        activate_blocks(step, a, buffers);
        for (std::uint32_t b = 0; b < count; ++b)
            if (buffers.active[b]) add(own, blocks[b]);
    }
    state.self = !is_empty(own);
    Box region = own;
    for (const Reach& reach : reaches) add(region, reach.region);
    if (is_empty(region)) return;

    fast::Points& points = buffers.points;
    points.count = 0;
    for (std::uint32_t b = 0; b < count; b += fast::most_boxes) {
        const std::uint32_t some = std::min(fast::most_boxes, count - b);
        std::uint64_t wanted = 0;
        for (std::uint32_t i = 0; i < some && self; ++i)
            wanted |= std::uint64_t{!culled || buffers.active[b + i]} << i;
        for (const Reach& reach : reaches) wanted |= fast::find_overlaps(blocks + b, some, reach.region);
        while (wanted) { // runs of blocks
            const auto begin = static_cast<std::uint32_t>(std::countr_zero(wanted));
            const auto end = begin + static_cast<std::uint32_t>(std::countr_one(wanted >> begin));
            wanted = end < 64 ? wanted >> end << end : 0;
            points.reserve(std::size_t{points.count} + (first[b + end] - first[b + begin]));
            fast::collect(state.positions, first[b + begin], first[b + end], body.vertex_count, region,
                          points);
        }
    }
    if (points.count == 0) return;

    // From the mean side of the tiles that will query the window.
    TileSize sides;
    for (const Reach& reach : reaches) sides.add(reach.sides);
    if (state.self) sample_tiles(step, a, sides);
    const double automatic = cells_per_tile * sides.mean(), wanted = step.settings.cell_size;
    state.cell_size = wanted > 0 ? std::min(wanted, largest_factor * automatic) : automatic;

    const std::uint32_t before = bins.points.count;
    state.root = fast::bin_tree(points, state.cell_size, buffers.cell_of, bins);
    state.bins = &bins;
    state.binned = bins.points.count - before;
    state.own = own;
    intersect(state.own, bins.windows[state.root].box);
}

} // namespace vox
