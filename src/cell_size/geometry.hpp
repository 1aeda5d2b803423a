// What the bodies of a scene look like: the counts and means that cost models and cell-size rules are written
// in.
#pragma once

#include "base/boxes.hpp"
#include "base/scene.hpp"
#include "mesh/sample.hpp"

#include <vox/vox.h>

#include <memory_resource>
#include <span>

namespace vox {

struct Geometry {
    vox_geometry_stats stats;
    // Mean over the bodies whose bounding box has a volume: the side of the cube of equal volume. 0: none
    // has.
    double mean_object_side;
};

// Measures the positions as they are now. The bounds are those of the vertices that tetrahedra use, and of
// all vertices for a body without tetrahedra; every vertex must be finite all the same. A tetrahedron that
// names a vertex twice has no edges and facets of its own; it counts in the means over tetrahedra. Means of
// nothing are 0. Time, and bytes of `memory` until it returns, in proportion to the tetrahedra. Throws
// Error(NON_FINITE) naming mesh_id and vertex.
Geometry measure(std::span<const Body> bodies,
                 std::pmr::memory_resource* memory = std::pmr::get_default_resource());

// The same from about so many tetrahedra and edges and half as many boundary facets, for large meshes whose
// samples are known: the time goes into one pass over the vertices, for the bounds, unless `boxes` has them:
// of each body, around all of its vertices, which are finite then; empty: not known. Counts of edges and
// facets are the topology's, the rest is an estimate, good to a few per cent where sizes are not spread far.
Geometry estimate(std::span<const Body> bodies, std::span<const MeshSample* const> meshes,
                  std::span<const Box> boxes, std::size_t samples, std::pmr::memory_resource* memory);

// The means of the statistics, however they were taken: of each quantity one that has a value().
template <class Means>
void write_means(const Means& means, vox_geometry_stats& stats) {
    stats.mean_edge = means.edge.value();
    stats.mean_longest_edge = means.longest_edge.value();
    stats.mean_box_side = means.box_side.value();
    stats.mean_facet_area = means.facet.value();
    stats.mean_tet_facet_area = means.tet_facet.value();
    stats.mean_boundary_facet_area = means.boundary_facet.value();
    stats.mean_volume = means.volume.value();
}

} // namespace vox
