// Fills a surface with tetrahedra.
#pragma once

#include "io/mesh_data.hpp"

namespace vox::io {

// See vox_io_tetrahedralize. All fields of `desc` are set; the surface's indices and positions were checked
// when it was made.
MeshData tetrahedralize(const vox_io_mesh_view& surface, const vox_io_tetrahedralize_desc& desc);

} // namespace vox::io
