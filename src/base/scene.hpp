// Plain views of the meshes of one step, on which the stages work.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace vox {

struct Vec3d {
    double x, y, z;
};

struct Vec3f {
    float x, y, z;

    constexpr operator Vec3d() const noexcept { return {double{x}, double{y}, double{z}}; } // exact
};

// Four vertex indices of one tetrahedron, in the caller's order.
struct Tet {
    std::uint32_t v[4];
};

// The facets of a tetrahedron, facet i opposite corner i; counter-clockwise from outside when it is positive.
inline constexpr std::uint8_t facet_corners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

// Such a tetrahedron has no facets.
inline bool names_a_vertex_twice(const Tet& t) noexcept {
    return t.v[0] == t.v[1] || t.v[0] == t.v[2] || t.v[0] == t.v[3] || t.v[1] == t.v[2] || t.v[1] == t.v[3] ||
           t.v[2] == t.v[3];
}

struct Box3f {
    Vec3f min, max;
};

// The caller's positions, strided and borrowed, valid during the step only: floats or doubles, with or
// without a transform, in rows or columns. Every contact is decided by exact(). Candidates are found with the
// nearest floats, operator[], and none is missed: rounding is monotonic, so a point in a box is, once
// rounded, in the rounded box.
struct Positions {
    const std::byte* data = nullptr;
    std::size_t byte_stride = 0;
    bool doubles = false;              // else floats
    const double* transform = nullptr; // three rows of four (vox_body_set_transform), or null
    std::size_t component_gap = 0; // bytes between the numbers of a position; 0 unless they are in columns

    // True if operator[] may differ from exact().
    bool rounded() const noexcept { return doubles || transform; }

    Vec3d exact(std::size_t vertex) const noexcept {
        return rounded() ? exact_of_rounded(vertex) : floats(vertex);
    }

    // The address to prefetch for a vertex.
    const std::byte* place_of(std::size_t vertex) const noexcept { return data + vertex * byte_stride; }

    // Positions must not be rounded().
    Vec3f floats(std::size_t vertex) const noexcept { return read<Vec3f, float>(vertex); }

    // Writes the three numbers of a position as they are, without the transform, one after the other.
    void copy(std::size_t vertex, std::byte* to) const noexcept {
        const std::size_t size = doubles ? sizeof(double) : sizeof(float);
        const std::byte* from = data + vertex * byte_stride;
        for (std::size_t axis = 0; axis < 3; ++axis)
            std::memcpy(to + axis * size, from + axis * (size + component_gap), size);
    }

    // Infinite where a coordinate is 2^128 - 2^103 or more in magnitude.
    Vec3f operator[](std::size_t vertex) const noexcept {
        if (!rounded()) return floats(vertex);
        const Vec3d p = exact(vertex);
        return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    }

    // The order of operations, each rounded to double, is part of the public interface.
    static Vec3d transformed(const double* m, const Vec3d& p) noexcept {
        return {((m[0] * p.x + m[1] * p.y) + m[2] * p.z) + m[3],
                ((m[4] * p.x + m[5] * p.y) + m[6] * p.z) + m[7],
                ((m[8] * p.x + m[9] * p.y) + m[10] * p.z) + m[11]};
    }

private:
    // Not inlined, so that exact() is.
    [[gnu::noinline]] Vec3d exact_of_rounded(std::size_t vertex) const noexcept {
        const Vec3d p = doubles ? read<Vec3d, double>(vertex) : Vec3d(floats(vertex));
        return transform ? transformed(transform, p) : p;
    }

    // Three copies: a point copied as a whole would go through memory.
    template <class Point, class Number>
    Point read(std::size_t vertex) const noexcept {
        const std::byte* from = data + vertex * byte_stride;
        const std::size_t to_next = sizeof(Number) + component_gap;
        Number x, y, z;
        std::memcpy(&x, from, sizeof x);
        std::memcpy(&y, from + to_next, sizeof y);
        std::memcpy(&z, from + 2 * to_next, sizeof z);
        return {x, y, z};
    }
};

struct SelfFilter;
class RigidShape;

// Decides which other meshes a mesh collides with (vox_filter).
struct PairFilter {
    std::uint64_t category = 1, mask = ~std::uint64_t{0};
    std::int32_t group = 0;
    std::uint32_t world = 0;

    bool operator==(const PairFilter&) const = default;
};
constexpr bool collide(const PairFilter& a, const PairFilter& b) noexcept {
    if (a.world != b.world) return false;
    if (a.group != 0 && a.group == b.group) return a.group > 0;
    return (a.category & b.mask) != 0 && (b.category & a.mask) != 0;
}

// One mesh as the stages see it. mesh_id ascends from body to body, so the order of body indices is the
// canonical order of ids.
struct Body {
    static constexpr std::uint32_t in_array = ~0u, no_slot = ~1u;

    std::uint32_t mesh_id = 0;
    std::uint32_t vertex_count = 0;
    Positions positions{};
    std::span<const Tet> tets{};
    bool self_collision = false;
    bool sensor = false; // VOX_FILTER_SENSOR
    PairFilter filter{};
    // Ids of the meshes that it never collides with, ascending. Both meshes of a pair list each other.
    std::span<const std::uint32_t> exceptions{};
    const SelfFilter* self_filter = nullptr; // null without a filter
    // Tetrahedra that are off, as bits (bits.hpp); empty if all are on. All four corners of such a
    // tetrahedron are one vertex, so it contains nothing and has no edges and facets.
    std::span<const std::uint64_t> off{};
    std::uint64_t off_count = 0;
    std::span<const std::uint64_t> removed_vertices{}; // vertices that are in no tetrahedron, as bits
    // Set once contacts are found: contacts of two carried bodies are those of the last step.
    bool carried = false;
    // The mesh's slot in its grid; no_slot if it is not in a grid yet, in_array for an element of an array,
    // whose index is mesh_id.
    std::uint32_t slot = in_array;
    std::uint64_t user_data = 0;
    const RigidShape* shape = nullptr; // null for a mesh; a shape has no vertices
};

// The index of the body with this mesh, or of the next one.
inline std::uint32_t body_index(std::span<const Body> bodies, std::uint32_t mesh_id) noexcept {
    return static_cast<std::uint32_t>(std::ranges::lower_bound(bodies, mesh_id, {}, &Body::mesh_id) -
                                      bodies.begin());
}

// A vertex in a closed tetrahedron, as an engine finds it. Bodies are indices into the scene; the canonical
// order comes later (make_contacts).
struct Hit {
    std::uint32_t body_a;
    std::uint32_t vertex;
    std::uint32_t body_b;
    std::uint32_t tet : 31;
    std::uint32_t interior : 1; // strictly inside, on no face
};

} // namespace vox
