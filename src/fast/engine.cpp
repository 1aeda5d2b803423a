// The stages in order. The workers share each of them: they take pieces of bodies, pairs of bodies or whole
// bodies at a time, each with results of its own.
#include "fast/engine.hpp"

#include "base/clock.hpp"

#include <algorithm>

namespace vox {

FastEngine::FastEngine(std::pmr::memory_resource* memory)
    : step_(memory), boxes_(memory), stream_(memory), broad_phase_(memory), windows_(memory),
      workers_(memory), degenerate_(memory) {}

void FastEngine::detect(std::span<const Body> bodies, std::span<const fast::PreparedBody> prepared,
                        const FastSettings& settings, Array<Hit>& hits, Counters& counters,
                        Profile& profile) {
    const std::uint64_t start = nanoseconds();
    begin(bodies, prepared, settings);
    fast::stream(step_, boxes_, stream_);
    const std::uint64_t streamed = nanoseconds();
    fast::track_orientation(step_, boxes_);
    const std::uint64_t tracked = nanoseconds();
    fast::find_regions(step_, boxes_, broad_phase_);
    const std::uint64_t regions_found = nanoseconds();
    fast::make_windows(step_, broad_phase_, settings.cell_size, settings.keep_certified, boxes_, windows_);
    const std::uint64_t windows_made = nanoseconds();
    look_up(hits);
    count(counters);
    const std::uint64_t end = nanoseconds();

    std::uint64_t winding = 0; // within the tasks of the windows, as decisions are within those of the lookup
    profile.decide_ns = 0;
    for (const fast::Windows::Worker& worker : windows_.workers)
        winding = std::max(winding, worker.winding_ns);
    for (const Worker& worker : workers_) profile.decide_ns = std::max(profile.decide_ns, worker.decided.ns);
    profile.stream_ns = streamed - start;
    profile.winding_ns = tracked - streamed + winding;
    profile.broad_phase_ns = regions_found - tracked;
    profile.windows_ns = windows_made - regions_found - winding;
    profile.lookup_ns = end - windows_made - profile.decide_ns;
    profile.bin_ns = profile.stream_ns + profile.winding_ns + profile.windows_ns;
    profile.broad_ns = profile.broad_phase_ns + profile.lookup_ns;
    profile.narrow_ns = profile.decide_ns;
}

void FastEngine::begin(std::span<const Body> bodies, std::span<const fast::PreparedBody> prepared,
                       const FastSettings& settings) {
    fast::begin_step(bodies, settings.workers, step_);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        fast::StepBody& body = step_.of[b];
        body.tiles = prepared[b].tiles;
        body.last = &prepared[b].state->last_positions;
        if (settings.winding && bodies[b].self_collision && prepared[b].boundary->is_closed) {
            body.boundary = prepared[b].boundary;
            body.orientation = &prepared[b].state->orientation;
        }
        body.moved = !settings.carry;
    }
    fast::lay_out(step_, boxes_);
    workers_.grow(step_.worker_count());
    for (Worker& worker : workers_) {
        worker.decided = {};
        if (worker.scratch.empty()) continue;
        worker.scratch[0].finding_count = 0;
        worker.scratch[0].counters = {};
    }
    degenerate_.clear();
}

// The lookup of each piece, and the decisions on what it finds.
void FastEngine::look_up(Array<Hit>& hits) {
    constexpr std::size_t task_tiles =
        32; // are worth a task: by bench_stages, ten microseconds where they find points
    fast::Decided decided{hits, degenerate_};
    step_.for_each(
        step_.super_pieces.size(), step_.tile_count, task_tiles, [&](std::size_t p, std::uint32_t worker) {
            const fast::Piece& piece = step_.super_pieces[p];
            fast::ExactDecisions decide(step_.bodies, piece.body, workers_[worker].decided, decided);
            fast::look_up(step_, broad_phase_, windows_, piece, boxes_, workers_[worker], decide);
        });
    workers_.level();
}

// Sums, and largest ones: which worker did what does not matter.
void FastEngine::count(Counters& counters) {
    counters.cells = counters.entries = counters.fullest_cell = 0;
    counters.visited_cells = counters.visited_entries = counters.candidates = 0;
    counters.exact_tests = counters.filtered = counters.moved_bodies = 0;
    for (const fast::StepBody& body : step_.of) counters.moved_bodies += body.moved;
    for (const fast::BodyWindow& window : windows_.of)
        if (window.bins) cell_size_ = window.cell_size;
    for (const fast::Bins& bins : windows_.bins) {
        counters.cells += bins.occupied_cells;
        counters.entries += bins.points.count;
        counters.fullest_cell = std::max(counters.fullest_cell, bins.fullest_cell);
    }
    for (const fast::Windows::Worker& worker : windows_.workers) counters.exact_tests += worker.exact_tests;
    for (const Worker& worker : workers_) {
        counters.exact_tests += worker.decided.exact_tests;
        counters.filtered += worker.decided.filtered;
        if (worker.scratch.empty()) continue;
        const fast::LookupCounters& counted = worker.scratch[0].counters;
        counters.visited_cells += counted.visited_cells;
        counters.visited_entries += counted.visited_points;
        counters.candidates += counted.candidates;
    }
    std::sort(degenerate_.begin(), degenerate_.end());
    counters.skipped_degenerate =
        static_cast<std::uint64_t>(std::unique(degenerate_.begin(), degenerate_.end()) - degenerate_.begin());
}

void FastEngine::fill(StepScene& scene) const noexcept {
    scene.of = step_.of;
    scene.boxes = &boxes_;
    scene.pairs = broad_phase_.pairs;
    scene.certified_cells = windows_.certified;
    scene.origin = step_.origin;
}

bool FastEngine::cleared(std::size_t body, std::uint32_t vertices) const noexcept {
    if (body >= windows_.of.size()) return false; // also where the last step failed before its windows
    const fast::BodyWindow& window = windows_.of[body];
    return is_empty(window.own) || window.count <= vertices / 2;
}

} // namespace vox
