// Edge contacts: edges of the surface of one body through faces of the surface of another, or of its own
// (vox_edge_contact). Found in every step of a grid with VOX_GRID_EDGE_CONTACTS, for both engines alike.
#pragma once

#include "base/boxes.hpp"
#include "base/per_worker.hpp"
#include "base/scene.hpp"
#include "depth/closest.hpp"
#include "fast/body_pairs.hpp"
#include "grid/contact_pairs.hpp"
#include "grid/surface_features.hpp"
#include "mesh/topology.hpp"

#include <vox/vox.h>

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <mutex>
#include <span>
#include <tuple>
#include <vector>

namespace vox {

class FastEngine;
class Workers;

// A step as it is when the hits are found.
struct EdgeScene {
    std::span<const Body> bodies;
    std::span<const Topology* const> topologies; // of each
    std::span<const std::uint32_t> versions;     // of these, which grow with every change (Mesh)
    const FastEngine* engine;                    // null for the reference engine: nothing is carried over
    Workers* workers;
};

// A mesh of edge contacts, as it is when their depths are asked for.
struct EdgeBody {
    Body body;
    const depth::SurfaceTree* tree; // fitted; null where no edge of another mesh passes through the surface
};

class EdgeContacts {
public:
    explicit EdgeContacts(std::pmr::memory_resource* memory);

    // Replaces the contacts. Those between bodies at rest are carried over; the surfaces of bodies that are
    // near others are prepared. Sets the counters of edge contacts. If it throws, clear() is to be called.
    void find(const EdgeScene& scene, vox_counters& counters);

    std::span<const vox_edge_contact> all() const noexcept { return contacts_; }
    std::uint64_t hash() const noexcept;
    // Whether the last step found what the one before had, all of it carried over.
    bool unchanged() const noexcept { return unchanged_; }
    // The meshes that have edge contacts, in order.
    std::span<const EdgePair> pairs() const noexcept { return pairs_; }

    // Finds the way out for each contact; `bodies` are those of the contacts, ascending. Throws what the
    // memory throws; the depths of before stay then.
    void prepare_depths(std::span<const EdgeBody> bodies, Workers& workers);
    // Throws Error(INVALID_STATE) before prepare_depths(), after a step.
    std::span<const vox_depth> depths() const;

    void clear() noexcept;
    // Of a mesh that is gone, or whose tetrahedra are others.
    void forget(vox_mesh mesh) noexcept;
    void forget_all() noexcept { surfaces_.clear(); }

private:
    // What is kept of a mesh, by its id.
    struct Surface {
        Surface(vox_mesh id, std::uint32_t topology_version, std::pmr::memory_resource* memory) noexcept
            : mesh(id), version(topology_version), features(memory) {}

        vox_mesh mesh;
        std::uint32_t version;
        SurfaceFeatures features;
    };
    // What a step knows of a body.
    struct StepSurface {
        const SurfaceFeatures* features; // null for a body that no pair has
        std::uint32_t first_tile;        // in tile_boxes_
        Box box;
    };
    struct TilePiece {
        std::uint32_t body, first, last;
    };
    // Tiles of the two bodies of a pair that may meet the other one.
    struct Worker {
        explicit Worker(std::pmr::memory_resource* memory)
            : tiles_a(memory), tiles_b(memory), boxes_b(memory), groups_b(memory) {}
        auto buffers() { return std::tie(tiles_a, tiles_b, boxes_b, groups_b); }

        std::pmr::vector<std::uint32_t> tiles_a, tiles_b;
        std::pmr::vector<Box> boxes_b, groups_b; // of tiles_b
        std::uint64_t candidates = 0, exact_tests = 0;
    };
    struct LoadedTile;
    // Where a contact of found_ comes in the canonical order.
    struct Key {
        std::uint32_t of[7];
        std::uint32_t index;

        auto operator<=>(const Key&) const = default;
    };

    void carry(const EdgeScene& scene);
    void list_pairs(const EdgeScene& scene);
    void prepare_surfaces(const EdgeScene& scene);
    const SurfaceFeatures& surface_of(const EdgeScene& scene, std::uint32_t body);
    void make_tile_boxes(const EdgeScene& scene);
    void search_pairs(const EdgeScene& scene);
    bool list_tiles(const fast::Pair& pair, Worker& worker) const;
    void search(const EdgeScene& scene, const fast::Pair& pair, const Worker& tiles, std::size_t begin,
                std::size_t end, Worker& worker);
    void load(const EdgeScene& scene, std::uint32_t body, std::uint32_t tile, LoadedTile& out) const;
    void test(const EdgeScene& scene, const LoadedTile& edges, const LoadedTile& faces, Worker& worker);
    void decide(const EdgeScene& scene, const LoadedTile& edges, std::size_t edge, const LoadedTile& faces,
                std::size_t face, Worker& worker);
    void put_in_order();
    void list_touching();

    std::pmr::memory_resource* memory() const noexcept { return surfaces_.get_allocator().resource(); }

    std::pmr::vector<Surface> surfaces_; // by mesh

    // One step.
    Vec3d origin_{};                               // subtracted from positions before they are rounded
    fast::PairBuffers pair_buffers_;               // with the reference engine
    std::pmr::vector<Box> body_boxes_;             // with the reference engine
    std::pmr::vector<fast::Pair> pairs_of_bodies_; // a <= b
    std::pmr::vector<StepSurface> step_surfaces_;  // of each body
    std::pmr::vector<TilePiece> pieces_;
    std::pmr::vector<Box> tile_boxes_;
    PerWorker<Worker> workers_;
    std::mutex mutex_; // of found_
    std::pmr::vector<vox_edge_contact> found_;
    std::pmr::vector<Key> keys_;

    // Results.
    std::pmr::vector<vox_edge_contact> contacts_;
    std::pmr::vector<EdgePair> pairs_;
    std::pmr::vector<vox_depth> depths_;
    bool unchanged_ = false, has_depths_ = false;
};

} // namespace vox
