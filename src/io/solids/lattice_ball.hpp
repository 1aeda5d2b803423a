// Makes a ball from a cubic lattice, five tetrahedra a cube.
#pragma once

#include "io/mesh_data.hpp"

#include <cstdint>

namespace vox::io {

// See vox_io_make_lattice_ball. `tet_count` and `radius` were checked by the caller.
MeshData make_lattice_ball(std::uint64_t tet_count, double radius);

} // namespace vox::io
