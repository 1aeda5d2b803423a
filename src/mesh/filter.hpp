// What never collides, as data: pairs of meshes by category, mask, group and exception; vertices and
// tetrahedra of one mesh by their distance along edges and in the rest pose.
#pragma once

#include "base/lists.hpp"
#include "base/scene.hpp"
#include "mesh/tet_changes.hpp"

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
    explicit Rings(std::pmr::memory_resource* memory) noexcept : near(memory), reached_from(memory) {}
    // Time and memory in proportion to what they hold. None for count 0.
    Rings(std::span<const Tet> tets, std::uint32_t vertex_count, std::uint32_t count,
          std::pmr::memory_resource* memory);

    // Follows changes of the mesh, which is `tets` now, around each vertex `tets_of` it. Throws what the memory
    // throws, and is to be made anew then.
    void repair(std::span<const Tet> tets, const IndexLists& tets_of, std::span<const TetChange> changes,
                std::uint32_t count);

    // More of them, at the end, that no tetrahedron names. Throws as repair().
    void add_vertices(std::size_t vertex_count);

    IndexLists near; // of each vertex: ascending, itself among them

private:
    void search(std::span<const Tet> tets, const IndexLists& tets_of, std::uint32_t vertex, std::uint32_t count,
                std::pmr::vector<std::uint32_t>& found);

    std::pmr::vector<std::uint32_t> reached_from; // of each vertex, the last search that met it
    std::uint32_t searches = 0;
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
        return (!rings.near.empty() && is_near(vertex, tet)) ||
               (rest_distance > 0 && rests_close(vertex, tet));
    }

private:
    bool is_near(std::uint32_t vertex, const Tet& tet) const noexcept;
    bool rests_close(std::uint32_t vertex, const Tet& tet) const noexcept;
};

} // namespace vox
