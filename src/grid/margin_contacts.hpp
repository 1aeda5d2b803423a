// Margin contacts: vertices outside of the tetrahedra of another body, but within a distance of its surface
// Found in every step of a grid with a margin, for both engines alike.
#pragma once

#include "base/array.hpp"
#include "base/counters.hpp"
#include "base/per_worker.hpp"
#include "base/scene.hpp"
#include "exact/closest_point.hpp"
#include "grid/contact_pairs.hpp"
#include "grid/vertex_face_search.hpp"

#include <vox/vox.h>

#include <array>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <tuple>

namespace vox {

// The point of the surface of body_b that is closest to the vertex is on a facet of `tet`; of several at the
// same distance that of the lowest (tet, facet), as in vox_locator_find_closest. Computed in double.
struct MarginContact {
    vox_body body_a;
    std::uint32_t vertex;
    vox_body body_b; // never body_a
    std::uint32_t tet, facet;
    std::uint32_t face[3]; // vertices of body_b
    double face_weights[3];
    double distance;
    double normal[3]; // from the closest point to the vertex; out of the tetrahedron if there is no distance
};

class MarginContacts final : NearFacesVisitor {
public:
    explicit MarginContacts(std::pmr::memory_resource* memory)
        : workers_(memory), found_(memory), order_(memory), contacts_(memory), pairs_(memory) {}

    // Replaces the margin contacts; `contacts` are those of the step, in canonical order. Those between
    // bodies at rest are carried over. If it throws, clear() is to be called.
    void find(const StepScene& scene, double margin, std::span<const vox_contact> contacts,
              VertexFaceSearch& search, Counters& counters);

    std::span<const MarginContact> all() const noexcept { return contacts_; }
    std::span<const IdPair> pairs() const noexcept { return pairs_; } // of bodies, in order
    void clear() noexcept {
        contacts_.clear();
        pairs_.clear();
    }

private:
    struct Found {
        MarginContact contact;
        double squared; // distance
    };
    // The closest face so far of a vertex.
    struct Closest {
        std::uint32_t place; // of the vertex in the pair
        std::uint32_t face;  // of the surface
        std::array<std::uint32_t, 3> corners;
        SeenPoint seen;
        double squared; // distance
    };
    struct Reached {
        double squared;
        std::uint32_t closest; // its index; none_yet
    };
    static constexpr std::uint32_t none_yet = ~0u;
    struct Box3d {
        Vec3d min, max;
    };
    struct Worker {
        explicit Worker(std::pmr::memory_resource* memory)
            : found(memory), closest(memory), reached(memory) {}
        auto buffers() { return std::tie(found, closest, reached); }

        Array<Found> found;
        // Of the pair that it is at.
        VertexFacePair pair{};
        Array<Closest> closest;
        Array<Reached> reached; // of each vertex
        // Of the tile of the last call.
        const SurfaceTile* tile = nullptr;
        std::array<Vec3d, SurfaceTile::most_vertices> points;
        std::array<Box3d, SurfaceTile::most_faces> boxes;
    };

    void leave_out(std::uint32_t a, std::uint32_t b, Array<std::uint32_t>& vertices) const override;
    void begin(const VertexFacePair& pair, std::uint32_t worker) override;
    void visit(const SurfaceTile& tile, std::span<const NearFaces> near, std::uint32_t worker) override;
    void end(std::uint32_t worker) override;
    void load(Worker& worker, const SurfaceTile& tile) const;
    void visit(Worker& worker, const SurfaceTile& tile, const NearFaces& near) const;
    void put_in_order();

    PerWorker<Worker> workers_;
    const StepScene* scene_ = nullptr; // during a step, as are the next two
    std::span<const vox_contact> inside_;
    double most_ = 0; // the margin, squared
    Array<Found> found_;
    Array<std::uint32_t> order_;
    Array<MarginContact> contacts_;
    Array<IdPair> pairs_;
};

} // namespace vox
