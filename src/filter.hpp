// What never collides, as data: pairs of meshes by category, mask, group and exception; vertices and
// tetrahedra of one mesh by their distance along edges and in the rest pose.
#pragma once

#include "scene.hpp"

#include <vox/vox.h>

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

// Completes and checks a vox_filter; null: the defaults. Throws Error(INVALID_ARGUMENT), and Error(LIMIT) for
// too many rings.
vox_filter read_filter(const vox_filter* filter);
vox_filter filter_defaults() noexcept;

// Whether vertices of one of the bodies may be in tetrahedra of the other (another one).
bool collide(const Body& a, const Body& b) noexcept;

// The vertices within so many edges of each vertex.
struct Rings {
    explicit Rings(std::pmr::memory_resource* memory) noexcept : first(memory), near(memory) {}
    // Time and memory in proportion to what they hold. None for count 0.
    Rings(std::span<const Tet> tets, std::uint32_t vertex_count, std::uint32_t count,
          std::pmr::memory_resource* memory);

    // Those of v: near[first[v]] to near[first[v + 1]], ascending, v among them.
    std::pmr::vector<std::size_t> first;
    std::pmr::vector<std::uint32_t> near;
};

// The filters of self-contact.
struct SelfFilter {
    explicit SelfFilter(std::pmr::memory_resource* memory) noexcept : rings(memory), rest(memory) {}

    Rings rings;                  // empty: no such filter
    std::pmr::vector<Vec3f> rest; // positions in the rest pose, once they are known
    double rest_distance = 0;     // 0: no such filter

    // Whether a contact of `vertex` with `tet` is none: a corner of the tet is within the rings, or the
    // closed tet is closer than rest_distance in the rest pose.
    bool skips(std::uint32_t vertex, const Tet& tet) const noexcept {
        return (!rings.first.empty() && is_near(vertex, tet)) ||
               (rest_distance > 0 && rests_close(vertex, tet));
    }

private:
    bool is_near(std::uint32_t vertex, const Tet& tet) const noexcept;
    bool rests_close(std::uint32_t vertex, const Tet& tet) const noexcept;
};

} // namespace vox
