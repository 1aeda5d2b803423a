// What the stages work on: plain views of the meshes of one step.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace vox {

struct Vec3f {
    float x, y, z;
};

struct Vec3d {
    double x, y, z;
};

// Four vertex indices of one tetrahedron, in the caller's order.
struct Tet {
    std::uint32_t v[4];
};

struct Box3f {
    Vec3f min, max;
};

// The caller's positions: strided, borrowed, only valid during the step.
struct Positions {
    const std::byte* data = nullptr;
    std::size_t byte_stride = 0;

    Vec3f operator[](std::size_t vertex) const noexcept {
        Vec3f p;
        std::memcpy(&p, data + vertex * byte_stride, sizeof p);
        return p;
    }
};

struct SelfFilter;

// Which other meshes a mesh collides with: see vox_filter.
struct PairFilter {
    std::uint64_t category = 1, mask = ~std::uint64_t{0};
    std::int32_t group = 0;

    bool operator==(const PairFilter&) const = default;
};

// One mesh as the stages see it. mesh_id ascends from body to body, so that the order of body indices is the
// canonical order of mesh ids.
struct Body {
    std::uint32_t mesh_id = 0;
    std::uint32_t vertex_count = 0;
    Positions positions{};
    std::span<const Tet> tets{};
    bool self_collision = false;
    PairFilter filter{};
    std::span<const std::uint32_t> exceptions{}; // ascending mesh_ids that it never collides with, nor they with it
    const SelfFilter* self_filter = nullptr;     // null: there is none
};

// A vertex found inside a closed tetrahedron, before canonical order. Bodies by index in the scene.
struct Hit {
    std::uint32_t body_a;
    std::uint32_t vertex;
    std::uint32_t body_b;
    std::uint32_t tet : 31;
    std::uint32_t interior : 1; // strictly inside: on no face
};

} // namespace vox
