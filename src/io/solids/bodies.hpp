// Makes bodies by isosurface stuffing, from functions of space that are positive inside.
#pragma once

#include "io/mesh_data.hpp"

namespace vox::io {

MeshData make_ball(double radius, double cell);
MeshData make_torus(double radius, double tube_radius, double cell);
MeshData make_capsule(double radius, double length, double cell);
MeshData make_cylinder(double radius, double length, double cell);

} // namespace vox::io
