// The ready-made bodies, except the box of whole cubes (cubes.hpp). Callers have checked the arguments.
#pragma once

#include "io/mesh_data.hpp"

namespace vox::io {

// A cubic lattice with the boundary moved onto the sphere (vox_io_make_lattice_ball).
MeshData make_lattice_ball(std::uint64_t tet_count, double radius);

// By isosurface stuffing.
MeshData make_ball(double radius, double cell);
MeshData make_torus(double radius, double tube_radius, double cell);
MeshData make_capsule(double radius, double length, double cell);
MeshData make_cylinder(double radius, double length, double cell);

} // namespace vox::io
