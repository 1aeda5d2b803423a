// A part of a body on this rank: its global numbers, and boxes around its tetrahedra and vertices.
#pragma once

#include "base/positions.hpp"
#include "dist/clusters.hpp"
#include "dist/messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace vox::dist {

// Throws NON_FINITE or LIMIT for a position that vox does not allow; name() is what the message calls it.
template <class Name>
void check_position(const Vec3d& p, Name&& name) {
    const double numbers[3] = {p.x, p.y, p.z};
    for (int axis = 0; axis < 3; ++axis) {
        const double number = numbers[axis];
        if (!std::isfinite(number))
            throw Error(VOX_ERROR_NON_FINITE, name() + format(" has coordinate %g on axis %d", number, axis));
        if (!(std::abs(number) < 0x1.ffffffp127))
            throw Error(VOX_ERROR_LIMIT,
                        name() +
                            format(" has coordinate %g on axis %d, expected less than 2^128 - 2^103 in size",
                                   number, axis));
    }
}

// Facets are matched by their vertices in ascending order.
inline std::array<std::uint32_t, 3> sorted_facet(const std::uint32_t* tet, std::size_t facet) noexcept {
    const auto& corners = facet_corners[facet];
    std::array<std::uint32_t, 3> v{tet[corners[0]], tet[corners[1]], tet[corners[2]]};
    std::ranges::sort(v);
    return v;
}

struct Part {
    explicit Part(Memory* memory)
        : tets(memory), tet_ids(memory), tet_indices(memory), vertex_ids(memory), by_id(memory),
          owned(memory), facets(memory), tet_clusters(memory), vertex_clusters(memory) {}

    // Checks and copies the caller's arrays; sorts tetrahedra by their numbers.
    void take(const vox_dist_part_desc& desc, const vox_mesh_desc& mesh);
    // Checks all positions and computes the boxes.
    void read_positions(Memory* memory);

    std::uint64_t id_of(std::uint32_t vertex) const noexcept {
        return vertex_ids.empty() ? vertex : vertex_ids[vertex];
    }
    std::uint64_t id_of_tet(std::uint32_t sorted) const noexcept {
        return tet_ids.empty() ? sorted : tet_ids[sorted];
    }
    std::uint32_t index_of_tet(std::uint32_t sorted) const noexcept {
        return tet_indices.empty() ? sorted : tet_indices[sorted];
    }
    bool owns(std::uint32_t vertex) const noexcept { return owned.empty() || owned[vertex] != 0; }
    // The vertex with that number.
    std::optional<std::uint32_t> find(std::uint64_t id) const noexcept;

    Vec3d corner(std::size_t tet, std::size_t c) const noexcept { return positions.exact(tets[4 * tet + c]); }

    void make_clusters(Memory* memory);
    // Finds `facets`, the first time.
    void find_facets(Memory* memory);

    vox_body mesh = VOX_NULL_BODY; // in the grid that finds contacts
    std::uint64_t body = 0;
    Filter filter;
    std::uint32_t vertex_count = 0, tet_count = 0;
    Array<std::uint32_t> tets;
    Array<std::uint64_t> tet_ids;     // ascending; empty: 0, 1, 2, ...
    Array<std::uint32_t> tet_indices; // the caller's
    Array<std::uint64_t> vertex_ids;  // empty: 0, 1, 2, ...
    Array<std::uint32_t> by_id;       // vertices in the order of their numbers
    Array<std::uint8_t> owned;        // empty: all

    // 4 * tetrahedron + facet for each facet of one tetrahedron only, or of doubled ones: the surface of the
    // part, which a mesh of its own would have (vox_closest_hit).
    Array<std::uint32_t> facets;

    Positions positions;
    bool clustered = false, has_facets = false;
    Clusters tet_clusters;    // near tetrahedra; the items are their vertices
    Clusters vertex_clusters; // near owned vertices
    Box3f tet_box, vertex_box;
};

} // namespace vox::dist
