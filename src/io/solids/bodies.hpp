// Bodies of tetrahedra: ready-made ones, surfaces that are filled, and how good they are. Callers have
// checked the arguments.
#pragma once

#include "io/mesh_data.hpp"

#include <array>

namespace vox::io {

// A cubic lattice with the boundary moved onto the sphere (vox_io_make_lattice_ball).
MeshData make_lattice_ball(std::uint64_t tet_count, double radius);

// By isosurface stuffing.
MeshData make_ball(double radius, double cell);
MeshData make_torus(double radius, double tube_radius, double cell);
MeshData make_capsule(double radius, double length, double cell);
MeshData make_cylinder(double radius, double length, double cell);

// A box of cells[0] x cells[1] x cells[2] cuboids around the origin, of five tetrahedra each.
MeshData make_box(const std::array<double, 3>& size, const std::array<std::int32_t, 3>& cells);

// See vox_io_tetrahedralize; all fields of `desc` are set.
MeshData tetrahedralize(const vox_io_mesh_view& surface, const vox_io_tetrahedralize_desc& desc);

// See vox_io_mesh_measure; `surface` may be null.
vox_io_quality measure_quality(const vox_io_mesh_view& mesh, const vox_io_mesh_view* surface);

} // namespace vox::io
