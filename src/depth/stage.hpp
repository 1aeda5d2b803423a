// The depth stage, which makes one penetration of the contacts of each vertex of a body in another.
// docs/depth-method.md describes the method; each part is a file in depth/.
#pragma once

#include "base/array.hpp"
#include "base/counters.hpp"
#include "base/per_worker.hpp"
#include "base/scene.hpp"
#include "depth/consistent.hpp"
#include "depth/fallback.hpp"
#include "depth/penetrations.hpp"
#include "mesh/topology.hpp"

#include <vox/vox.h>

#include <cstdint>
#include <memory_resource>
#include <span>
#include <tuple>

namespace vox {

class Workers;

// Keeps the stage's buffers from step to step, so that the steady state allocates nothing, with any number of
// workers.
class DepthStage {
public:
    // `trees` has to live as long.
    DepthStage(std::pmr::memory_resource* memory, depth::SurfaceTrees& trees);
    DepthStage(const DepthStage&) = delete;
    DepthStage& operator=(const DepthStage&) = delete;

    // Replaces `penetrations` by those of `hits`, in the order of make_contacts(); those of bodies at rest
    // stay. `topologies` has one for each body.
    // With `closest`, each is found by the closest point alone. `closest_budget` as in vox_constraint_desc;
    // what stays takes nothing of it. Sets the counters from
    // `leaving_edges` to `closest_tests`, and `unknown_penetrations`. `workers` may be null; the result does
    // not depend on them.
    void find(std::span<const Body> bodies, std::span<const Topology* const> topologies,
              std::span<const Hit> hits, bool closest, std::uint64_t closest_budget, Workers* workers,
              Penetrations& penetrations, Counters& counters);

    // Room for so many bodies and contacts, but for closest points that are searched. Throws what the memory
    // throws.
    void reserve(std::size_t bodies, std::uint64_t contacts);

private:
    struct Worker {
        explicit Worker(std::pmr::memory_resource* memory) : consistent(memory) {}

        depth::ConsistentScratch consistent;
        depth::Counts counts;

        auto buffers() { return consistent.buffers(); }
    };
    void list_places(const depth::Scene& scene);
    void find_consistent(const depth::Scene& scene, std::size_t pair, Worker& worker);

    // The places of penetrations to find, pair after pair, each in the order of vertices; and the first of
    // each pair, and of each body_b, in this list.
    Array<std::uint32_t> places_, pairs_, first_of_b_;
    Array<std::uint32_t> queue_; // for find_consistent_depths(), as long
    PerWorker<Worker> workers_;
    depth::Fallback fallback_;
};

} // namespace vox
