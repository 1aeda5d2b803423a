// Measures how good a tet mesh is, and how close its boundary is to a surface.
#pragma once

#include <vox/vox_io.h>

namespace vox::io {

// See vox_io_mesh_measure. `surface` may be null.
vox_io_quality measure_quality(const vox_io_mesh_view& mesh, const vox_io_mesh_view* surface);

} // namespace vox::io
