#include "fast/windows.hpp"

#include "base/clock.hpp"

#include <algorithm>
#include <bit>

namespace vox::fast {

namespace {

// Edge length of a cell, in harmonic mean box sides of the tiles that look into it. The optimum is flat from
// 0.4 to 0.9.
constexpr double cell_in_tile_sides = 0.6;
// A cell size asked for is used up to this many times the automatic one: beyond it, every tile would meet
// every vertex.
constexpr double largest_factor = 16;
// cell_in_tile_sides for the winding numbers of self-collision.
constexpr double winding_cell_in_tile_sides = 0.55;
// The winding numbers of a body with so many tets are worth sharing among the workers: by bench_stages, they
// take 0.2 ms of one. Each such body is a task of the step, so their number is limited to stay below
// VOX_MAX_TASKS.
constexpr std::size_t many_tets = 1u << 17;
constexpr std::size_t most_shared = 16;

// Bodies are grouped up to so many vertices, and two groups are worth a task: by bench_stages, their windows
// take ten microseconds. That is long beside handing out a task, and short enough to share a scene evenly.
constexpr std::size_t group_vertices = 2048;

bool is_large(const Body& body) { return body.self_collision && body.tets.size() >= many_tets; }

// Groups the bodies, and gives each a place for its result and the buffers it needs.
void prepare(const Step& step, bool keep_certified, Windows& out) {
    out.workers.grow(step.worker_count());
    for (Windows::Worker& worker : out.workers) worker.exact_tests = worker.winding_ns = 0;
    out.of.assign(step.bodies.size(), {nullptr, 0, 0, empty_box, 0});
    if (!keep_certified) out.certified.clear();
    for (CertifiedCells& cells : out.certified) cells.certified.clear();
    while (keep_certified && out.certified.size() < step.bodies.size())
        out.certified.emplace_back(out.certified.memory());
    out.groups.clear();
    std::size_t vertices = group_vertices, all_vertices = 0;
    for (std::uint32_t b = 0; b < step.bodies.size(); ++b) {
        if (vertices >= group_vertices) {
            out.groups.push_back({b, b});
            vertices = 0;
        }
        out.groups.back().last = b + 1;
        vertices += step.bodies[b].vertex_count;
        all_vertices += step.bodies[b].vertex_count;
    }
    while (out.bins.size() < out.groups.size()) out.bins.emplace_back(out.bins.memory());
    for (Bins& bins : out.bins) bins.clear();
    for (std::size_t g = 0; g < out.groups.size(); ++g) {
        out.bins[g].most_points = 0;
        for (std::uint32_t b = out.groups[g].first; b < out.groups[g].last; ++b)
            out.bins[g].most_points += step.bodies[b].vertex_count;
    }

    // Any worker may be given any body. A body that is more than a worker's share of all gets buffers of its
    // own, so that all buffers together are no more than twice what one worker for each body would need.
    out.large_of.assign(step.bodies.size(), Windows::none);
    if (step.worker_count() == 1) return;
    std::uint32_t large = 0;
    for (std::size_t b = 0; b < step.bodies.size(); ++b)
        if (std::size_t{step.bodies[b].vertex_count} * step.worker_count() > all_vertices)
            out.large_of[b] = large++;
    while (out.large.size() < large) out.large.emplace_back(out.large.memory());
}

// Adds the sizes of some tiles of a body.
void sample_tiles(const StepBody& body, StepBoxes& boxes, TileSize& size) {
    const auto tiles = static_cast<std::uint32_t>(body.tiles->tiles.size()), samples = std::min(64u, tiles);
    for (std::uint32_t i = 0; i < samples; ++i) {
        const auto t = static_cast<std::uint32_t>(std::uint64_t{i} * tiles / samples);
        make_tile_boxes(body, t, t + 1, boxes);
        size.add(boxes.tiles[body.first_tile + t]);
    }
}

// True if winding numbers show which vertices may be in the body's own tets; then that is in `certificate`.
bool cull_by_winding(const Step& step, std::uint32_t b, Workers* helpers, StepBoxes& boxes,
                     Certificate& certificate, Windows::Worker& worker) {
    const StepBody& body = step.of[b];
    if (!body.boundary) return false;
    const std::uint64_t start = nanoseconds();
    TileSize size;
    sample_tiles(body, boxes, size);
    const Box& box = boxes.bodies[b];
    const WindingBody winding{
        {*body.tiles, *body.boundary, body.positions, step.bodies[b].vertex_count, body.rounded,
         body.rounded ? slack_of_rounding(box) : 0, boxes.super_change.data() + body.first_super,
         boxes.super_positive.data() + body.first_super, boxes.tiles.data() + body.first_tile,
         boxes.tile_known.data() + body.first_tile},
        box,
        winding_cell_in_tile_sides * size.mean(),
        boxes.super_tiles.data() + body.first_super,
        *body.orientation,
        helpers,
        step.origin,
        step.bodies[b].positions};
    const bool culled = certify(winding, certificate, worker.exact_tests);
    worker.winding_ns += nanoseconds() - start;
    return culled;
}

// Marks the blocks with vertices that are not certified.
void activate_blocks(const StepBody& body, const StepBoxes& boxes, WindowBuffers& buffers) {
    const Certificate& certificate = buffers.certificate;
    Array<std::uint8_t>& active = buffers.active;
    const std::uint32_t count = body.tiles->block_count();
    active.assign(count, 0);
    const Array<std::uint32_t>& first = body.tiles->block_first;
    for (const std::uint32_t v : body.boundary->loose)
        active[static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), v) - first.begin() -
                                        1)] = 1;
    if (certificate.complete) return;
    const Box* blocks = boxes.blocks.data() + body.first_block;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (certificate.holds(blocks[i])) continue;
        for (std::uint32_t v = first[i]; v < first[i + 1] && !active[i]; ++v)
            active[i] = !certificate.holds(body.positions + std::size_t{v} * 3);
    }
}

// The window of the vertices of a body that reach another one, or that may be in tets of the same body.
void make_window(const Step& step, const BroadPhase& broad, double cell_size, std::uint32_t a, Bins& bins,
                 Windows::Worker& worker, Workers* helpers, StepBoxes& boxes, Windows& out) {
    const Body& body = step.bodies[a];
    const StepBody& step_body = step.of[a];
    const bool self = body.self_collision && step_body.moved && !body.tets.empty();
    const std::span<const PairRegion> pairs = broad.of_a(a);
    if (body.vertex_count == 0 || (pairs.empty() && !self)) return;

    WindowBuffers& buffers = out.large_of[a] == Windows::none ? worker : out.large[out.large_of[a]];
    const bool culled = self && cull_by_winding(step, a, helpers, boxes, buffers.certificate, worker);
    Box own = self && !culled ? boxes.bodies[a] : empty_box;
    if (culled) {
        if (!out.certified.empty())
            out.certified[a] = buffers.certificate; // the next body is certified there
        activate_blocks(step_body, boxes, buffers);
        for (std::uint32_t b = 0; b < step_body.tiles->block_count(); ++b)
            if (buffers.active[b]) add(own, boxes.blocks[step_body.first_block + b]);
    }
    Box around = own;
    for (const PairRegion& pair : pairs) add(around, pair.region);
    if (is_empty(around)) return;

    Points& points = buffers.points;
    points.count = 0;
    collect_near(step, boxes, broad, a, around, self && !culled, culled ? buffers.active.data() : nullptr,
                 points);
    if (points.count == 0) return;

    // The size follows from the mean side of the tiles that will look into the window.
    TileSize size;
    for (const PairRegion& pair : pairs) size.add(pair.tile_size);
    if (!is_empty(own)) sample_tiles(step_body, boxes, size);
    const double automatic = cell_in_tile_sides * size.mean();
    const std::uint32_t before = bins.points.count;
    BodyWindow& window = out.of[a];
    window.cell_size = cell_size > 0 ? std::min(cell_size, largest_factor * automatic) : automatic;
    window.root = bin_tree(points, window.cell_size, bins);
    window.bins = &bins;
    window.count = bins.points.count - before;
    window.own = own;
    intersect(window.own, bins.windows[window.root].box);
}

} // namespace

void collect_near(const Step& step, const StepBoxes& boxes, const BroadPhase& broad, std::uint32_t body,
                  const Box& around, bool all_blocks, const std::uint8_t* active, Points& points) {
    const StepBody& step_body = step.of[body];
    const Box* blocks = boxes.blocks.data() + step_body.first_block;
    const Box* groups = boxes.groups.data() + step_body.first_group;
    const Array<std::uint32_t>& first = step_body.tiles->block_first;
    const std::uint32_t count = step_body.tiles->block_count();
    const std::size_t most_points = std::size_t{points.count} + step.bodies[body].vertex_count;
    for (std::uint32_t b = 0; b < count; b += most_boxes) {
        const std::uint32_t some = std::min(most_boxes, count - b);
        std::uint64_t wanted = all_blocks ? ~std::uint64_t{0} >> (64 - some) : 0;
        for (std::uint32_t i = 0; i < some && active; ++i) wanted |= std::uint64_t{active[b + i]} << i;
        for (const PairRegion& pair : broad.of_a(body))
            wanted |= find_blocks(blocks + b, groups + b / group_blocks, some, pair.region);
        while (wanted) { // runs of blocks
            const auto begin = static_cast<std::uint32_t>(std::countr_zero(wanted));
            const auto end = begin + static_cast<std::uint32_t>(std::countr_one(wanted >> begin));
            wanted = end < 64 ? wanted >> end << end : 0;
            points.reserve(std::size_t{points.count} + (first[b + end] - first[b + begin]), most_points);
            collect(step_body.positions, first[b + begin], first[b + end], step.bodies[body].vertex_count,
                    around, points);
        }
    }
}

// A group of bodies is the work of one worker. Where there are fewer large bodies than workers, all workers
// share the winding numbers of each, before the groups.
void make_windows(const Step& step, const BroadPhase& broad, double cell_size, bool keep_certified,
                  StepBoxes& boxes, Windows& out) {
    prepare(step, keep_certified, out);
    std::size_t vertices = 0, large = 0;
    for (std::size_t a = 0; a < step.bodies.size(); ++a) {
        vertices += step.bodies[a].vertex_count;
        large += step.of[a].moved && is_large(step.bodies[a]);
    }
    const bool share = large < step.worker_count() && large <= most_shared;
    for (std::uint32_t g = 0; large && share && g < out.groups.size(); ++g)
        for (std::uint32_t a = out.groups[g].first; a < out.groups[g].last; ++a)
            if (is_large(step.bodies[a]))
                make_window(step, broad, cell_size, a, out.bins[g], out.workers[0], step.workers, boxes, out);
    step.for_each(out.groups.size(), vertices, 2 * group_vertices, [&](std::size_t g, std::uint32_t worker) {
        for (std::uint32_t a = out.groups[g].first; a < out.groups[g].last; ++a)
            if (!share || !is_large(step.bodies[a]))
                make_window(step, broad, cell_size, a, out.bins[g], out.workers[worker], nullptr, boxes, out);
    });
    out.workers.level();
}

} // namespace vox::fast
