// Finds what is odd about a mesh, as the numbers of vox_io_report and as text.
#pragma once

#include "io/mesh_data.hpp"

namespace vox::io {

vox_io_report diagnose(const MeshData& data);

// One line for everything in the report that a user should know; "" if there is nothing.
std::string warnings_of(const MeshData& data, const vox_io_report& report);

} // namespace vox::io
