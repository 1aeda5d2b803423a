// Proximities: vertices outside of the tetrahedra of another body, but within a margin of its surface. Found
// in every step of a grid with a margin, for both engines alike.
#pragma once

#include "exact/closest_point.hpp"
#include "grid/least_faces.hpp"

#include <array>
#include <cstdint>
#include <memory_resource>

namespace vox {

// The face has the point of the surface of body_b that is closest to the vertex; of several at the same
// distance that of the lowest (tet, facet), as in vox_locator_find_closest. Computed in double.
struct Proximity : VertexFace {
    double face_weights[3];
    double distance;
    double normal[3]; // from the closest point to the vertex; out of the tetrahedron if there is no distance
};

struct ExactTile {
    struct Box3d {
        Vec3d min, max;
    };
    std::array<Vec3d, SurfaceTile::most_vertices> points;
    std::array<Box3d, SurfaceTile::most_faces> boxes;
};

class Proximities final : public LeastFaces<Proximity, ExactTile> {
public:
    explicit Proximities(std::pmr::memory_resource* memory) : LeastFaces(memory) {}

    void set_margin(double margin) noexcept { margin_ = margin; }
    double margin() const noexcept { return margin_; }

    void find(const StepScene& scene, KeptFeatures& kept);
    void count(Counters& counters) const noexcept;
    void add_to(ConstraintSources& sources, depth::SurfaceTrees& trees, Workers& workers) const noexcept;
    void forget(vox_body) noexcept {}
    void forget_all() noexcept { clear(); }

private:
    void leave_out(std::uint32_t a, std::uint32_t b, Array<std::uint32_t>& vertices) const override;
    void load(Worker& worker) const override;
    void look(Worker& worker, const NearFaces& near) const override;
    Proximity element_of(const Worker& worker, const Least& least) const override;

    double margin_ = 0;
    std::size_t carried_ = 0;
};

} // namespace vox
