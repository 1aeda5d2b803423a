// Category, mask and group decide as in Box2D and Box3D (E. Catto). The vertices within k edges of each are
// found by breadth-first search from tetrahedron to tetrahedron, again where the mesh is edited. They are
// kept sorted, so that a test in the step is four binary searches and allocates nothing.
#include "mesh/filter.hpp"

#include "base/error.hpp"
#include "base/room.hpp"
#include "base/structs.hpp"
#include "base/vectors.hpp"
#include "exact/closest_point.hpp"
#include "exact/predicates.hpp"
#include "mesh/tet_changes.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

vox_filter checked_filter(vox_filter filter) {
    set_default(filter.category, std::uint64_t{1});
    set_default(filter.mask, ~std::uint64_t{0});
    constexpr std::uint32_t known_flags = VOX_FILTER_SELF_COLLISION | VOX_FILTER_SENSOR;
    if (filter.flags & ~known_flags)
        refuse(format("filter flags is 0x%x, of which 0x%x is unknown", filter.flags,
                      filter.flags & ~known_flags));
    if (!(filter.self_rest_distance >= 0) || std::isinf(filter.self_rest_distance))
        refuse(format("filter self_rest_distance is %g, expected a finite number >= 0",
                      filter.self_rest_distance));
    check_limit(filter.self_rings, VOX_MAX_RINGS, "filter self_rings");
    return filter;
}

bool collide(const Body& a, const Body& b) noexcept {
    if (!collide(a.filter, b.filter)) return false;
    // Both meshes of an excepted pair list each other: the shorter list is searched.
    const bool a_is_shorter = a.exceptions.size() < b.exceptions.size();
    const std::span<const std::uint32_t> exceptions = a_is_shorter ? a.exceptions : b.exceptions;
    return !std::binary_search(exceptions.begin(), exceptions.end(), a_is_shorter ? b.mesh_id : a.mesh_id);
}

Rings::Rings(std::span<const Tet> tets, std::uint32_t vertex_count, std::uint32_t count,
             std::pmr::memory_resource* memory)
    : Rings(memory) {
    if (count == 0 || vertex_count == 0) return;
    IndexLists tets_of(memory);
    tets_of.list_by_vertex(static_cast<std::uint32_t>(tets.size()), vertex_count,
                           [&](std::uint32_t t) { return std::span<const std::uint32_t>(tets[t].v); });
    reached_from.resize(vertex_count, 0);
    Array<std::uint32_t> found(memory);
    near.reserve(vertex_count);
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        search(tets, tets_of, v, count, found);
        near.begin_list();
        for (const std::uint32_t w : found) near.push(w);
    }
}

// Breadth first; the queue is what is found.
void Rings::search(std::span<const Tet> tets, const IndexLists& tets_of, std::uint32_t vertex,
                   std::uint32_t count, Array<std::uint32_t>& found) {
    if (++searches == 0) { // after 2^32 of them
        std::fill(reached_from.begin(), reached_from.end(), 0u);
        searches = 1;
    }
    found.assign(1, vertex);
    reached_from[vertex] = searches;
    std::size_t begin = 0;
    for (std::uint32_t ring = 0; ring < count; ++ring) {
        const std::size_t end = found.size();
        for (; begin < end; ++begin) {
            const std::uint32_t at = found[begin];
            for (const std::uint32_t t : tets_of[at])
                for (const std::uint32_t corner : tets[t].v) {
                    if (reached_from[corner] == searches) continue;
                    reached_from[corner] = searches;
                    found.push_back(corner);
                }
        }
    }
    std::sort(found.begin(), found.end());
}

void Rings::add_vertices(std::size_t vertex_count) {
    for (std::size_t v = near.size(); v < vertex_count; ++v) {
        near.resize(v + 1);
        near.add(v, static_cast<std::uint32_t>(v));
    }
    reached_from.resize(vertex_count, 0);
}

// Where an edge came or went, its ends are among the changed vertices: others are near it if they are, or
// were, near those.
void Rings::repair(std::span<const Tet> tets, const IndexLists& tets_of, std::span<const TetChange> changes,
                   std::uint32_t count) {
    std::pmr::memory_resource* memory = near.memory();
    Array<std::uint32_t> changed(memory), affected(memory), found(memory);
    list_changed_vertices(changes, changed);
    for (const std::uint32_t v : changed) {
        const std::span<const std::uint32_t> was = near[v];
        affected.insert(affected.end(), was.begin(), was.end());
        search(tets, tets_of, v, count, found);
        affected.insert(affected.end(), found.begin(), found.end());
    }
    std::sort(affected.begin(), affected.end());
    affected.erase(std::unique(affected.begin(), affected.end()), affected.end());
    for (const std::uint32_t v : affected) {
        search(tets, tets_of, v, count, found);
        near.assign(v, found);
    }
}

RestPose::RestPose(const Positions& positions, std::uint32_t count, std::pmr::memory_resource* memory)
    : RestPose(memory) {
    const auto is_float = [&](std::uint32_t v) {
        const Vec3d p = positions.exact(v), rounded = positions[v];
        return p.x == rounded.x && p.y == rounded.y && p.z == rounded.z;
    };
    for (std::uint32_t v = 0; positions.rounded() && v < count && !in_doubles_; ++v)
        in_doubles_ = !is_float(v);
    if (in_doubles_)
        doubles_.reserve(count);
    else
        floats_.reserve(count);
    for (std::uint32_t v = 0; v < count; ++v) push(positions.exact(v));
}

void RestPose::push(const Vec3d& p) {
    if (in_doubles_)
        doubles_.push_back(p);
    else
        floats_.push_back(nearest_floats(p));
}

RestPose RestPose::of(std::span<const std::uint32_t> vertices) const {
    RestPose some(floats_.memory());
    some.in_doubles_ = in_doubles_;
    for (const std::uint32_t v : vertices) some.push((*this)[v]);
    return some;
}

void RestPose::reserve_for(const RestPose& more) {
    const std::size_t count = size() + more.size();
    if (!in_doubles_ && !more.in_doubles_) return reserve_growing(floats_, count);
    reserve_growing(doubles_, count);
    if (in_doubles_) return;
    doubles_.assign(floats_.begin(), floats_.end());
    floats_ = Array<Vec3f>(floats_.memory());
    in_doubles_ = true;
}

void RestPose::append(const RestPose& more) noexcept {
    for (std::size_t v = 0; v < more.size(); ++v) push(more[v]);
}

bool SelfFilter::is_near(std::uint32_t vertex, const Tet& tet) const noexcept {
    const std::span<const std::uint32_t> near = rings.near[vertex];
    return std::any_of(tet.v, tet.v + 4, [=](std::uint32_t corner) {
        return std::binary_search(near.begin(), near.end(), corner);
    });
}

bool SelfFilter::rests_close(std::uint32_t vertex, const Tet& tet) const noexcept {
    const Vec3d p = rest[vertex];
    const Vec3d corner[4] = {rest[tet.v[0]], rest[tet.v[1]], rest[tet.v[2]], rest[tet.v[3]]};
    for (int i = 0; i < 4; ++i) {
        const Vec3d &a = corner[(i + 1) % 4], &b = corner[(i + 2) % 4], &c = corner[(i + 3) % 4];
        if (std::sqrt(closest_on_triangle(p, a, b, c).squared_distance) < rest_distance) return true;
    }
    std::uint64_t exact_tests = 0;
    return locate(p, corner[0], corner[1], corner[2], corner[3], exact_tests) == Containment::interior;
}

} // namespace vox
