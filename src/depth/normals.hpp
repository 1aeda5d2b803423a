// Smooth normals of a surface. Each is computed when it is first needed, and kept.
#pragma once

#include "depth/walk.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <tuple>
#include <vector>

namespace vox::depth {

// The outward unit normal of facet i of a tetrahedron, or (0, 0, 1) if it rounds to zero.
Vec3d facet_normal(const Solid& solid, std::uint32_t tet, int i);

class Normals {
public:
    explicit Normals(std::pmr::memory_resource* memory)
        : places_(memory), faces_(memory), corners_(memory), known_(memory) {}

    // Call it before the others, for another solid or when positions have changed. Throws what the memory
    // throws, as prepare() does.
    void begin(const Solid& solid);

    // Computes what at() needs of these triangles, unless that is known.
    void prepare(std::span<const std::uint32_t> triangles);

    // The unit normal at a point of a triangle that is prepared, interpolated from normals at the corners, on
    // the side to which `outward` points. Zero where the triangle has no area.
    Vec3d at(const SurfacePoint& point, const Vec3d& outward) const;

    auto buffers() { return std::tie(places_, faces_, corners_, known_); }

private:
    static constexpr std::uint32_t none = 0xffffffffu, flat_bit = 0x80000000u;
    static constexpr std::uint8_t all_corners = 7;

    // A triangle, in one cache line.
    struct alignas(64) Face {
        Vec3d normal;           // out of its tetrahedron; unit, or zero
        double weight[3];       // of `normal` in the normals of the corners
        std::uint32_t v[3];     // its corners
        std::uint32_t triangle; // and flat_bit: its tetrahedron is flat, so neither side is outside

        bool is_flat() const noexcept { return (triangle & flat_bit) != 0; }
        std::size_t corner_at(std::uint32_t vertex) const noexcept {
            return v[0] == vertex ? 0 : v[1] == vertex ? 1 : 2;
        }
    };

    std::uint32_t add(std::uint32_t triangle);
    void compute_face(Face& face) const;
    void compute_corner(std::uint32_t asking, std::size_t i);

    Solid solid_{};
    std::pmr::vector<std::uint32_t> places_; // of each triangle, in the other lists, or none
    std::pmr::vector<Face> faces_;           // in the order in which they were needed
    std::pmr::vector<std::array<Vec3d, 3>> corners_; // unit normals at the corners
    std::pmr::vector<std::uint8_t> known_;           // a bit for each of these
};

} // namespace vox::depth
