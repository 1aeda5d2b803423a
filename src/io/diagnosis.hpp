// What is odd about a mesh: the numbers of vox_io_report, and the same in words.
#pragma once

#include "io/mesh_data.hpp"

namespace vox::io {

vox_io_report diagnose(const MeshData& data);

// One line each for everything in the report that a user should know; "" when there is nothing.
std::string warnings_of(const MeshData& data, const vox_io_report& report);

} // namespace vox::io
