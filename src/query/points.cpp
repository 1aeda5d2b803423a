// Queries with points and boxes. Many points descend the tree together, partitioned in place at every node,
// so that each node is read once for all of them.
#include "query/queries.hpp"

#include "base/boxes.hpp"
#include "exact/predicates.hpp"
#include "query/rounding.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <tuple>

namespace vox {

namespace {

Box3f box_of(const Vec3d& p) noexcept {
    return {{rounded_down(p.x), rounded_down(p.y), rounded_down(p.z)},
            {rounded_up(p.x), rounded_up(p.y), rounded_up(p.z)}};
}

} // namespace

std::pmr::vector<Queries::PointHit> Queries::find_points(std::span<const Vec3d> points, QueryMeshes which,
                                                         std::pmr::memory_resource* memory) const {
    std::pmr::vector<std::uint32_t> indices(points.size(), memory);
    std::iota(indices.begin(), indices.end(), 0u);
    std::pmr::vector<Box3f> boxes(memory);
    boxes.reserve(points.size());
    for (const Vec3d& p : points) boxes.push_back(box_of(p));
    std::pmr::vector<PointHit> found(memory);
    if (!leaves_.empty()) find(1, indices, {points, boxes, which}, found);
    std::sort(found.begin(), found.end(), [](const PointHit& x, const PointHit& y) {
        return std::tie(x.point, x.mesh, x.tet) < std::tie(y.point, y.mesh, y.tet);
    });
    return found;
}

void Queries::points(std::span<const Vec3d> points, QueryMeshes which,
                     std::pmr::vector<vox_point_hit>& hits) const {
    const std::pmr::vector<PointHit> found = find_points(points, which, hits.get_allocator().resource());
    for (std::size_t begin = 0, end; begin < found.size(); begin = end) {
        bool any_interior = false;
        for (end = begin; end < found.size() && found[end].point == found[begin].point &&
                          found[end].mesh == found[begin].mesh;
             ++end)
            any_interior |= found[end].interior;
        // Report every tetrahedron with the point in its interior, or if there is none, the first with the
        // point on its boundary.
        for (std::size_t i = begin; i < (any_interior ? end : begin + 1); ++i) {
            if (any_interior && !found[i].interior) continue;
            const LeafTets tets = tets_of(leaves_[found[i].leaf]);
            const std::size_t t = found[i].place;
            const std::array<float, 4> w =
                barycentric(points[found[i].point], tets.corner(t, 0), tets.corner(t, 1), tets.corner(t, 2),
                            tets.corner(t, 3));
            hits.push_back(
                {found[i].point, meshes_[found[i].mesh].id, found[i].tet, {w[0], w[1], w[2], w[3]}});
        }
    }
}

// Searches below the node for the points in `which`, whose order changes.
void Queries::find(std::size_t node, std::span<std::uint32_t> which, const Points& asked,
                   std::pmr::vector<PointHit>& found) const {
    const Box3f& box = tree_.box(node);
    const auto end = std::partition(which.begin(), which.end(),
                                    [&](std::uint32_t i) { return overlap(box, asked.boxes[i]); });
    which = which.first(static_cast<std::size_t>(end - which.begin()));
    if (which.empty()) return;
    if (!tree_.is_leaf(node)) {
        find(2 * node, which, asked, found);
        find(2 * node + 1, which, asked, found);
        return;
    }
    const std::uint32_t leaf = tree_.item(node);
    if (!wants(leaves_[leaf], asked.which)) return;
    for (const std::uint32_t i : which) find_in_leaf(leaf, i, asked, found);
}

void Queries::find_in_leaf(std::uint32_t leaf, std::uint32_t point, const Points& asked,
                           std::pmr::vector<PointHit>& found) const {
    std::uint64_t exact_tests = 0;
    const Vec3d& p = asked.points[point];
    const Box3f& at = asked.boxes[point];
    const LeafTets tets = tets_of(leaves_[leaf]);
    for (std::size_t i = 0; i < tets.size(); ++i) {
        if (!overlap(tets.box(i), at)) continue;
        // A tetrahedron of zero volume never holds the point, as its corner volumes have both signs, or none.
        const Containment where = locate_in_solid(p, tets.corner(i, 0), tets.corner(i, 1), tets.corner(i, 2),
                                                  tets.corner(i, 3), exact_tests);
        if (where == Containment::interior || where == Containment::boundary)
            found.push_back({point, leaves_[leaf].mesh, tets.index(i), where == Containment::interior, leaf,
                             static_cast<std::uint32_t>(i)});
    }
}

void Queries::box(const Vec3d& min, const Vec3d& max, QueryMeshes which,
                  std::pmr::vector<vox_tet_hit>& hits) const {
    // A finite box, which meets no empty one; no vertex is beyond.
    const auto low = [](double x) { return std::max(rounded_down(x), -std::numeric_limits<float>::max()); };
    const auto high = [](double x) { return std::min(rounded_up(x), std::numeric_limits<float>::max()); };
    const Box3f around{{low(min.x), low(min.y), low(min.z)}, {high(max.x), high(max.y), high(max.z)}};
    const auto meets = [&](const LeafTets& tets, std::size_t i) { // in double
        bool below[3] = {true, true, true}, above[3] = {true, true, true};
        for (std::size_t c = 0; c < 4; ++c) {
            const Vec3d& p = tets.corner(i, c);
            below[0] &= p.x < min.x;
            below[1] &= p.y < min.y;
            below[2] &= p.z < min.z;
            above[0] &= p.x > max.x;
            above[1] &= p.y > max.y;
            above[2] &= p.z > max.z;
        }
        return !(below[0] | below[1] | below[2] | above[0] | above[1] | above[2]);
    };
    const auto visit = [&](std::uint32_t leaf) {
        if (!wants(leaves_[leaf], which)) return;
        const LeafTets tets = tets_of(leaves_[leaf]);
        for (std::size_t i = 0; i < tets.size(); ++i)
            if (overlap(tets.box(i), around) && meets(tets, i))
                hits.push_back({meshes_[leaves_[leaf].mesh].id, tets.index(i)});
    };
    tree_.visit_accepted([&](const Box3f& box) { return overlap(box, around); }, visit);
    std::sort(hits.begin(), hits.end(), [](const vox_tet_hit& x, const vox_tet_hit& y) {
        return std::tie(x.mesh, x.tet) < std::tie(y.mesh, y.tet);
    });
}

} // namespace vox
