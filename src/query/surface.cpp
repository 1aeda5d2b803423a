// Queries for the closest point of the surface, and for what a segment meets first, by branch and bound over
// the tree (N. Roussopoulos, S. Kelley, F. Vincent, Nearest neighbor queries, SIGMOD 1995). Whether a segment
// meets a facet is decided exactly, by the sides of the facet on which its ends are, and the sides of the
// segment on which the edges of the facet are.
#include "query/queries.hpp"

#include "base/vectors.hpp"
#include "exact/closest_point.hpp"
#include "exact/predicates.hpp"
#include "query/box_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace vox {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// What is computed of boxes is off by a few roundings, in proportion by less than this.
constexpr double slack = 0x1p-48;

double volume(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) noexcept {
    const Vec3d u = b - a, v = c - a, w = d - a;
    return dot(cross(u, v), w);
}

// Where a segment meets a closed triangle. `t` runs from 0 at its beginning to 1 at its end, and is rounded.
struct Crossing {
    double t = infinity; // infinite when it does not
    double weight[3] = {};
    int from_side = 0, to_side = 0; // the ends' orientation() to the triangle
};

Crossing find_crossing(const Vec3d& from, const Vec3d& to, const Vec3d& a, const Vec3d& b,
                       const Vec3d& c) noexcept {
    std::uint64_t exact_tests = 0;
    Crossing crossing;
    crossing.from_side = orientation(a, b, c, from, exact_tests);
    crossing.to_side = orientation(a, b, c, to, exact_tests);
    if (crossing.from_side == crossing.to_side) return crossing; // both ends on one side, or in its plane
    const Vec3d* const corner[3] = {&a, &b, &c};
    bool positive = false, negative = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const int side = orientation(from, to, *corner[(i + 1) % 3], *corner[(i + 2) % 3], exact_tests);
        positive |= side > 0;
        negative |= side < 0;
    }
    if (positive && negative) return crossing;
    const double before = std::abs(volume(a, b, c, from)), after = std::abs(volume(a, b, c, to));
    if (crossing.from_side == 0)
        crossing.t = 0;
    else if (crossing.to_side == 0)
        crossing.t = 1;
    else
        crossing.t = before + after > 0 ? before / (before + after) : 0.5;
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        crossing.weight[i] = std::abs(volume(from, to, *corner[(i + 1) % 3], *corner[(i + 2) % 3]));
        sum += crossing.weight[i];
    }
    for (double& weight : crossing.weight) weight = sum > 0 ? weight / sum : 1.0 / 3;
    return crossing;
}

// A lower bound of the t at which a segment enters a box, infinite when the segment misses the box.
class EntryBound {
public:
    EntryBound(const Vec3d& from, const Vec3d& to) noexcept : from_{from.x, from.y, from.z} {
        const double way[3] = {to.x - from.x, to.y - from.y, to.z - from.z};
        for (int axis = 0; axis < 3; ++axis) inverse_[axis] = way[axis] == 0 ? 0 : 1 / way[axis];
    }

    double operator()(const Box3f& box) const noexcept {
        const float lo[3] = {box.min.x, box.min.y, box.min.z}, hi[3] = {box.max.x, box.max.y, box.max.z};
        double enter = 0, leave = 1;
        for (int axis = 0; axis < 3; ++axis) {
            if (lo[axis] > hi[axis]) return infinity;
            if (inverse_[axis] == 0) { // the segment does not move along this axis
                if (from_[axis] < double{lo[axis]} || from_[axis] > double{hi[axis]}) return infinity;
                continue;
            }
            double t0 = (double{lo[axis]} - from_[axis]) * inverse_[axis];
            double t1 = (double{hi[axis]} - from_[axis]) * inverse_[axis];
            if (t0 > t1) std::swap(t0, t1);
            // A NaN (0 times infinity) leaves both as they are.
            enter = std::max(enter, t0 - std::abs(t0) * slack);
            leave = std::min(leave, t1 + std::abs(t1) * slack);
        }
        return enter <= leave ? enter : infinity;
    }

private:
    double from_[3], inverse_[3];
};

// The corners of facet i of a tetrahedron in ascending order, so that the tetrahedra on both sides of a facet
// compute the same. `place` is the index of each in facet_corners.
struct OrderedFacet {
    std::uint32_t vertex[3];
    std::size_t place[3] = {0, 1, 2};

    OrderedFacet(const std::uint32_t* corner, std::size_t i) noexcept {
        for (std::size_t c = 0; c < 3; ++c) vertex[c] = corner[facet_corners[i][c]];
        const auto order = [this](std::size_t x, std::size_t y) {
            if (vertex[x] <= vertex[y]) return;
            std::swap(vertex[x], vertex[y]);
            std::swap(place[x], place[y]);
        };
        order(0, 1);
        order(1, 2);
        order(0, 1);
    }
};

} // namespace

// Calls visit(mesh, tetrahedron, facet) for each facet of a surface whose tetrahedron's bound is no more than
// `most`, as visit_nearest_first() does.
template <class Bound, class Visit>
void Queries::visit_facets(std::uint64_t mask, const double& most, const Bound& bound,
                           Visit&& visit) const noexcept {
    visit_nearest_first(surface_tree_, most, bound, [&](std::size_t l) {
        const Leaf& leaf = leaves_[l];
        if (!wants(leaf, mask)) return;
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
            const Tetrahedron& t = tetrahedra_[i];
            if (t.facets == 0 || !(bound(boxes_[i]) <= most)) continue;
            for (std::size_t facet = 0; facet < 4; ++facet)
                if (t.facets >> facet & 1) visit(leaf.mesh, t, facet);
        }
    });
}

vox_surface_hit Queries::closest(const Vec3d& p, double radius, std::uint64_t mask) const noexcept {
    double most = radius * radius;
    SeenPoint best{};
    std::tuple<std::uint32_t, std::uint32_t, std::size_t> best_key; // mesh, tet, facet
    bool any = false;
    const auto bound = [&p](const Box3f& box) noexcept { return squared_distance_bound(p, box); };
    visit_facets(mask, most, bound, [&](std::uint32_t mesh, const Tetrahedron& t, std::size_t facet) {
        const std::uint8_t* c = facet_corners[facet];
        const SeenPoint found = closest_seen_from(p, corner(t, c[0]), corner(t, c[1]), corner(t, c[2]));
        const double squared = found.at.squared_distance;
        const std::tuple key(mesh, t.index, facet);
        if (!(squared < most || (squared == most && (!any || key < best_key)))) return;
        most = squared;
        best = found;
        best_key = key;
        any = true;
    });
    vox_surface_hit hit{};
    if (!any) return hit;
    const auto [mesh, tet, facet] = best_key;
    hit.mesh = meshes_[mesh].id;
    hit.tet = tet;
    hit.facet = static_cast<std::uint32_t>(facet);
    hit.distance = std::sqrt(best.at.squared_distance);
    for (std::size_t c = 0; c < 3; ++c) hit.barycentric[c] = best.at.weight[c];
    const Vec3d at = p + best.way;
    hit.position[0] = at.x;
    hit.position[1] = at.y;
    hit.position[2] = at.z;
    return hit;
}

vox_ray_hit Queries::ray(const Vec3d& from, const Vec3d& to, std::uint64_t mask) const noexcept {
    vox_ray_hit hit{};
    find_first_tet(from, to, mask, hit);
    if (hit.mesh) find_first_facet(from, to, mask, hit); // whatever meets a surface meets a tetrahedron
    return hit;
}

void Queries::find_first_tet(const Vec3d& from, const Vec3d& to, std::uint64_t mask,
                             vox_ray_hit& hit) const noexcept {
    const EntryBound bound(from, to);
    double most = 1;
    std::pair<std::uint32_t, std::uint32_t> best; // mesh, tet
    bool any = false;
    visit_nearest_first(tree_, most, bound, [&](std::size_t l) {
        const Leaf& leaf = leaves_[l];
        if (!wants(leaf, mask)) return;
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
            if (!(bound(boxes_[i]) <= most)) continue;
            const Tetrahedron& tet = tetrahedra_[i];
            std::uint64_t exact_tests = 0;
            const Containment where = locate_in_solid(from, corner(tet, 0), corner(tet, 1), corner(tet, 2),
                                                      corner(tet, 3), exact_tests);
            const bool holds = where == Containment::interior || where == Containment::boundary;
            double t = holds ? 0 : infinity;
            for (std::size_t facet = 0; facet < 4 && t > 0; ++facet) {
                const OrderedFacet f(tet.corner, facet);
                t = std::min(t, find_crossing(from, to, vertices_[f.vertex[0]], vertices_[f.vertex[1]],
                                              vertices_[f.vertex[2]])
                                    .t);
            }
            const std::pair key(leaf.mesh, tet.index);
            if (!(t < most || (t == most && (!any || key < best)))) continue;
            if (!holds &&
                orientation(corner(tet, 0), corner(tet, 1), corner(tet, 2), corner(tet, 3), exact_tests) == 0)
                continue; // it has zero volume and holds nothing
            most = t;
            best = key;
            any = true;
        }
    });
    if (!any) return;
    hit.mesh = meshes_[best.first].id;
    hit.tet = best.second;
    hit.t = most;
}

void Queries::find_first_facet(const Vec3d& from, const Vec3d& to, std::uint64_t mask,
                               vox_ray_hit& hit) const noexcept {
    const EntryBound bound(from, to);
    double most = 1;
    std::tuple<std::uint32_t, std::uint32_t, std::size_t> best; // mesh, tet, facet
    bool any = false;
    visit_facets(mask, most, bound, [&](std::uint32_t mesh, const Tetrahedron& tet, std::size_t facet) {
        const OrderedFacet f(tet.corner, facet);
        const Vec3d &a = vertices_[f.vertex[0]], &b = vertices_[f.vertex[1]], &c = vertices_[f.vertex[2]];
        const Crossing crossing = find_crossing(from, to, a, b, c);
        const std::tuple key(mesh, tet.index, facet);
        if (!(crossing.t < most || (crossing.t == most && (!any || key < best)))) return;
        most = crossing.t;
        best = key;
        any = true;
        for (std::size_t n = 0; n < 3; ++n) hit.surface_barycentric[f.place[n]] = crossing.weight[n];
        std::uint64_t exact_tests = 0;
        const int inside = orientation(a, b, c, corner(tet, facet), exact_tests); // 0 without volume
        const bool enters =
            crossing.to_side != 0 ? crossing.to_side == inside : crossing.from_side == -inside;
        hit.surface_side = inside == 0 ? VOX_SIDE_NONE : enters ? VOX_SIDE_ENTERS : VOX_SIDE_LEAVES;
    });
    if (!any) return;
    const auto [mesh, tet, facet] = best;
    hit.surface_mesh = meshes_[mesh].id;
    hit.surface_tet = tet;
    hit.surface_facet = static_cast<std::uint32_t>(facet);
    hit.surface_t = most;
}

} // namespace vox
