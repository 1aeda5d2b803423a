// Smooth normals of a surface. Each is computed when it is first needed, and kept.
#pragma once

#include "depth/walk.hpp"

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <vector>

namespace vox::depth {

// The outward unit normal of facet i of a tetrahedron, or (0, 0, 1) if it rounds to zero.
Vec3d facet_normal(const Solid& solid, std::uint32_t tet, int i);

class Normals {
public:
    explicit Normals(std::pmr::memory_resource* memory) : faces_(memory) {}

    // Makes room for surfaces of that many triangles.
    void reserve(std::size_t triangles) {
        if (triangles > faces_.size()) faces_.resize(triangles);
    }

    std::size_t capacity() const noexcept { return faces_.size(); }

    // Call it before at(), for another solid or when positions have changed.
    void begin(const Solid& solid);

    // The unit normal at a point of the surface, interpolated from normals at the corners, on the side of the
    // triangle to which `outward` points. Zero where the triangle has no area.
    Vec3d at(const SurfacePoint& point, const Vec3d& outward);

private:
    struct Face {
        std::uint32_t age = 0; // age_ when the rest was computed
        bool has_corners = false;
        bool is_flat = false;      // its tetrahedron is flat, so neither side is outside
        Vec3d normal{};            // out of its tetrahedron; unit, or zero
        double corner_weight[3]{}; // of `normal` in the normals of the corners
        Vec3d corner[3]{};         // unit normals at the corners
    };

    Face& face(std::uint32_t triangle);
    const Face& face_with_corners(std::uint32_t triangle);

    Solid solid_{};
    std::uint32_t age_ = 0;
    std::pmr::vector<Face> faces_;
};

} // namespace vox::depth
