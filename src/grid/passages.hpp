// Passages: vertices that met the surface of another body on their way from their previous positions
// (vox_passage). For both engines alike.
#pragma once

#include "base/array.hpp"
#include "base/counters.hpp"
#include "base/per_worker.hpp"
#include "base/scene.hpp"
#include "exact/meeting_time.hpp"
#include "grid/vertex_face_search.hpp"

#include <vox/vox.h>

#include <array>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <tuple>

namespace vox {

class Passages final : NearFacesVisitor {
public:
    explicit Passages(std::pmr::memory_resource* memory)
        : bound_(memory), previous_(memory), workers_(memory), found_(memory), passages_(memory) {}

    // The previous positions of a mesh; without data: it has none any more.
    void bind(vox_body mesh, const Positions& positions);
    void forget(vox_body mesh) noexcept;
    bool any_bound() const noexcept { return !bound_.empty(); }

    // Replaces the passages. If it throws, clear() is to be called.
    void find(const EdgeScene& scene, VertexFaceSearch& search, Counters& counters);

    std::span<const vox_passage> all() const noexcept { return passages_; }
    void clear() noexcept { passages_.clear(); }

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

        Array<vox_passage> found;
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

    Array<Bound> bound_;               // by mesh
    Array<Positions> previous_;        // of each body of a step
    const EdgeScene* scene_ = nullptr; // during a step
    PerWorker<Worker> workers_;
    Array<vox_passage> found_, passages_;
};

} // namespace vox
