// Isosurface stuffing: makes tetrahedra of bounded angles from a body-centred cubic lattice whose nodes are
// known to be inside or outside of a body.
#pragma once

#include "io/mesh_data.hpp"
#include "io/progress.hpp"
#include "io/solids/lattice.hpp"

#include <functional>

namespace vox::io {

// A body is given by the nodes inside it and the function `leaves`, which is called once for each lattice
// edge from a node `inside` to its neighbour number `neighbour` outside. It returns where the edge leaves the
// body, as a fraction of the edge in [0, 1].
struct SolidShape {
    Frame frame;
    NodeSet inside;
    std::function<double(const Node& inside, unsigned neighbour)> leaves;
};

// Throws LIMIT if the nodes inside will certainly make more than max_tets, so that memory stays within
// bounds.
void check_tet_count(const NodeSet& inside, const Frame& frame, std::uint32_t coarsen,
                     std::uint64_t max_tets);

// The body's tetrahedra, of positive volume. Cells far from the boundary may be merged 2 x 2 x 2, `coarsen`
// times. Throws LIMIT if there would be more than max_tets.
MeshData stuff(const SolidShape& body, std::uint32_t coarsen, std::uint64_t max_tets,
               const Progress& progress);

} // namespace vox::io
