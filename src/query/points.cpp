// Queries with points and boxes. A few points descend the tree together, partitioned in place at every node,
// so that each node is read once. Many points are treated like the vertices in a step of the fast engine
// (docs/engine.md): they are sorted into windows, and each tile is tested against those in its box, which
// takes a fifth of the time.
#include "base/array.hpp"
#include "query/batch.hpp"

#include "base/boxes.hpp"
#include "base/rounding.hpp"
#include "exact/predicates.hpp"
#include "query/weigher.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace vox {

namespace {

// The least number of points for windows, and the most tiles a point.
constexpr std::size_t least_batch = 64, most_tiles_a_point = 4;
// Points handled at a time, so that their buffers stay in the cache; at least so many a tile, as a tile takes
// as long to prepare as some points.
constexpr std::size_t points_at_once = 65536, points_a_tile = 16;

} // namespace

void Queries::find_few(std::span<const Vec3d> points, QueryMeshes which, std::pmr::memory_resource* memory,
                       Array<PointHit>& found) const {
    Array<std::uint32_t> indices(points.size(), memory);
    std::iota(indices.begin(), indices.end(), 0u);
    Array<Box3f> boxes(memory);
    boxes.reserve(points.size());
    for (const Vec3d& p : points) boxes.push_back(rounded_box(p));
    if (!leaves_.empty()) find(1, indices, {points, boxes, which}, found);
}

// Sorts hits by (point, mesh, tet), by a counting sort over the points.
void Queries::sort_found(Array<PointHit>& found, std::size_t points) {
    const auto before = [](const PointHit& x, const PointHit& y) {
        return std::tie(x.point, x.mesh, x.tet) < std::tie(y.point, y.mesh, y.tet);
    };
    constexpr std::size_t few = 16;
    if (found.size() <= few) {
        std::sort(found.begin(), found.end(), before);
        return;
    }
    std::pmr::memory_resource* const memory = found.memory();
    Array<std::uint32_t> end(points + 1, 0u, memory); // each point's, after sorting
    for (const PointHit& hit : found) ++end[hit.point + 1];
    std::partial_sum(end.begin(), end.end(), end.begin());
    Array<PointHit> sorted(found.size(), memory);
    for (const PointHit& hit : found) sorted[end[hit.point]++] = hit;
    for (std::size_t p = 0, begin = 0; p < points; begin = end[p++])
        if (end[p] - begin > 1) std::sort(sorted.data() + begin, sorted.data() + end[p], before);
    found.swap(sorted);
}

template <class Visit>
void Queries::for_found(std::span<const Vec3d> points, QueryMeshes which, std::pmr::memory_resource* memory,
                        Visit&& visit) const {
    Array<PointHit> found(memory);
    const auto visit_all = [&](std::span<const Vec3d> some, std::size_t first) {
        sort_found(found, some.size());
        for (std::size_t begin = 0, end; begin < found.size(); begin = end) {
            for (end = begin + 1; end < found.size() && found[end].point == found[begin].point &&
                                  found[end].mesh == found[begin].mesh;)
                ++end;
            visit(first + found[begin].point, std::span(found).subspan(begin, end - begin));
        }
    };
    if (points.size() < least_batch || points.size() * most_tiles_a_point < leaves_.size()) {
        find_few(points, which, memory, found);
        return visit_all(points, 0);
    }
    Batch batch(*this, which, memory, found);
    const std::size_t at_once = std::max(points_at_once, points_a_tile * leaves_.size());
    for (std::size_t first = 0; first < points.size(); first += at_once) {
        const std::span<const Vec3d> some = points.subspan(first, std::min(at_once, points.size() - first));
        found.clear();
        batch.find(some);
        visit_all(some, first);
    }
}

void Queries::find_all(std::span<const Vec3d> points, QueryMeshes which, std::pmr::memory_resource* memory,
                       Array<PointHit>& hits) const {
    for_found(points, which, memory, [&](std::size_t point, std::span<const PointHit> found) {
        for (PointHit hit : found) {
            hit.point = static_cast<std::uint32_t>(point);
            hits.push_back(hit);
        }
    });
}

void Queries::points(std::span<const Vec3d> points, QueryMeshes which, std::pmr::memory_resource* memory,
                     HitList<vox_point_hit>& hits) const {
    Weigher weigher(Weigher::Of::inside);
    for_found(points, which, memory, [&](std::size_t point, std::span<const PointHit> found) {
        const bool any_interior =
            std::any_of(found.begin(), found.end(), [](const PointHit& hit) { return hit.interior; });
        // Report the tetrahedra with the point in their interior; if there are none, the first with the point
        // on its boundary.
        for (const PointHit& hit : any_interior ? found : found.first(1)) {
            if (any_interior && !hit.interior) continue;
            vox_point_hit* const out = hits.add();
            if (!out) continue; // no room
            *out = {static_cast<std::uint32_t>(point), meshes_[hit.mesh].id, hit.tet, 0, {}};
            weigher.add(points[point], tets_of(leaves_[hit.leaf]), hit.place, out->weights);
        }
    });
}

void Queries::locations(std::span<const Vec3d> points, double max_distance, bool extrapolate,
                        QueryMeshes which, std::pmr::memory_resource* memory, vox_location* out) const {
    std::fill_n(out, points.size(), vox_location{});
    std::size_t located = 0;
    {
        Weigher weigher(Weigher::Of::inside);
        for_found(points, which, memory, [&](std::size_t point, std::span<const PointHit> found) {
            vox_location& location = out[point];
            if (location.state != VOX_LOCATION_NONE) return; // in a lower body
            const auto interior =
                std::find_if(found.begin(), found.end(), [](const PointHit& hit) { return hit.interior; });
            const PointHit& hit = interior != found.end() ? *interior : found[0];
            location = {meshes_[hit.mesh].id, hit.tet, VOX_LOCATION_INSIDE, 0, {}, 0};
            weigher.add(points[point], tets_of(leaves_[hit.leaf]), hit.place, location.weights);
            ++located;
        });
    }
    if (located < points.size()) locate_outside(points, max_distance, extrapolate, which, memory, out);
}

void Queries::count_inside(std::span<const Vec3d> points, QueryMeshes which,
                           std::pmr::memory_resource* memory, vox_closest_hit* hits) const {
    for_found(points, which, memory, [&](std::size_t point, std::span<const PointHit> found) {
        vox_closest_hit& hit = hits[point];
        ++hit.inside;
        if (hit.body == meshes_[found[0].mesh].id && hit.distance > 0) hit.distance = -hit.distance;
    });
}

// Searches below the node for the points in `which`, and changes their order.
void Queries::find(std::size_t node, std::span<std::uint32_t> which, const Points& asked,
                   Array<PointHit>& found) const {
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
                           Array<PointHit>& found) const {
    std::uint64_t exact_tests = 0;
    const Vec3d& p = asked.points[point];
    const Box3f& at = asked.boxes[point];
    const LeafTets tets = tets_of(leaves_[leaf]);
    for (std::size_t i = 0; i < tets.size(); ++i) {
        if (!overlap(tets.box(i), at)) continue;
        // A tetrahedron of zero volume contains no point: its corner volumes have both signs, or none.
        const Containment where = locate_in_solid(p, tets.corner(i, 0), tets.corner(i, 1), tets.corner(i, 2),
                                                  tets.corner(i, 3), exact_tests);
        if (where == Containment::interior || where == Containment::boundary)
            found.push_back({point, leaves_[leaf].mesh, tets.index(i), where == Containment::interior, leaf,
                             static_cast<std::uint32_t>(i)});
    }
}

void Queries::box(const Vec3d& min, const Vec3d& max, QueryMeshes which, Array<vox_box_hit>& hits) const {
    // Made finite, so that it meets no empty box; all vertices are finite.
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
                hits.push_back({0, meshes_[leaves_[leaf].mesh].id, tets.index(i)});
    };
    tree_.visit_accepted([&](const Box3f& box) { return overlap(box, around); }, visit);
    std::sort(hits.begin(), hits.end(), [](const vox_box_hit& x, const vox_box_hit& y) {
        return std::tie(x.body, x.tet) < std::tie(y.body, y.tet);
    });
}

} // namespace vox
