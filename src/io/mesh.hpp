// The public mesh object: the data with its report and warnings.
#pragma once

#include "io/mesh_data.hpp"

#include <string>

struct vox_io_mesh {
    vox::io::MeshData data;
    vox_io_report report{};
    std::string warnings; // one line each
};
