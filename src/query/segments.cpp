// Queries for the closest points of a segment and the surface, by branch and bound over the tree, as for
// points (surface.cpp). Whether the segment meets the surface is decided exactly.
#include "base/array.hpp"
#include "base/vectors.hpp"
#include "exact/closest_point.hpp"
#include "exact/crossing.hpp"
#include "exact/facet_normal.hpp"
#include "query/facets.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

namespace {

// Lower bounds of the squared distance from a segment to boxes. That of the point at t is a convex function,
// so its tangents are bounds; each tangent also tells on which side of its t the least value is.
class SegmentBound {
public:
    SegmentBound(const Vec3d& from, const Vec3d& to)
        : from_(from), way_(to - from), low_(min(from, to)), high_(max(from, to)), squared_(dot(way_, way_)) {
    }

    double operator()(const Box3f& box) const noexcept {
        const Vec3d least{box.min.x, box.min.y, box.min.z}, most{box.max.x, box.max.y, box.max.z};
        const auto apart = [](double low, double high, double from, double to) {
            return std::max({from - high, low - to, 0.0});
        };
        const Vec3d gap{apart(low_.x, high_.x, least.x, most.x), apart(low_.y, high_.y, least.y, most.y),
                        apart(low_.z, high_.z, least.z, most.z)};
        double bound = dot(gap, gap), begin = 0, end = 1;
        double t =
            squared_ > 0 ? std::clamp(dot(0.5 * least + 0.5 * most - from_, way_) / squared_, 0.0, 1.0) : 0;
        // More than rounding adds to a bound, and to a distance that is compared with it.
        const double error = lost * std::max({reach_, largest_coordinate(least), largest_coordinate(most)});
        double farthest = 0;
        for (int i = 0; i < 4 && squared_ > 0; ++i) {
            const Vec3d p = from_ + t * way_, out = p - max(least, min(most, p));
            const double squared = dot(out, out), slope = 2 * dot(out, way_);
            const double side = slope > 0 ? begin : end; // the least value is on this side
            bound = std::max(bound, squared + slope * (side - t));
            farthest = std::max(farthest, squared);
            (slope > 0 ? end : begin) = t;
            if (!(squared > 1.05 * bound)) break;
            // Newton's step, for the axes on which the point is outside.
            const double curve =
                2 * ((out.x != 0 ? way_.x * way_.x : 0) + (out.y != 0 ? way_.y * way_.y : 0) +
                     (out.z != 0 ? way_.z * way_.z : 0));
            const double next = curve > 0 ? t - slope / curve : begin;
            t = next > begin && next < end ? next : 0.5 * (begin + end);
        }
        return bound - error * (std::sqrt(std::max(bound, farthest)) + length_ + error);
    }

    // Calls visit(tet, facet) for the facets of a leaf that may be no further than the square root of `most`.
    // A box around some facets of a slanting surface is much closer than they are; a plane between them and
    // the segment, across the way to their middle, is hardly so.
    template <class Tets, class Visit>
    void visit_facets(const Box3f& box, const Tets& tets, const double& most, Visit&& visit) const {
        const Vec3d least{box.min.x, box.min.y, box.min.z}, highest{box.max.x, box.max.y, box.max.z},
            middle = 0.5 * least + 0.5 * highest;
        const double t = squared_ > 0 ? std::clamp(dot(middle - from_, way_) / squared_, 0.0, 1.0) : 0;
        const Vec3d p = from_ + t * way_, across = normalised(middle - p);
        const double begin = std::max(dot(across, from_ - p), dot(across, from_ + way_ - p)),
                     error = lost * (reach_ + length_ +
                                     std::max(largest_coordinate(least), largest_coordinate(highest)));
        for (std::size_t tet = 0; tet < tets.size(); ++tet) {
            const unsigned facets = tets.facets(tet);
            if (facets == 0) continue;
            double height[4];
            for (std::size_t c = 0; c < 4; ++c) height[c] = dot(across, tets.corner(tet, c) - p);
            for (std::uint32_t facet = 0; facet < 4; ++facet) {
                if ((facets >> facet & 1) == 0) continue;
                const std::uint8_t* const c = facet_corners[facet];
                const double bound = std::min({height[c[0]], height[c[1]], height[c[2]]}) - begin - error;
                if (!(bound > 0 && bound * bound > most)) visit(tet, facet);
            }
        }
    }

private:
    static constexpr double lost = 0x1p-48;
    Vec3d from_, way_, low_, high_;
    double squared_, length_ = std::sqrt(squared_),
                     reach_ = std::max(largest_coordinate(low_), largest_coordinate(high_));
};

// The closest points of two segments, the first from the origin along `way`, each from 0 to 1.
void closest_places(const Vec3d& way, const Vec3d& a, const Vec3d& b, double& place, double& other) {
    const Vec3d edge = b - a;
    const double d1 = dot(way, way), d2 = dot(edge, edge), mixed = dot(way, edge), of_way = dot(way, a),
                 of_edge = dot(edge, a), under = d1 * d2 - mixed * mixed;
    const auto fraction = [](double x, double y) { return y > 0 ? std::clamp(x / y, 0.0, 1.0) : 0; };
    place = under > 0x1p-40 * d1 * d2 ? std::clamp((of_way * d2 - mixed * of_edge) / under, 0.0, 1.0) : 0.5;
    other = fraction(mixed * place - of_edge, d2);
    place = fraction(of_way + mixed * other, d1);
    other = fraction(mixed * place - of_edge, d2);
}

} // namespace

// The closest facet so far, and the lowest of several.
struct Queries::ClosestToSegment {
    // The closest point of the segment, and of the facet as seen from it.
    struct SegmentPoint {
        double place = 0; // from 0 to 1
        SeenPoint seen{};
    };

    double squared;
    bool any = false;
    FacetKey key{};
    SegmentPoint point{};
    std::uint32_t leaf = 0;
    std::size_t place = 0; // see PointHit

    void try_facet(const Vec3d& from, const Vec3d& to, std::uint32_t mesh, std::uint32_t of_leaf,
                   const LeafTets& tets, std::size_t tet, std::uint32_t facet) {
        const OrderedFacet f(tets, tet, facet);
        const Vec3d corner[3] = {tets.at(f.vertex[0]), tets.at(f.vertex[1]), tets.at(f.vertex[2])};
        SegmentPoint found = closest(from, to, corner);
        const double distance = found.seen.at.squared_distance;
        const FacetKey its_key(mesh, tets.index(tet), facet);
        if (!(distance < squared || (distance == squared && (!any || its_key < key)))) return;
        double weight[3];
        for (std::size_t c = 0; c < 3; ++c) weight[f.place[c]] = found.seen.at.weight[c];
        std::ranges::copy(weight, found.seen.at.weight);
        *this = {distance, true, its_key, found, of_leaf, tet};
    }

private:
    static SegmentPoint closest(const Vec3d& from, const Vec3d& to, const Vec3d (&corner)[3]) {
        const auto& [a, b, c] = corner;
        std::uint64_t exact_tests = 0;
        const Crossing crossing = find_crossing(from, to, a, b, c, exact_tests);
        SegmentPoint best;
        if (crossing.kind != CrossingKind::none) {
            best.place = crossing.edge_weights[1];
            std::ranges::copy(crossing.face_weights, best.seen.at.weight);
            return best;
        }
        best.seen = closest_seen_from(from, a, b, c);
        const auto try_place = [&best](double place, const SeenPoint& seen) {
            if (seen.at.squared_distance < best.seen.at.squared_distance) best = {place, seen};
        };
        try_place(1, closest_seen_from(to, a, b, c));
        const Vec3d way = to - from;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = i == 2 ? 0 : i, k = i == 2 ? 2 : i + 1; // ascending
            const Vec3d p = corner[j] - from, q = corner[k] - from;
            double place = 0, other = 0;
            closest_places(way, p, q, place, other);
            SeenPoint seen{};
            seen.at.weight[j] = 1 - other;
            seen.at.weight[k] = other;
            seen.way = (1 - other) * p + other * q - place * way;
            seen.at.squared_distance = dot(seen.way, seen.way);
            try_place(place, seen);
        }
        return best;
    }
};

void Queries::closest_to_segments(std::span<const Vec3d> from, std::span<const Vec3d> to, double max_distance,
                                  QueryMeshes which, std::pmr::memory_resource* memory,
                                  vox_closest_hit* hits) const {
    const double most = max_distance * max_distance;
    ClosestToSegment closest{.squared = most};
    for (std::size_t i = 0; i < from.size(); ++i) {
        const ClosestToSegment before = closest;
        closest = {.squared = most};
        if (before.any) // the previous segment's facet is a first bound
            closest.try_facet(from[i], to[i], std::get<0>(before.key), before.leaf,
                              tets_of(leaves_[before.leaf]), before.place, std::get<2>(before.key));
        const SegmentBound bound(from[i], to[i]);
        surface_tree_.visit_nearest_first(closest.squared, bound, [&](std::uint32_t leaf) {
            if (!wants(leaves_[leaf], which)) return;
            const LeafTets tets = tets_of(leaves_[leaf]);
            bound.visit_facets(
                surface_boxes_[leaf], tets, closest.squared, [&](std::size_t tet, std::uint32_t facet) {
                    closest.try_facet(from[i], to[i], leaves_[leaf].mesh, leaf, tets, tet, facet);
                });
        });
        hits[i] = {};
        if (!closest.any) continue;
        const Vec3d p = from[i] + closest.point.place * (to[i] - from[i]);
        write_closest(p, closest.key, closest.leaf, closest.place, closest.point.seen,
                      std::sqrt(closest.squared), hits[i]);
    }
    count_inside(from, which, memory, hits);
}

} // namespace vox
