// The counts and means of a scene that cost models and cell-size rules are written in.
#pragma once

#include <vox/vox.h>

namespace vox {

struct CellSizeScene;

struct Geometry {
    vox_geometry_stats stats;
    // Mean over the bodies whose bounding box has a volume, of the side of the cube of equal volume. 0 where none
    // has.
    double mean_object_side;
};

// Measures the positions as they are now. Of a large scene whose meshes have samples (mesh/sample.hpp) these are
// measured: counts of edges and facets are then the topology's, and the means estimates, good to a few per cent where
// sizes are not widely spread. Other scenes are measured in full.
//
// The bounds are those of the vertices that tetrahedra use, and of all vertices for a body without tetrahedra; every
// vertex must be finite all the same. A tetrahedron that names a vertex twice has no edges and facets of its own but
// counts in the means over tetrahedra; one that is off does not count. Means of nothing are 0. Time, and bytes of
// memory until it returns, in proportion to the tetrahedra. Throws Error(NON_FINITE) naming mesh_id and vertex.
Geometry measure(const CellSizeScene& scene);

} // namespace vox
