// The parts of a surface, and which of its vertices may meet.
#pragma once

#include "base/array.hpp"
#include "base/scene.hpp"

#include <vox/vox_surface.h>

#include <array>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

using SurfaceEdge = std::array<std::uint32_t, 2>;
using SurfaceFace = std::array<std::uint32_t, 3>;

inline constexpr int feature_kinds = 3;
constexpr unsigned corners_of(vox_feature feature) noexcept { return static_cast<unsigned>(feature) + 1; }

struct SurfaceTopology {
    // Copies and checks what the description names. Throws INVALID_ARGUMENT, INVALID_MESH, LIMIT.
    SurfaceTopology(const vox_surface_desc& desc, std::pmr::memory_resource* memory);

    std::uint32_t count(vox_feature feature) const noexcept {
        return feature == VOX_FEATURE_VERTEX
                   ? vertex_count
                   : static_cast<std::uint32_t>(feature == VOX_FEATURE_EDGE ? edges.size() : faces.size());
    }
    // The vertices of a feature that is not a vertex.
    const std::uint32_t* corners(vox_feature feature, std::uint32_t index) const noexcept {
        return feature == VOX_FEATURE_EDGE ? edges[index].data() : faces[index].data();
    }

    bool has_patches() const noexcept { return !patches.empty(); }
    // True if some vertex of one and some vertex of the other may meet.
    bool may_meet(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) const noexcept;

    struct Patch {
        std::uint64_t category = 1, mask = ~std::uint64_t{0};
    };

    std::uint32_t vertex_count = 0;
    Array<SurfaceEdge> edges;
    Array<SurfaceFace> faces;
    Array<std::uint32_t> patches; // of each vertex; empty: all vertices may meet
    Array<Patch> patch_filters;
};

} // namespace vox
