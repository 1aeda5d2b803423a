// The closest points of the vertices for which means over neighbours are of no use.
#pragma once

#include "base/per_worker.hpp"
#include "base/scene.hpp"
#include "depth/normals.hpp"
#include "depth/points.hpp"
#include "depth/surface_trees.hpp"

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox {
class Workers;
}

namespace vox::depth {

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
    Searched find(std::span<const Body> bodies, std::span<const Topology* const> topologies,
                  std::span<const Hit> hits, std::uint64_t budget, Workers* workers, std::span<Point> points,
                  Counts& counts);

private:
    struct BodyTree { // of a body that is searched
        SurfaceTree* tree = nullptr;
        bool is_wanted = false, folds = false;
    };
    struct Item { // a point that is searched
        std::uint32_t body_b, part, code;
        bool self;
        std::size_t point;
    };
    struct Chunk { // items next to each other, with one body_b and part
        std::size_t first, last;
    };
    struct Worker {
        explicit Worker(std::pmr::memory_resource* memory) : normals(memory) {}

        Normals normals;
        Counts counts;

        auto buffers() { return normals.buffers(); }
    };
    struct Scene {
        std::span<const Body> bodies;
        std::span<const Topology* const> topologies;
        std::span<const Hit> hits;
        std::span<Point> points;

        Solid solid(std::uint32_t body) const {
            return {topologies[body], bodies[body].tets, bodies[body].positions};
        }
        Vec3d position(const Point& point) const {
            return bodies[hits[point.hit].body_a].positions.exact(point.vertex);
        }
    };

    std::uint64_t spend(const Scene& scene, std::uint64_t budget);
    void update_trees(const Scene& scene, Workers* workers);
    void sort_items(const Scene& scene);
    void list_chunks();
    void search(const Scene& scene, const Chunk& chunk, Worker& worker) const;
    void search_one(const Scene& scene, const Item& item, const SurfaceTree* tree, SearchState& state,
                    Worker& worker) const;

    SurfaceTrees& trees_;
    std::pmr::vector<BodyTree> tree_of_body_;
    std::pmr::vector<std::uint32_t> used_; // bodies with a tree in this step
    std::pmr::vector<Item> items_;
    std::pmr::vector<std::size_t> places_; // for the budget
    std::pmr::vector<Chunk> chunks_;
    PerWorker<Worker> workers_;
};

} // namespace vox::depth
