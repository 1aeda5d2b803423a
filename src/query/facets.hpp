// The search of the surfaces of all meshes, nearest facet first.
#pragma once

#include "query/queries.hpp"

namespace vox {

// Calls visit(leaf, tets, tet, facet, least) for each facet of a surface whose tetrahedron's bound is at most
// `most`, in the order of BoxTree::visit_nearest_first(). `tets` are those of the leaf, `tet` is the place
// among them, and `least` is the bound. A result for the facet must not be less than `least`, despite
// rounding: then it does not depend on the tree, as no box around the tetrahedron has a greater bound.
template <class Bound, class Visit>
void Queries::visit_facets(QueryMeshes which, const double& most, const Bound& bound, Visit&& visit) const {
    surface_tree_.visit_nearest_first(most, bound, [&](std::uint32_t leaf) {
        if (!wants(leaves_[leaf], which)) return;
        const LeafTets tets = tets_of(leaves_[leaf]);
        for (std::size_t tet = 0; tet < tets.size(); ++tet) {
            const unsigned facets = tets.facets(tet);
            if (facets == 0) continue;
            const double least = bound(tets.box(tet));
            for (std::uint32_t facet = 0; facet < 4; ++facet)
                if (facets >> facet & 1 && least <= most) visit(leaf, tets, tet, facet, least);
        }
    });
}

// The corners of facet i of a tetrahedron in ascending order, so that the tetrahedra on both sides of a facet
// compute the same. `place` is the index of each in facet_corners.
struct OrderedFacet {
    std::uint32_t vertex[3];
    std::size_t place[3] = {0, 1, 2};

    template <class Tets>
    OrderedFacet(const Tets& tets, std::size_t tet, std::size_t i) noexcept {
        for (std::size_t c = 0; c < 3; ++c) vertex[c] = tets.vertex(tet, facet_corners[i][c]);
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

} // namespace vox
