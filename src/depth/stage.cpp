#include "depth/stage.hpp"

#include "base/parallel.hpp"
#include "base/vectors.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace vox {

using namespace depth;

DepthStage::DepthStage(std::pmr::memory_resource* memory)
    : starts_(memory), points_(memory), pairs_(memory), unresolved_(memory), unresolved_by_body_(memory),
      workers_(memory) {}

Solid DepthStage::Scene::solid(std::uint32_t body) const {
    return {topologies[body], bodies[body].tets, bodies[body].positions};
}

void DepthStage::find(std::span<const Body> bodies, std::span<const Topology* const> topologies,
                      std::span<const Hit> hits, std::span<const vox_contact> contacts, Workers* workers,
                      std::pmr::vector<vox_penetration>& penetrations, vox_counters& counters) {
    penetrations.clear();
    if (hits.empty()) return;
    const Scene scene{bodies, topologies, hits};
    make_room(hits.size(), workers ? workers->count() : 1);
    list_points(scene, contacts);
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
    list_unresolved(scene);
    for_each(unresolved_by_body_, unresolved_.size(),
             [&](const Range& range, Worker& worker) { find_closest(scene, range, worker); });

    workers_.level();

    penetrations.reserve(hits.size());
    penetrations.resize(points_.size());
    for (const Point& point : points_) {
        const vox_contact& contact = contacts[point.hit];
        const double depth = std::min<double>(point.depth, std::numeric_limits<float>::max());
        penetrations[point.place] = {contact.mesh_a,
                                     contact.vertex,
                                     contact.mesh_b,
                                     point.state,
                                     point.hit,
                                     static_cast<float>(depth),
                                     {static_cast<float>(point.direction.x),
                                      static_cast<float>(point.direction.y),
                                      static_cast<float>(point.direction.z)}};
    }
    counters.closest_searches = unresolved_.size();
    for (const Worker& worker : workers_) {
        counters.leaving_edges += worker.counts.leaving_edges;
        counters.edge_tests += worker.counts.edge_tests;
        counters.closest_tests += worker.counts.closest_tests;
    }
}

// There are never more points, pairs or unresolved points than contacts.
void DepthStage::make_room(std::size_t contacts, std::size_t worker_count) {
    points_.clear();
    points_.reserve(contacts);
    pairs_.reserve(contacts);
    starts_.reserve(contacts);
    unresolved_.reserve(contacts);
    unresolved_by_body_.reserve(contacts);
    workers_.grow(worker_count);
    for (Worker& worker : workers_) worker.counts = {};
}

// Hits are sorted by body_a, vertex and body_b; the points are sorted by body_a, body_b and vertex.
void DepthStage::list_points(const Scene& scene, std::span<const vox_contact> contacts) {
    points_.clear();
    pairs_.clear();
    const std::span<const Hit> hits = scene.hits;
    const auto before = [](const Start& x, const Start& y) {
        return std::tie(x.body_b, x.place) < std::tie(y.body_b, y.place);
    };
    for (std::size_t first = 0, last; first < hits.size(); first = last) {
        starts_.clear();
        for (last = first; last < hits.size() && hits[last].body_a == hits[first].body_a; ++last)
            if (last == first || hits[last].vertex != hits[last - 1].vertex ||
                hits[last].body_b != hits[last - 1].body_b)
                starts_.push_back({hits[last].body_b, last, points_.size() + starts_.size()});
        if (!std::is_sorted(starts_.begin(), starts_.end(), before))
            std::sort(starts_.begin(), starts_.end(), before);
        for (std::size_t i = 0; i < starts_.size(); ++i) {
            if (i == 0 || starts_[i].body_b != starts_[i - 1].body_b)
                pairs_.push_back({points_.size(), points_.size()});
            const Hit& hit = hits[starts_[i].hit];
            Point& point = points_.emplace_back();
            point.hit = starts_[i].hit;
            point.place = starts_[i].place;
            point.vertex = hit.vertex;
            point.tet = hit.tet;
            const float* weight = contacts[point.hit].barycentric; // within 2^-20 of the true ones
            point.interior = *std::min_element(weight, weight + 4) > 0x1p-19f;
            pairs_.back().last = points_.size();
        }
    }
}

void DepthStage::find_consistent(const Scene& scene, const Range& range, Worker& worker) {
    const Hit& hit = scene.hits[points_[range.first].hit];
    const Body& a = scene.bodies[hit.body_a];
    const BodyPair pair{scene.topologies[hit.body_a], a.positions, a.vertex_count, scene.solid(hit.body_b),
                        hit.body_a == hit.body_b};
    find_consistent_depths(pair, std::span(points_).subspan(range.first, range.last - range.first),
                           worker.consistent, worker.counts);
}

void DepthStage::list_unresolved(const Scene& scene) {
    unresolved_.clear();
    unresolved_by_body_.clear();
    for (std::size_t i = 0; i < points_.size(); ++i)
        if (points_[i].state == VOX_PENETRATION_ENCLOSED || points_[i].state == VOX_PENETRATION_CROSSING)
            unresolved_.push_back({scene.hits[points_[i].hit].body_b, i});
    const auto before = [](const Unresolved& x, const Unresolved& y) {
        return std::tie(x.body_b, x.point) < std::tie(y.body_b, y.point);
    };
    if (!std::is_sorted(unresolved_.begin(), unresolved_.end(), before))
        std::sort(unresolved_.begin(), unresolved_.end(), before);
    for (std::size_t i = 0; i < unresolved_.size(); ++i) {
        if (i == 0 || unresolved_[i].body_b != unresolved_[i - 1].body_b)
            unresolved_by_body_.push_back({i, i});
        unresolved_by_body_.back().last = i + 1;
    }
}

void DepthStage::find_closest(const Scene& scene, const Range& range, Worker& worker) {
    const std::uint32_t b = unresolved_[range.first].body_b;
    const Solid solid = scene.solid(b);
    const bool has_surface = !solid.topology->triangles.empty();
    if (has_surface) worker.tree.build(solid);
    for (std::size_t i = range.first; i < range.last; ++i) {
        Point& point = points_[unresolved_[i].point];
        const std::uint32_t a = scene.hits[point.hit].body_a;
        const Vec3d p = scene.bodies[a].positions.exact(point.vertex);
        Closest closest;
        const bool found = has_surface && worker.tree.find_of_contact(p, point.vertex, point.tet, a == b,
                                                                      closest, worker.counts.closest_tests);
        point.depth = found ? length(closest.way) : 0;
        point.direction = found ? normalised(closest.way) : Vec3d{0, 0, 0};
        if (length(point.direction) > 0) continue;
        point.depth = 0;
        if (found) { // on the surface of a part of b that overlaps the part with the hit
            point.state = VOX_PENETRATION_COINCIDENT;
            Normals& normals = worker.consistent.normals;
            normals.begin(solid);
            const Vec3d apex = solid.at(solid.topology->triangles[closest.at.triangle].apex);
            point.direction = normals.at(closest.at, p - apex);
        }
        if (!(length(point.direction) > 0)) point.direction = facet_normal(solid, point.tet, 0);
    }
}

} // namespace vox
