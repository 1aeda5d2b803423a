// Edge contacts: edges of the surface of one body through faces of the surface of another, or of its own.
// Found in every step of a grid with VOX_GRID_EDGES, for both engines alike.
#pragma once

#include "base/counters.hpp"
#include "depth/closest.hpp"
#include "depth/penetrations.hpp"
#include "exact/crossing.hpp"
#include "exact/predicates.hpp"
#include "grid/pairs.hpp"
#include "grid/surface_search.hpp"

#include <vox/vox.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <mutex>
#include <span>
#include <tuple>

namespace vox {

class Workers;
struct ConstraintSources;

// An edge of the surface of body_a and a face of the surface of body_b that have a point in common (a = b:
// self-contact; then they have no vertex in common). The surface of a mesh consists of the facets of exactly
// one of its enabled tetrahedra, duplicates counted once, and of their edges. Decided exactly. Where several
// points are common, the position is that of one of them: an end of the edge if one is, the lower vertex
// first.
struct EdgeContact {
    vox_body body_a;
    std::uint32_t edge[2]; // vertices of body_a, the lower first
    vox_body body_b;
    std::uint32_t face[3]; // vertices of body_b, the lowest first, counter-clockwise as seen from outside
    std::uint32_t tet;     // of body_b, behind the face; of doubled ones the lowest
    CrossingKind kind;
    double edge_weights[2]; // of the point; they add up to 1 up to rounding
    double face_weights[3];
    double position[3];
    double normal[3]; // facet_normal() of the face, for the lower vertex of the edge
};

class EdgeContacts {
public:
    static constexpr auto time = &Profile::edges_ns;

    explicit EdgeContacts(std::pmr::memory_resource* memory);

    void find(const StepScene& scene, KeptFeatures& kept);
    void count(Counters& counters);

    bool is_unchanged() const noexcept { return unchanged_; }
    std::span<const vox_pair> pairs() const noexcept { return pairs_; }

    // Adds them to the sources, and where depths are asked for the way out of those of chosen pairs, by
    // `trees`.
    void add_to(ConstraintSources& sources, depth::SurfaceTrees& trees, Workers& workers);

    void clear() noexcept;
    void forget(vox_body) noexcept {}
    void forget_all() noexcept { clear(); }

private:
    // What a search reads of a tile, in one place.
    struct LoadedTile {
        std::uint32_t body = ~0u, index = ~0u;
        const SurfaceFeatures* features = nullptr;
        const SurfaceTile* tile = nullptr;
        const std::uint32_t* vertices = nullptr;
        const std::array<std::uint8_t, 3>* corners = nullptr; // of each face
        const std::array<std::uint8_t, 2>* ends = nullptr;    // of each edge
        Box box{};
        FaceBoxes faces;
        std::array<Box, SurfaceTile::most_edges> edges;
        // Made when they are first needed.
        bool has_points = false, has_slabs = false;
        std::uint64_t has_plane = 0; // of each face, a bit
        std::array<Vec3d, SurfaceTile::most_vertices> points{};
        std::array<TrianglePlane, SurfaceTile::most_faces> planes{};
        FaceSlabs slabs;
        FaceLines lines;
    };
    struct Worker {
        static constexpr std::size_t most_loaded = 16;

        explicit Worker(std::pmr::memory_resource* memory)
            : tiles_a(memory), tiles_b(memory), boxes_b(memory), loaded(memory), oriented_b(memory),
              crossed_at(memory) {}
        auto buffers() {
            return std::tuple_cat(boxes_b.buffers(), std::tie(tiles_a, tiles_b, oriented_b, crossed_at));
        }

        // Tiles of the two bodies of a pair that may meet the other one.
        Array<std::uint32_t> tiles_a, tiles_b;
        GroupedBoxes boxes_b; // of tiles_b
        // Tiles that were looked at last, each in its place; and one of the body whose turn it is.
        Array<LoadedTile> loaded;
        // Whether the one of body a is crowded, and then its oriented box, and those of boxes_b.
        bool is_crowded = false;
        OrientedBox oriented_a;
        Array<OrientedBox> oriented_b;
        // Where an edge passes through faces of a mesh, ascending, as fractions of its way: for depths.
        Array<double> crossed_at;
        std::uint64_t candidates = 0, exact_tests = 0;
    };
    // Where a contact of found_ comes in the canonical order.
    struct Key {
        std::uint32_t of[7];
        std::uint32_t index;

        auto operator<=>(const Key&) const = default;
    };

    void list_pairs(const StepScene& scene);
    std::size_t list_tiles(const StepScene& scene, const fast::Pair& pair, Worker& worker) const;
    void search(const StepScene& scene, const fast::Pair& pair, const Worker& tiles, std::size_t begin,
                std::size_t end, Worker& worker);
    void orient(const fast::Pair& pair, std::uint32_t tile_a, const Worker& tiles, Worker& worker) const;
    void load(std::uint32_t body, std::uint32_t tile, LoadedTile& out) const;
    bool test(const StepScene& scene, LoadedTile& edges, LoadedTile& faces, Worker& worker);
    void decide(const StepScene& scene, const LoadedTile& edges, std::size_t edge, const LoadedTile& faces,
                std::size_t face, Worker& worker);
    void put_in_order();
    void fit_trees(const ConstraintSources& sources, depth::SurfaceTrees& trees, Workers& workers);
    void find_depths(const ConstraintSources& sources, depth::SurfaceTrees& trees, Workers& workers);

    // One step.
    Array<fast::Pair> pairs_of_bodies_; // a <= b
    SearchedBodies bodies_;
    PerWorker<Worker> workers_;
    std::mutex mutex_; // of found_
    Array<EdgeContact> found_;
    Array<Key> keys_;
    Array<vox_body> entered_; // bodies whose trees are searched for depths

    // Results.
    Array<EdgeContact> contacts_;
    Array<vox_pair> pairs_;
    Array<Depth> depths_;
    std::uint64_t carried_ = 0;
    bool unchanged_ = false;
};

} // namespace vox
