#include "depth/stage.hpp"

#include "base/parallel.hpp"
#include "base/room.hpp"

#include <algorithm>
#include <numeric>

namespace vox {

using namespace depth;

DepthStage::DepthStage(std::pmr::memory_resource* memory, SurfaceTrees& trees)
    : places_(memory), pairs_(memory), first_of_b_(memory), queue_(memory), workers_(memory),
      fallback_(memory, trees) {}

void DepthStage::find(std::span<const Body> bodies, std::span<const Topology* const> topologies,
                      std::span<const Hit> hits, bool closest, std::uint64_t closest_budget, Workers* workers,
                      Penetrations& penetrations, Counters& counters) {
    const bool none = std::ranges::all_of(bodies, [](const Body& b) { return b.sensor; });
    if (hits.empty() || none) return penetrations.clear();
    Scene scene{bodies, topologies, hits, penetrations};
    reserve(bodies.size(), hits.size());
    penetrations.begin(bodies, hits);
    list_places(scene);
    scene.places = places_;
    workers_.grow(workers ? workers->count() : 1);
    for (Worker& worker : workers_) worker.counts = {};
    // The number of points that is worth a task.
    constexpr std::size_t least = 512;
    const auto find_pairs = [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
        std::uint32_t last_b = ~0u;
        for (std::size_t i = begin; i < end; ++i) {
            // What is known of a small body serves all that are inside it. Of a large one, how much room that
            // took would depend on how the workers share the pairs.
            const std::uint32_t b = scene.hit(places_[pairs_[i]]).body_b;
            Normals& normals = workers_[worker].consistent.normals;
            if (b != last_b || !normals.has_few()) normals.begin(scene.solid(b));
            last_b = b;
            find_consistent(scene, i, workers_[worker]);
        }
    };
    if (!closest && !places_.empty())
        for_ranges(workers, pairs_.size(), std::max<std::size_t>(pairs_.size() * least / places_.size(), 1),
                   find_pairs);
    // With `closest` all are as begin() left them, and the fallback finds them.
    Counts fallback_counts;
    const auto [searches, unknown] = fallback_.find(scene, closest_budget, workers, fallback_counts);

    workers_.level();

    counters.closest_searches = searches;
    counters.closest_tests = fallback_counts.closest_tests;
    counters.unknown_penetrations = unknown;
    for (const Worker& worker : workers_) {
        counters.leaving_edges += worker.counts.leaving_edges;
        counters.edge_tests += worker.counts.edge_tests;
    }
}

// There are never more points than contacts, nor more pairs.
void DepthStage::reserve(std::size_t bodies, std::uint64_t contacts) {
    reserve_growing(first_of_b_, bodies + 1);
    for (Array<std::uint32_t>* list : {&places_, &pairs_, &queue_}) reserve_exactly(*list, contacts);
}

// Penetrations are sorted by body_a, vertex and body_b; here they are sorted by body_b, body_a and vertex, by
// counting.
void DepthStage::list_places(const Scene& scene) {
    queue_.clear(); // as they are sorted first
    first_of_b_.assign(scene.bodies.size() + 1, 0);
    const std::span<const Hit> hits = scene.hits;
    std::uint32_t place = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (!is_first_of_vertex(hits, i)) continue;
        const std::uint32_t b = hits[i].body_b;
        const PenetrationSource source = penetration_source(scene.bodies[hits[i].body_a], scene.bodies[b]);
        if (source == PenetrationSource::found) {
            queue_.push_back(place);
            ++first_of_b_[b + 1];
        }
        place += source != PenetrationSource::none;
    }
    std::partial_sum(first_of_b_.begin(), first_of_b_.end(), first_of_b_.begin());
    places_.resize(queue_.size());
    for (const std::uint32_t p : queue_) places_[first_of_b_[scene.hit(p).body_b]++] = p;
    pairs_.clear();
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const Hit& hit = scene.hit(places_[i]);
        if (i > 0) {
            const Hit& last = scene.hit(places_[i - 1]);
            if (hit.body_a == last.body_a && hit.body_b == last.body_b) continue;
        }
        pairs_.push_back(static_cast<std::uint32_t>(i));
    }
}

void DepthStage::find_consistent(const Scene& scene, std::size_t i, Worker& worker) {
    const std::size_t first = pairs_[i], last = i + 1 < pairs_.size() ? pairs_[i + 1] : places_.size();
    const Hit& hit = scene.hit(places_[first]);
    const Body& a = scene.bodies[hit.body_a];
    const BodyPair pair{scene.topologies[hit.body_a],
                        a.positions,
                        a.vertex_count,
                        scene.solid(hit.body_b),
                        hit.body_a == hit.body_b,
                        std::span(places_).subspan(first, last - first)};
    find_consistent_depths(pair, scene.hits, scene.penetrations,
                           std::span(queue_).subspan(first, last - first), worker.consistent, worker.counts);
}

} // namespace vox
