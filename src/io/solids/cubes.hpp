// Makes bodies of whole lattice cubes, five tetrahedra each.
#pragma once

#include "io/mesh_data.hpp"
#include "io/solids/lattice.hpp"

namespace vox::io {

// The cubes that a triangle of the surface touches, and those whose centre, a node of odd coordinates, is in
// `inside`.
MeshData make_cubes(const vox_io_mesh_view& surface, const Frame& frame, const NodeSet& inside,
                    std::uint64_t max_tets);

} // namespace vox::io
