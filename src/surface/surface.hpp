// A surface: vertices, edges and faces without tetrahedra, and the motion that it is asked about (vox_pairs.h).
#pragma once

#include "base/scene.hpp"

#include <vox/vox_pairs.h>

#include <array>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

using SurfaceEdge = std::array<std::uint32_t, 2>;
using SurfaceFace = std::array<std::uint32_t, 3>;

// Every vertex moves from one position to another along a straight line, at constant speed. Boxes reach
// further by `radius`, outward to the next number of the caller's format.
struct SurfaceMotion {
    std::span<const Vec3d> from, to; // the same span where everything stands still
    double radius = 0;
    bool doubles = false; // the caller's format; else every coordinate is a float
    bool cull = false;    // leave out pairs that stay further apart than 2 * radius
};

// The partners of a range of features: those of feature first + i are partners[offsets[i], offsets[i + 1]).
struct FeaturePairs {
    explicit FeaturePairs(std::pmr::memory_resource* memory) noexcept : offsets(memory), partners(memory) {}

    std::uint64_t first = 0, count = 0;
    std::pmr::vector<std::uint64_t> offsets;
    std::pmr::vector<std::uint32_t> partners;
};

} // namespace vox
