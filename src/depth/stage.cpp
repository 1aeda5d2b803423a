#include "depth/stage.hpp"

#include "base/parallel.hpp"
#include "base/vectors.hpp"

#include <algorithm>
#include <tuple>

namespace vox {

using namespace depth;

DepthStage::DepthStage(std::pmr::memory_resource* memory, SurfaceTrees& trees)
    : starts_(memory), points_(memory), pairs_(memory), workers_(memory), fallback_(memory, trees) {}

Solid DepthStage::Scene::solid(std::uint32_t body) const {
    return {topologies[body], bodies[body].tets, bodies[body].positions};
}

void DepthStage::find(std::span<const Body> bodies, std::span<const Topology* const> topologies,
                      std::span<const Hit> hits, std::span<const vox_contact> contacts,
                      std::uint64_t closest_budget, Workers* workers, Penetrations& penetrations,
                      vox_counters& counters) {
    const bool none = std::ranges::all_of(bodies, [](const Body& b) { return b.penetration_mask == 0; });
    if (hits.empty() || none) return penetrations.clear();
    const Scene scene{bodies, topologies, hits};
    make_room(hits.size(), bodies.size(), workers ? workers->count() : 1);
    const std::size_t count = list_points(scene, contacts);
    // The number of points that is worth a task.
    constexpr std::size_t least = 512;
    const auto for_each = [&](std::span<const Range> ranges, std::size_t points, auto&& function) {
        const auto run = [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
            for (std::size_t i = begin; i < end; ++i) function(ranges[i], workers_[worker]);
        };
        if (!workers || points <= least)
            run(0, ranges.size(), 0);
        else
            workers->for_ranges(ranges.size(), std::max<std::size_t>(ranges.size() * least / points, 1), run);
    };
    for_each(pairs_, points_.size(),
             [&](const Range& range, Worker& worker) { find_consistent(scene, range, worker); });
    Counts fallback_counts;
    const auto [searches, unknown] =
        fallback_.find(bodies, topologies, hits, closest_budget, workers, points_, fallback_counts);

    workers_.level();

    penetrations.reserve(hits.size());
    penetrations.carry(bodies, hits, count);
    const auto write = [&](std::size_t begin, std::size_t end, std::uint32_t) {
        for (const Point& point : std::span(points_).subspan(begin, end - begin)) {
            const vox_contact& contact = contacts[point.hit];
            penetrations.set(point.place,
                             {contact.mesh_a, contact.vertex, contact.mesh_b, point.state, point.hit, 0, {}},
                             point.depth, point.direction, point.closest);
        }
    };
    constexpr std::size_t least_written = 4096; // that are worth a task
    if (workers && points_.size() > least_written)
        workers->for_ranges(points_.size(), least_written, write);
    else
        write(0, points_.size(), 0);
    counters.closest_searches = searches;
    counters.closest_tests = fallback_counts.closest_tests;
    counters.unknown_penetrations = unknown;
    for (const Worker& worker : workers_) {
        counters.leaving_edges += worker.counts.leaving_edges;
        counters.edge_tests += worker.counts.edge_tests;
    }
}

// There are never more points than contacts, nor more pairs than that or than pairs of bodies.
void DepthStage::make_room(std::size_t contacts, std::size_t bodies, std::size_t worker_count) {
    points_.clear();
    points_.reserve(contacts);
    pairs_.reserve(bodies < contacts ? std::min(contacts, bodies * bodies) : contacts);
    starts_.reserve(contacts);
    workers_.grow(worker_count);
    for (Worker& worker : workers_) worker.counts = {};
}

// Hits are sorted by body_a, vertex and body_b; the points are sorted by body_a, body_b and vertex.
std::size_t DepthStage::list_points(const Scene& scene, std::span<const vox_contact> contacts) {
    points_.clear();
    pairs_.clear();
    const std::span<const Hit> hits = scene.hits;
    std::size_t places = 0;
    const auto before = [hits](const Start& x, const Start& y) {
        return std::tie(hits[x.hit].body_b, x.place) < std::tie(hits[y.hit].body_b, y.place);
    };
    for (std::size_t first = 0, last; first < hits.size(); first = last) {
        starts_.clear();
        for (last = first; last < hits.size() && hits[last].body_a == hits[first].body_a; ++last)
            if (is_first_of_vertex(hits, last)) {
                const Body &a = scene.bodies[hits[last].body_a], &b = scene.bodies[hits[last].body_b];
                const PenetrationSource source = penetration_source(a, b);
                if (source == PenetrationSource::found) starts_.push_back({last, places});
                places += source != PenetrationSource::none;
            }
        if (!std::is_sorted(starts_.begin(), starts_.end(), before))
            std::sort(starts_.begin(), starts_.end(), before);
        for (std::size_t i = 0; i < starts_.size(); ++i) {
            if (i == 0 || hits[starts_[i].hit].body_b != hits[starts_[i - 1].hit].body_b)
                pairs_.push_back({points_.size(), points_.size()});
            const Hit& hit = hits[starts_[i].hit];
            Point& point = points_.emplace_back();
            point.hit = static_cast<std::uint32_t>(starts_[i].hit);
            point.place = static_cast<std::uint32_t>(starts_[i].place);
            point.vertex = hit.vertex;
            point.tet = hit.tet;
            const float* weight = contacts[point.hit].barycentric; // within 2^-20 of the true ones
            point.interior = *std::min_element(weight, weight + 4) > 0x1p-19f;
            pairs_.back().last = points_.size();
        }
    }
    return places;
}

void DepthStage::find_consistent(const Scene& scene, const Range& range, Worker& worker) {
    const Hit& hit = scene.hits[points_[range.first].hit];
    const Body& a = scene.bodies[hit.body_a];
    const BodyPair pair{scene.topologies[hit.body_a], a.positions, a.vertex_count, scene.solid(hit.body_b),
                        hit.body_a == hit.body_b};
    find_consistent_depths(pair, std::span(points_).subspan(range.first, range.last - range.first),
                           worker.consistent, worker.counts);
}

} // namespace vox
