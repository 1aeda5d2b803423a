// Isosurface stuffing: tetrahedra of bounded angles from a body-centred cubic lattice whose nodes are known
// to be inside or outside of a body.
#pragma once

#include "io/mesh_data.hpp"
#include "io/solids/lattice.hpp"
#include "io/solids/progress.hpp"

#include <functional>

namespace vox::io {

// The body: the nodes inside it, and where the lattice edge from node `inside` to its neighbour number
// `neighbour`, which is outside, leaves it: a fraction of the edge in [0, 1]. Called once for each such edge.
struct Body {
    Frame frame;
    NodeSet inside;
    std::function<double(const Node& inside, unsigned neighbour)> leaves;
};

// Throws LIMIT when so many nodes inside are sure to make more than max_tets: keeps memory within bounds
// before anything is laid out.
void check_tet_count(const NodeSet& inside, const Frame& frame, std::uint32_t coarsen,
                     std::uint64_t max_tets);

// The body's tetrahedra, positively oriented. `coarsen`: number of times cells far from the boundary may be
// merged 2 x 2 x 2. Throws LIMIT when there would be more than max_tets.
MeshData stuff(const Body& body, std::uint32_t coarsen, std::uint64_t max_tets, const Progress& progress);

} // namespace vox::io
