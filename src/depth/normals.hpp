// Smooth normals of a surface. Each is computed when it is first needed, and kept until there are too many.
#pragma once

#include "base/array.hpp"
#include "base/place_map.hpp"
#include "depth/walk.hpp"

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <tuple>

namespace vox::depth {

// The outward unit normal of facet i of a tetrahedron, or (0, 0, 1) if it rounds to zero.
Vec3d facet_normal(const Solid& solid, std::uint32_t tet, int i);

class Normals {
public:
    explicit Normals(std::pmr::memory_resource* memory)
        : face_places_(memory), ring_places_(memory), asked_places_(memory), faces_(memory), rings_(memory),
          ring_faces_(memory), asked_(memory), known_(memory) {}

    // Call it before the others, for another solid or when positions have changed.
    void begin(const Solid& solid);
    // True if the solid has so few triangles that none is ever forgotten; they take the same room at any
    // time.
    bool has_few() const noexcept { return !known_.empty(); }

    // Computes what at() needs of these triangles, unless that is known: for many triangles sooner than one
    // by one. Throws what the memory throws.
    void prepare(std::span<const std::uint32_t> triangles);

    // The unit normal at a point of a triangle, interpolated from normals at the corners, on the side to
    // which `outward` points. Zero where the triangle has no area. Throws as prepare(), of other triangles.
    Vec3d at(const SurfacePoint& point, const Vec3d& outward);

    auto buffers() {
        return std::tie(face_places_, face_places_.tree(), ring_places_, ring_places_.tree(), asked_places_,
                        asked_places_.tree(), faces_, rings_, ring_faces_, asked_, known_);
    }

private:
    // A triangle, in one cache line.
    struct alignas(64) Face {
        static constexpr std::uint32_t flat_bit = 0x80000000u;

        Vec3d normal;           // out of its tetrahedron; unit, or zero
        double weight[3];       // of `normal` in the normals of the corners
        std::uint32_t v[3];     // its corners
        std::uint32_t triangle; // and flat_bit: its tetrahedron is flat, so neither side is outside

        bool is_flat() const noexcept { return (triangle & flat_bit) != 0; }
        double weight_at(std::uint32_t vertex) const noexcept {
            return weight[v[0] == vertex ? 0 : v[1] == vertex ? 1 : 2];
        }
    };
    // The triangles around a vertex.
    struct Ring {
        std::uint32_t first, last; // in ring_faces_
        bool is_smooth, is_rough;  // whether all triangles have `normal` here; neither: not known yet
        Vec3d normal;
    };
    // A triangle that was prepared.
    struct Asked {
        std::uint32_t face;
        std::uint32_t ring[3];
        Vec3d normal[3]; // at its corners; unit
    };

    // More are forgotten before the next are prepared, so that the tables stay in cache, and small however
    // many triangles take part.
    static constexpr std::size_t most_faces = 8192;

    // Solids with up to so many triangles, and vertices, have places for all of them: their numbers. They are
    // mostly surface, and others meet much of it.
    static constexpr std::size_t few = 1024;
    enum Known : std::uint8_t { known_face = 1, known_ring = 2, known_corners = 4 };

    std::uint32_t add_face(std::uint32_t triangle);
    void list_rings(std::size_t first_asked);
    void compute_face(const Triangle& of, Face& face) const;
    std::uint32_t asked_place(std::uint32_t triangle) const noexcept; // or PlaceMap::none
    void prepare_few(std::span<const std::uint32_t> triangles);
    Vec3d corner_normal(const Face& asking, std::uint32_t vertex, Ring& ring) const;

    Solid solid_{};
    PlaceMap face_places_, ring_places_, asked_places_; // by triangle, vertex, triangle
    Array<Face> faces_;
    Array<Ring> rings_;
    Array<std::uint32_t> ring_faces_;
    Array<Asked> asked_;
    Array<std::uint8_t> known_; // of a body of few triangles: what is known of each, and of each vertex
};

} // namespace vox::depth
