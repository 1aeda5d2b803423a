// Smooth normals of a surface where they are asked for, each made once.
#pragma once

#include "depth/walk.hpp"

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <vector>

namespace vox::depth {

class Normals {
public:
    explicit Normals(std::pmr::memory_resource* memory) : faces_(memory) {}

    // Room for surfaces of that many triangles.
    void reserve(std::size_t triangles) {
        if (triangles > faces_.size()) faces_.resize(triangles);
    }

    std::size_t capacity() const noexcept { return faces_.size(); }

    // To be called before at(), for another solid or when positions have changed.
    void begin(const Solid& solid);

    // The unit normal at a point of the surface, interpolated from normals at the corners, on the side of the
    // triangle to which `outward` points. Zero where the triangle has no area.
    Vec3d at(const SurfacePoint& point, const Vec3d& outward);

private:
    struct Face {
        std::uint32_t age = 0; // of the last begin() after which it was asked for
        bool has_corners = false;
        bool is_flat = false;      // its tetrahedron is: no telling which side is out
        Vec3d normal{};            // out of its tetrahedron; unit, or zero
        double corner_weight[3]{}; // of the normal in those of the corners
        Vec3d corner[3]{};         // unit normals at the corners
    };

    Face& face(std::uint32_t triangle);
    const Face& face_with_corners(std::uint32_t triangle);

    Solid solid_{};
    std::uint32_t age_ = 0;
    std::pmr::vector<Face> faces_;
};

} // namespace vox::depth
