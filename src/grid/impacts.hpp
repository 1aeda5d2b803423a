// Impacts: vertices that met the surface of another body on their way from their previous positions, and went
// through it. For both engines alike.
#pragma once

#include "exact/meeting_time.hpp"
#include "grid/least_faces.hpp"
#include "surface/cull.hpp"

#include <vox/vox.h>

#include <array>
#include <cstdint>
#include <memory_resource>

namespace vox {

// A vertex met the surface of body_b while both moved from their previous positions to the present ones,
// wherever it was before and is after. None is missed; a vertex that comes as close to a surface as rounding
// errors are large may be reported as well. The face is the first that it met; the lowest of several at the
// same time.
struct SurfaceMeeting : VertexFace {
    double time; // in [0, 1]; never too late
};

// A vertex that met a surface, is not inside, and is behind the plane of the face now: it went through.
struct Impact : SurfaceMeeting {
    double weights[3]; // of the point of the face where they met
    double normal[3];  // of the face now, out of body_b
    double gap;        // to its plane; not positive
};

struct MovingTile {
    std::array<Vec3d, SurfaceTile::most_vertices> from, to;
    bool has_lanes = false; // made when they are first needed
    CullFrame frame;
    CullTile lanes; // of the faces
};

class Impacts final : public LeastFaces<SurfaceMeeting, MovingTile> {
public:
    explicit Impacts(std::pmr::memory_resource* memory) : LeastFaces(memory), impacts_(memory) {}

    void find(const StepScene& scene, KeptFeatures& kept);
    void count(Counters& counters) const noexcept {
        counters.impacts = all().size();
        count_candidates(counters);
    }
    void add_to(ConstraintSources& sources, depth::SurfaceTrees& trees, Workers& workers) const noexcept;
    void clear() noexcept {
        LeastFaces::clear();
        impacts_.clear();
    }
    void forget(vox_body) noexcept {}
    void forget_all() noexcept { clear(); }

private:
    void leave_out(std::uint32_t a, std::uint32_t b, Array<std::uint32_t>& vertices) const override;
    void load(Worker& worker) const override;
    void sieve(Worker& worker, std::span<NearFaces> near) const override;
    void look(Worker& worker, const NearFaces& near) const override;
    void make_lanes(Worker& worker) const;
    SurfaceMeeting element_of(const Worker& worker, const Least& least) const override;
    Vec3d before(std::uint32_t body, std::uint32_t vertex) const noexcept;
    void list_impacts();

    Array<Impact> impacts_; // in the order of meetings
};

} // namespace vox
