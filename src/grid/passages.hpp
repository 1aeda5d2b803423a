// Passages: vertices that met the surface of another body on their way from their previous positions. For
// both engines alike.
#pragma once

#include "base/array.hpp"
#include "base/counters.hpp"
#include "base/per_worker.hpp"
#include "base/scene.hpp"
#include "exact/meeting_time.hpp"
#include "grid/contact_pairs.hpp"
#include "grid/vertex_face_search.hpp"

#include <vox/vox.h>

#include <array>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <tuple>

namespace vox {

// Vertex `vertex` of body_a met the surface of body_b while both moved from their previous positions to the
// present ones, wherever it was before and is after. None is missed; a vertex that comes as close to a
// surface as rounding errors are large may be reported as well.
struct Passage {
    vox_body body_a;
    std::uint32_t vertex;
    vox_body body_b;          // never body_a
    std::uint32_t tet, facet; // of body_b: the first that it met; the lowest of several at the same time
    std::uint32_t face[3];    // its vertices
    double time;              // in [0, 1]; never too late
};

// A vertex that met a surface, is not inside, and is behind the plane of the face now: it went through.
struct Impact : Passage {
    double weights[3]; // of the point of the face where they met
    double normal[3];  // of the face now, out of body_b
    double gap;        // to its plane; not positive
};

class Passages final : NearFacesVisitor {
public:
    explicit Passages(std::pmr::memory_resource* memory)
        : bound_(memory), previous_(memory), workers_(memory), found_(memory), passages_(memory),
          impacts_(memory), pairs_(memory) {}

    // The previous positions of a mesh; without data: it has none any more.
    void bind(vox_body mesh, const Positions& positions);
    void forget(vox_body mesh) noexcept;
    bool any_bound() const noexcept { return !bound_.empty(); }

    // Replaces the passages; `contacts` are those of the step, in canonical order. If it throws, clear() is
    // to be called.
    void find(const StepScene& scene, std::span<const vox_contact> contacts, VertexFaceSearch& search,
              Counters& counters);

    std::span<const Passage> all() const noexcept { return passages_; }
    std::span<const Impact> impacts() const noexcept { return impacts_; } // in the order of passages
    std::span<const IdPair> pairs() const noexcept { return pairs_; }     // of bodies with impacts, in order
    void clear() noexcept {
        passages_.clear();
        impacts_.clear();
        pairs_.clear();
    }

private:
    struct Bound {
        vox_body mesh;
        Positions positions;
    };
    // The first face so far that a vertex met.
    struct Met {
        std::uint32_t place; // of the vertex in the pair
        std::uint32_t face;  // of the surface
        std::array<std::uint32_t, 3> corners;
        double time;
    };
    struct Worker {
        explicit Worker(std::pmr::memory_resource* memory) : found(memory), met(memory), met_of(memory) {}
        auto buffers() { return std::tie(found, met, met_of); }

        Array<Passage> found;
        // Of the pair that it is at.
        VertexFacePair pair{};
        Array<Met> met;
        Array<std::uint32_t> met_of; // of each vertex; none_yet
        // Of the tile of the last call.
        const SurfaceTile* tile = nullptr;
        std::array<Vec3d, SurfaceTile::most_vertices> from, to;
    };
    static constexpr std::uint32_t none_yet = ~0u;

    void leave_out(std::uint32_t a, std::uint32_t b, Array<std::uint32_t>& vertices) const override;
    void begin(const VertexFacePair& pair, std::uint32_t worker) override;
    void visit(const SurfaceTile& tile, std::span<const NearFaces> near, std::uint32_t worker) override;
    void end(std::uint32_t worker) override;
    void load(Worker& worker, const SurfaceTile& tile) const;
    void visit(Worker& worker, const SurfaceTile& tile, const NearFaces& near) const;
    Vec3d before(std::uint32_t body, std::uint32_t vertex) const noexcept;
    void list_impacts(std::span<const vox_contact> contacts);

    Array<Bound> bound_;               // by mesh
    Array<Positions> previous_;        // of each body of a step
    const StepScene* scene_ = nullptr; // during a step
    PerWorker<Worker> workers_;
    Array<Passage> found_, passages_;
    Array<Impact> impacts_;
    Array<IdPair> pairs_;
};

} // namespace vox
