// The closest surface to points that no tetrahedron contains, over all ranks: first the ranks find out which
// facets of their parts are shared, then points go to the ranks whose surface may be closest.
#pragma once

#include "base/box_tree.hpp"
#include "dist/scene.hpp"
#include "exact/closest_point.hpp"

#include <tuple>

namespace vox::dist {

// A facet near a point, and where the closest point is on it.
struct NearFacet {
    std::uint64_t body, tet; // global numbers
    double squared;          // distance
    double weights[4];       // of the tetrahedron's corners
    std::uint32_t facet;     // VOX_NONE: none
    std::uint32_t point;     // its place among those that a rank was sent

    auto key() const noexcept { return std::tuple(squared, body, tet, facet); }
};

class Outside {
public:
    explicit Outside(vox_dist_scene& scene);

    // Collective. Answers for the points whose state is VOX_LOCATION_NONE.
    void run(const Positions& points, std::span<vox_dist_location> locations);

private:
    // A facet of one tetrahedron only, as far as this rank sees.
    struct Facet {
        const Part* part;
        std::uint32_t tet, index;
    };

    void send_facets();
    void find_sent_facets();
    void build_tree(Overview& mine);
    NearFacet search(const Vec3d& p, double most) const;
    void write_weights(const Vec3d& p, const Facet& facet, const SeenPoint& seen, NearFacet& out) const;
    void send_points(const Positions& points);
    void answer_points();
    void take_answers(std::span<vox_dist_location> locations);

    vox_dist_scene& scene_;
    Memory* memory_;
    Array<Writer> writers_; // one a neighbour
    Array<Facet> facets_;
    Array<Box3f> boxes_;               // around their tetrahedra; empty: not on the surface
    BoxTree tree_;                     // over boxes_
    Array<std::uint32_t> sent_;        // facets, then places in asked_
    Array<std::uint64_t> sent_begins_; // by neighbour
    Array<std::uint32_t> asked_;       // the points
    Array<NearFacet> nearest_;         // to each of these, as far as this rank knows
    Array<std::uint32_t> where_;       // the rank of each
};

} // namespace vox::dist
