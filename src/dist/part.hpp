// A part of a body on this rank: its global numbers, and boxes around its tetrahedra and vertices.
#pragma once

#include "base/positions.hpp"
#include "dist/messages.hpp"

#include <optional>
#include <span>

namespace vox::dist {

inline void get(const Positions& positions, std::uint64_t vertex, double out[3]) noexcept {
    const Vec3d p = positions.exact(static_cast<std::size_t>(vertex));
    out[0] = p.x, out[1] = p.y, out[2] = p.z;
}

// Throws NON_FINITE or LIMIT for a position that vox does not allow; `name` is printf's, with the number of
// the vertex.
struct PositionName {
    const char* what; // "vertex" or "point"
    std::uint64_t id;
    std::uint64_t body;
    bool has_body;
};
void check_position(const double position[3], const PositionName& name);

// The box of points, rounded outward to floats.
void add_point(Box& box, const double position[3]) noexcept;

// As vox_filter says.
inline bool collide(std::uint64_t body_a, const Filter& a, std::uint64_t body_b, const Filter& b) noexcept {
    if (body_a == body_b) return a.self_collision != 0;
    if (a.world != b.world) return false;
    if (a.group == b.group && a.group != 0) return a.group > 0;
    return (a.category & b.mask) != 0 && (b.category & a.mask) != 0;
}

// Items in groups of near ones, each with a box. `order` lists the items of the first group, then of the
// next.
class Clusters {
public:
    explicit Clusters(Memory* memory) : order(memory), begins(memory), boxes(memory) {}
    // Of `count` points.
    template <class Point>
    void make(std::uint32_t count, std::uint32_t size, Point&& point);

    std::uint32_t size() const noexcept { return static_cast<std::uint32_t>(boxes.size()); }
    std::span<const std::uint32_t> of(std::uint32_t cluster) const noexcept {
        return {order.data() + begins[cluster], order.data() + begins[cluster + 1]};
    }

    Array<std::uint32_t> order;
    Array<std::uint64_t> begins;
    Array<Box> boxes;
};

struct Part {
    explicit Part(Memory* memory)
        : tets(memory), tet_ids(memory), tet_indices(memory), vertex_ids(memory), by_id(memory),
          owned(memory), tet_clusters(memory), vertex_clusters(memory) {}

    // The arrays of the caller, checked; tetrahedra in the order of their numbers.
    void take(const vox_dist_part_desc& desc, const vox_mesh_desc& mesh);
    // Looks at all positions: checks them, and computes the boxes.
    void look(Memory* memory);

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
    std::optional<std::uint32_t> find(std::uint64_t id) const noexcept; // a vertex

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

    Positions positions;
    bool clustered = false;
    Clusters tet_clusters;    // of vertices: all that the tetrahedra of a cluster name
    Clusters vertex_clusters; // of owned vertices
    Box tet_box, vertex_box;
};

} // namespace vox::dist
