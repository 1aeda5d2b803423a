// Category, mask and group decide as in Box2D and Box3D (E. Catto). The vertices within k edges of each are
// found once, by breadth-first search from tetrahedron to tetrahedron, and kept sorted, so that a test in the
// step is four binary searches and allocates nothing.
#include "filter.hpp"

#include "closest_point.hpp"
#include "depth/vectors.hpp"
#include "error.hpp"
#include "predicates.hpp"
#include "structs.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

vox_filter filter_defaults() noexcept {
    vox_filter filter{};
    filter.struct_size = sizeof filter;
    filter.category = 1;
    filter.mask = ~std::uint64_t{0};
    return filter;
}

vox_filter read_filter(const vox_filter* given) {
    if (!given) return filter_defaults();
    vox_filter filter = read_struct(given, filter_defaults(), "filter");
    filter.struct_size = sizeof filter;
    if (filter.self_collision > 1)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("filter self_collision is %u, expected 0 or 1", filter.self_collision));
    if (!(filter.self_rest_distance >= 0) || std::isinf(filter.self_rest_distance))
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("filter self_rest_distance is %g, expected a finite number >= 0",
                           filter.self_rest_distance));
    if (filter.self_rings > VOX_MAX_RINGS)
        throw Error(VOX_ERROR_LIMIT,
                    format("filter self_rings is %u, the limit is %u", filter.self_rings, VOX_MAX_RINGS));
    return filter;
}

bool collide(const Body& a, const Body& b) noexcept {
    const PairFilter &f = a.filter, &g = b.filter;
    if (f.group != 0 && f.group == g.group) {
        if (f.group < 0) return false;
    } else if ((f.category & g.mask) == 0 || (g.category & f.mask) == 0) {
        return false;
    }
    // Each of an excepted pair knows of the other: the shorter list tells.
    const bool a_is_shorter = a.exceptions.size() < b.exceptions.size();
    const std::span<const std::uint32_t> exceptions = a_is_shorter ? a.exceptions : b.exceptions;
    return !std::binary_search(exceptions.begin(), exceptions.end(), a_is_shorter ? b.mesh_id : a.mesh_id);
}

Rings::Rings(std::span<const Tet> tets, std::uint32_t vertex_count, std::uint32_t count,
             std::pmr::memory_resource* memory)
    : Rings(memory) {
    if (count == 0 || vertex_count == 0) return;

    // The tetrahedra of each vertex: counted, summed, placed.
    std::pmr::vector<std::size_t> first_tet(std::size_t{vertex_count} + 2, 0, memory);
    for (const Tet& tet : tets)
        for (const std::uint32_t v : tet.v) ++first_tet[v + 2];
    for (std::size_t v = 2; v < first_tet.size(); ++v) first_tet[v] += first_tet[v - 1];
    std::pmr::vector<std::uint32_t> tets_of(4 * tets.size(), memory);
    for (std::uint32_t t = 0; t < tets.size(); ++t)
        for (const std::uint32_t v : tets[t].v) tets_of[first_tet[v + 1]++] = t;

    std::pmr::vector<std::uint32_t> reached_from(vertex_count, ~0u, memory);
    first.reserve(std::size_t{vertex_count} + 1);
    first.push_back(0);
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        // The queue of the search is what it finds.
        const std::size_t found = near.size();
        near.push_back(v);
        reached_from[v] = v;
        std::size_t begin = found;
        for (std::uint32_t ring = 0; ring < count; ++ring) {
            const std::size_t end = near.size();
            for (; begin < end; ++begin) {
                const std::uint32_t at = near[begin];
                for (std::size_t i = first_tet[at]; i < first_tet[at + 1]; ++i)
                    for (const std::uint32_t corner : tets[tets_of[i]].v) {
                        if (reached_from[corner] == v) continue;
                        reached_from[corner] = v;
                        near.push_back(corner);
                    }
            }
        }
        std::sort(near.begin() + static_cast<std::ptrdiff_t>(found), near.end());
        first.push_back(near.size());
    }
}

bool SelfFilter::is_near(std::uint32_t vertex, const Tet& tet) const noexcept {
    const std::uint32_t* begin = rings.near.data() + rings.first[vertex];
    const std::uint32_t* end = rings.near.data() + rings.first[vertex + 1];
    return std::any_of(tet.v, tet.v + 4,
                       [=](std::uint32_t corner) { return std::binary_search(begin, end, corner); });
}

bool SelfFilter::rests_close(std::uint32_t vertex, const Tet& tet) const noexcept {
    const Vec3f& p = rest[vertex];
    const Vec3f corner[4] = {rest[tet.v[0]], rest[tet.v[1]], rest[tet.v[2]], rest[tet.v[3]]};
    for (int i = 0; i < 4; ++i) {
        const Vec3d a = depth::vec(corner[(i + 1) % 4]), b = depth::vec(corner[(i + 2) % 4]),
                    c = depth::vec(corner[(i + 3) % 4]);
        if (std::sqrt(closest_on_triangle(depth::vec(p), a, b, c).squared_distance) < rest_distance)
            return true;
    }
    std::uint64_t exact_tests = 0;
    return locate(p, corner[0], corner[1], corner[2], corner[3], exact_tests) == Containment::interior;
}

} // namespace vox
