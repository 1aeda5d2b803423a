// The closest points of the vertices for which means over neighbours are of no use.
#pragma once

#include "base/array.hpp"
#include "base/per_worker.hpp"
#include "base/scene.hpp"
#include "depth/closest.hpp"
#include "depth/consistent.hpp"
#include "depth/normals.hpp"

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {
class Workers;
}

namespace vox::depth {

// The input of the stage in a step, and its penetrations.
struct Scene {
    std::span<const Body> bodies;
    std::span<const Topology* const> topologies;
    std::span<const Hit> hits;
    Penetrations& penetrations;
    std::span<const std::uint32_t> places{}; // of the penetrations that are found in this step

    const Hit& hit(std::uint32_t place) const { return hits[penetrations.of(place).contact]; }
    Solid solid(std::uint32_t body) const {
        return {topologies[body], bodies[body].tets, bodies[body].positions};
    }
    Vec3d position(const Hit& hit) const { return bodies[hit.body_a].positions.exact(hit.vertex); }
    bool needs_search(std::uint32_t place) const;
};

// Keeps buffers from step to step.
class Fallback {
public:
    Fallback(std::pmr::memory_resource* memory, SurfaceTrees& trees);

    // Depth and direction of all points that are ENCLOSED, or CROSSING without an answer, or, where there are
    // more than `budget`, of the first ones by their place; the others become UNKNOWN. A budget of 0 is no
    // limit.
    // Counts searches and tests. `workers` may be null; the result does not depend on them. Throws what the
    // memory throws.
    struct Searched {
        std::uint64_t searches, unknown;
    };
    Searched find(const Scene& scene, std::uint64_t budget, Workers* workers, Counts& counts);

private:
    struct BodyTree { // of a body that is searched
        SurfaceTree* tree = nullptr;
        bool is_wanted = false, folds = false;
    };
    struct Item { // a point that is searched
        std::uint32_t body_b, part, code, place;
    };
    struct Worker {
        explicit Worker(std::pmr::memory_resource* memory) : normals(memory) {}

        Normals normals;
        Counts counts;

        auto buffers() { return normals.buffers(); }
    };

    std::uint64_t spend(const Scene& scene, std::uint64_t budget);
    void update_trees(const Scene& scene, Workers* workers);
    void sort_items(const Scene& scene);
    void list_chunks();
    void search(const Scene& scene, std::size_t chunk, Worker& worker) const;
    void search_one(const Scene& scene, const Item& item, const SurfaceTree* tree, SearchState& state,
                    Worker& worker) const;

    SurfaceTrees& trees_;
    Array<BodyTree> tree_of_body_;
    Array<std::uint32_t> used_; // bodies with a tree in this step
    Array<Item> items_;
    Array<std::uint32_t> places_; // for the budget
    // The first of those items next to each other that are searched in one go, with one body_b and part.
    Array<std::uint32_t> chunks_;
    PerWorker<Worker> workers_;
};

} // namespace vox::depth
