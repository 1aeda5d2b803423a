// The public mesh object: the data with its report and warnings.
#pragma once

#include "io/mesh_data.hpp"

#include <string>

struct vox_io_mesh {
    vox::io::MeshData data;
    vox_io_report report{};
    std::string warnings; // one line each
};

namespace vox::io {

// Finds what is odd about a mesh, as numbers and as text (diagnosis.cpp).
vox_io_report diagnose(const MeshData& data);
// One line for everything in the report that a user should know; "" if there is nothing.
std::string warnings_of(const MeshData& data, const vox_io_report& report);

} // namespace vox::io
