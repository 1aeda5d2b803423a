// The depth stage, which makes one penetration of the contacts of each vertex of a body in another.
// docs/depth.md describes the method; each part is a file in depth/.
#pragma once

#include "base/per_worker.hpp"
#include "base/scene.hpp"
#include "depth/closest.hpp"
#include "depth/consistent.hpp"
#include "depth/points.hpp"
#include "mesh/topology.hpp"

#include <vox/vox.h>

#include <cstdint>
#include <memory_resource>
#include <span>
#include <tuple>
#include <vector>

namespace vox {

class Workers;

// Keeps the stage's buffers from step to step, so that the steady state allocates nothing, with any number of
// workers.
class DepthStage {
public:
    explicit DepthStage(std::pmr::memory_resource* memory);
    DepthStage(const DepthStage&) = delete;
    DepthStage& operator=(const DepthStage&) = delete;

    // Replaces `penetrations` by those of `contacts`. `hits` are what the contacts were made of, in the same
    // order (make_contacts), and `topologies` has one for each body. Sets the counters from `leaving_edges`
    // to `closest_tests`. `workers` may be null; the result does not depend on them.
    void find(std::span<const Body> bodies, std::span<const Topology* const> topologies,
              std::span<const Hit> hits, std::span<const vox_contact> contacts, Workers* workers,
              std::pmr::vector<vox_penetration>& penetrations, vox_counters& counters);

private:
    struct Range {
        std::size_t first, last;
    };
    struct Start { // the first hit of a vertex in body_b
        std::uint32_t body_b;
        std::size_t hit;
        std::size_t place; // index of its penetration
    };
    struct Unresolved { // a point that needs the closest point of the surface
        std::uint32_t body_b;
        std::size_t point;
    };
    struct Worker {
        explicit Worker(std::pmr::memory_resource* memory) : consistent(memory), tree(memory) {}

        depth::ConsistentScratch consistent;
        depth::SurfaceTree tree;
        depth::Counts counts;

        auto buffers() { return std::tuple_cat(consistent.buffers(), std::tie(tree)); }
    };
    struct Scene {
        std::span<const Body> bodies;
        std::span<const Topology* const> topologies;
        std::span<const Hit> hits;

        depth::Solid solid(std::uint32_t body) const;
    };

    void make_room(std::size_t contacts, std::size_t worker_count);
    void list_points(const Scene& scene, std::span<const vox_contact> contacts);
    void list_unresolved(const Scene& scene);
    void find_consistent(const Scene& scene, const Range& range, Worker& worker);
    void find_closest(const Scene& scene, const Range& range, Worker& worker);

    std::pmr::vector<Start> starts_;
    std::pmr::vector<depth::Point> points_;      // pair after pair, each in the order of vertices
    std::pmr::vector<Range> pairs_;              // in points_
    std::pmr::vector<Unresolved> unresolved_;    // sorted by body_b
    std::pmr::vector<Range> unresolved_by_body_; // in unresolved_, one for each body_b
    PerWorker<Worker> workers_;
};

} // namespace vox
