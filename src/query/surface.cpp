// Queries for the closest point of the surface, by branch and bound over the tree (N. Roussopoulos, S.
// Kelley, F. Vincent, Nearest neighbor queries, SIGMOD 1995).
#include "base/array.hpp"
#include "base/bits.hpp"
#include "base/boxes.hpp"
#include "base/vectors.hpp"
#include "exact/closest_point.hpp"
#include "exact/facet_normal.hpp"
#include "query/facets.hpp"
#include "query/weigher.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

namespace {

void write(double (&out)[3], const Vec3d& v) noexcept {
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

constexpr std::size_t least_points_to_sort = 256;
constexpr std::size_t least_leaves_to_sort = 16; // with fewer, a search costs little more than sorting

// The indices of the points along a Z-shaped curve, in the low 32 bits; none if there are few points, or if
// consecutive points are close together already.
Array<std::uint64_t> order_along_curve(std::span<const Vec3d> points, double max_distance,
                                       std::pmr::memory_resource* memory) {
    Array<std::uint64_t> order(memory);
    if (points.size() < least_points_to_sort) return order;
    Vec3d low = points[0], high = low;
    double steps = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
        low = min(low, points[i]);
        high = max(high, points[i]);
        const Vec3d step = points[i] - points[i - 1];
        steps += std::abs(step.x) + std::abs(step.y) + std::abs(step.z);
    }
    const Vec3d side = high - low;
    // Random points have steps of a third of the box on each axis. A small max_distance is as good a bound as
    // the previous point's facet.
    const double short_step = (side.x + side.y + side.z) / 16;
    if (!(steps > short_step * static_cast<double>(points.size())) || !(max_distance > short_step))
        return order;
    const double longest = std::max({side.x, side.y, side.z});
    order.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3d at = points[i] - low;
        const auto cell = [longest](double x) { return static_cast<std::uint32_t>(x / longest * 1023); };
        order.push_back(std::uint64_t{morton_code(cell(at.x), cell(at.y), cell(at.z))} << 32 | i);
    }
    std::ranges::sort(order);
    return order;
}

} // namespace

// The closest facet so far; if several are equally close, the one with the lowest key.
struct Queries::ClosestFacet {
    double squared; // distance; at first the square of max_distance
    bool any = false;
    FacetKey key{};
    SeenPoint seen{};
    std::uint32_t leaf = 0;
    std::size_t place = 0; // see PointHit

    // `least`: see visit_facets().
    void try_facet(const Vec3d& p, std::uint32_t mesh, std::uint32_t of_leaf, const LeafTets& tets,
                   std::size_t tet, std::uint32_t facet, double least) noexcept {
        const std::uint8_t* c = facet_corners[facet];
        const SeenPoint found =
            closest_seen_from(p, tets.corner(tet, c[0]), tets.corner(tet, c[1]), tets.corner(tet, c[2]));
        const double distance = std::max(found.at.squared_distance, least);
        const FacetKey its_key(mesh, tets.index(tet), facet);
        if (!(distance < squared || (distance == squared && (!any || its_key < key)))) return;
        *this = {distance, true, its_key, found, of_leaf, tet};
    }
};

void Queries::find_closest(const Vec3d& p, QueryMeshes which, ClosestFacet& closest) const noexcept {
    const auto bound = [&p](const Box3f& box) noexcept { return squared_distance_bound(p, box); };
    visit_facets(
        which, closest.squared, bound,
        [&](std::uint32_t leaf, const LeafTets& tets, std::size_t tet, std::uint32_t facet, double least) {
            closest.try_facet(p, leaves_[leaf].mesh, leaf, tets, tet, facet, least);
        });
}

template <class Answer>
void Queries::for_closest(std::span<const Vec3d> points, double max_distance, QueryMeshes which,
                          std::pmr::memory_resource* memory, Answer&& answer) const {
    const double most = max_distance * max_distance;
    // No bound is greater than the distance, so a search finds the least facet by (distance, key). Its first
    // bound, and so the order of points, changes only its cost.
    Array<std::uint64_t> order(memory);
    if (leaves_.size() >= least_leaves_to_sort) order = order_along_curve(points, max_distance, memory);
    ClosestFacet closest{.squared = most};
    const auto search = [&](std::size_t i) {
        const Vec3d& p = points[i];
        const ClosestFacet before = closest;
        closest = {.squared = most};
        if (before.any) { // the previous point's closest facet is a first bound
            const LeafTets tets = tets_of(leaves_[before.leaf]);
            closest.try_facet(p, std::get<0>(before.key), before.leaf, tets, before.place,
                              std::get<2>(before.key), squared_distance_bound(p, tets.box(before.place)));
        }
        find_closest(p, which, closest);
        answer(i, closest);
    };
    if (order.empty())
        for (std::size_t i = 0; i < points.size(); ++i) search(i);
    for (const std::uint64_t place : order) search(static_cast<std::uint32_t>(place));
}

void Queries::write_closest(const Vec3d& p, const FacetKey& key, std::uint32_t leaf, std::size_t place,
                            const SeenPoint& seen, double distance, vox_closest_hit& hit) const {
    const auto [mesh, tet, facet] = key;
    const LeafTets tets = tets_of(leaves_[leaf]);
    hit.body = meshes_[mesh].id;
    hit.tet = tet;
    hit.facet = facet;
    tets.write_face(place, facet, hit.face);
    hit.distance = distance;
    std::ranges::copy(normalised(seen.at.weight), hit.weights);
    write(hit.position, p + seen.way);
    const OrderedFacet f(tets, place, facet);
    write(hit.normal, facet_normal(tets.at(f.vertex[0]), tets.at(f.vertex[1]), tets.at(f.vertex[2]),
                                   tets.corner(place, facet), p, seen.way));
}

void Queries::closest_points(std::span<const Vec3d> points, double max_distance, QueryMeshes which,
                             std::pmr::memory_resource* memory, vox_closest_hit* hits) const {
    const auto answer = [&](std::size_t i, const ClosestFacet& closest) {
        hits[i] = {};
        if (closest.any)
            write_closest(points[i], closest.key, closest.leaf, closest.place, closest.seen,
                          std::sqrt(closest.squared), hits[i]);
    };
    for_closest(points, max_distance, which, memory, answer);
    count_inside(points, which, memory, hits);
}

void Queries::locate_outside(std::span<const Vec3d> points, double max_distance, bool extrapolate,
                             QueryMeshes which, std::pmr::memory_resource* memory, vox_location* out) const {
    Array<std::uint32_t> index(memory);
    Array<Vec3d> at(memory);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        if (out[i].state != VOX_LOCATION_NONE) continue;
        index.push_back(i);
        at.push_back(points[i]);
    }
    Weigher closest_weigher(Weigher::Of::closest), weigher(Weigher::Of::any);
    for_closest(at, max_distance, which, memory, [&](std::size_t i, const ClosestFacet& closest) {
        if (!closest.any) return;
        const auto [mesh, tet, facet] = closest.key;
        const LeafTets tets = tets_of(leaves_[closest.leaf]);
        const std::size_t t = closest.place;
        vox_location& location = out[index[i]];
        location = {meshes_[mesh].id, tet, VOX_LOCATION_OUTSIDE, 0, {}, std::sqrt(closest.squared)};
        std::uint64_t exact_tests = 0;
        if (extrapolate && orientation(tets.corner(t, 0), tets.corner(t, 1), tets.corner(t, 2),
                                       tets.corner(t, 3), exact_tests) != 0)
            return weigher.add(at[i], tets, t, location.weights);
        const auto weights = normalised(closest.seen.at.weight);
        for (std::size_t c = 0; c < 3; ++c) location.weights[facet_corners[facet][c]] = weights[c];
        closest_weigher.add(at[i], tets, t, facet, location.weights);
    });
}

} // namespace vox
