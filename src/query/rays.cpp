// Queries for what a segment meets, by branch and bound over the tree. Whether it meets a facet is decided
// exactly: by the sides of the facet on which its ends are, and the sides of the segment on which the facet's
// edges are.
#include "base/array.hpp"
#include "base/entry_bound.hpp"
#include "base/vectors.hpp"
#include "exact/predicates.hpp"
#include "query/facets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace vox {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double volume(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) noexcept {
    const Vec3d u = b - a, v = c - a, w = d - a;
    return dot(cross(u, v), w);
}

// Where a segment meets a closed triangle. `t` runs from 0 at its beginning to 1 at its end, and is rounded.
struct RayCrossing {
    double t = infinity; // infinite if it does not
    double weight[3] = {};
    int from_side = 0, to_side = 0; // orientation() of the ends
};

RayCrossing find_crossing(const Vec3d& from, const Vec3d& to, const Vec3d& a, const Vec3d& b,
                          const Vec3d& c) noexcept {
    std::uint64_t exact_tests = 0;
    RayCrossing crossing;
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

// A segment and a facet of a tetrahedron.
template <class Tets>
RayCrossing find_crossing(const Vec3d& from, const Vec3d& to, const Tets& tets,
                          const OrderedFacet& f) noexcept {
    return find_crossing(from, to, tets.at(f.vertex[0]), tets.at(f.vertex[1]), tets.at(f.vertex[2]));
}

// The t at which a segment first meets a closed tetrahedron; infinite if it does not, or if the tetrahedron
// has no volume.
template <class Tets>
double find_entry(const Vec3d& from, const Vec3d& to, const Tets& tets, std::size_t tet) noexcept {
    const Vec3d &a = tets.corner(tet, 0), &b = tets.corner(tet, 1), &c = tets.corner(tet, 2),
                &d = tets.corner(tet, 3);
    std::uint64_t exact_tests = 0;
    const Containment where = locate_in_solid(from, a, b, c, d, exact_tests);
    if (where == Containment::interior || where == Containment::boundary) return 0;
    double t = infinity;
    for (std::size_t facet = 0; facet < 4 && t > 0; ++facet)
        t = std::min(t, find_crossing(from, to, tets, OrderedFacet(tets, tet, facet)).t);
    return t < infinity && orientation(a, b, c, d, exact_tests) == 0 ? infinity : t;
}

// True if a segment enters or leaves a tetrahedron through a facet.
template <class Tets>
vox_side side_of(const RayCrossing& crossing, const Tets& tets, std::size_t tet, std::uint32_t facet,
                 const OrderedFacet& f) noexcept {
    std::uint64_t exact_tests = 0;
    const int inside = orientation(tets.at(f.vertex[0]), tets.at(f.vertex[1]), tets.at(f.vertex[2]),
                                   tets.corner(tet, facet), exact_tests);
    if (inside == 0) return VOX_SIDE_NONE;
    const bool enters = crossing.to_side != 0 ? crossing.to_side == inside : crossing.from_side == -inside;
    return enters ? VOX_SIDE_ENTERS : VOX_SIDE_LEAVES;
}

} // namespace

void Queries::ray_hits(const Vec3d& from, const Vec3d& to, QueryMeshes which, bool first_only,
                       Array<vox_ray_hit>& hits) const {
    const EntryBound bound(from, to);
    const auto before = [](const vox_ray_hit& x, const vox_ray_hit& y) {
        return std::tie(x.t, x.body, x.tet, x.facet) < std::tie(y.t, y.body, y.tet, y.facet);
    };
    double most = 1;
    visit_facets(
        which, most, bound,
        [&](std::uint32_t leaf, const LeafTets& tets, std::size_t tet, std::uint32_t facet, double least) {
            const OrderedFacet f(tets, tet, facet);
            const RayCrossing crossing = find_crossing(from, to, tets, f);
            if (!(crossing.t <= 1)) return;
            vox_ray_hit hit{};
            hit.body = meshes_[leaves_[leaf].mesh].id;
            hit.tet = tets.index(tet);
            hit.facet = facet;
            hit.t = std::max(crossing.t, least);
            if (first_only && !hits.empty()) {
                if (!before(hit, hits[0])) return;
                hits.clear();
            }
            if (first_only) most = hit.t;
            hit.side = side_of(crossing, tets, tet, facet, f);
            tets.write_face(tet, facet, hit.face);
            for (std::size_t n = 0; n < 3; ++n) hit.weights[f.place[n]] = crossing.weight[n];
            hits.push_back(hit);
        });
    std::sort(hits.begin(), hits.end(), before);
}

bool Queries::blocks(const Vec3d& from, const Vec3d& to, QueryMeshes which) const noexcept {
    const EntryBound bound(from, to);
    double most = 1;
    tree_.visit_nearest_first(most, bound, [&](std::uint32_t leaf) {
        if (!wants(leaves_[leaf], which)) return;
        const LeafTets tets = tets_of(leaves_[leaf]);
        for (std::size_t i = 0; i < tets.size() && most > 0; ++i)
            if (bound(tets.box(i)) <= most && find_entry(from, to, tets, i) <= most)
                most = -1; // ends the search, as no bound is negative
    });
    return most < 0;
}

} // namespace vox
