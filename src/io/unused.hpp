// Vertices of a file that are none of the mesh.
#pragma once

#include "io/mesh_data.hpp"

namespace vox::io {

// Leaves out vertices that belong to no tet, and triangles that name one: nodes of the geometry, nodes on
// edges of tets of higher order, corners of elements that were skipped. They would collide like any other
// vertex. A mesh without tets stays as it is.
void leave_out_unused(MeshData& data);

} // namespace vox::io
