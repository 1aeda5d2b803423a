// The public mesh object: the arrays with their report and warnings.
#pragma once

#include "base/array.hpp"
#include "base/caller_memory.hpp"
#include "io/mesh_data.hpp"

#include <memory>
#include <memory_resource>
#include <string>

struct vox_io_mesh {
    explicit vox_io_mesh(const vox::CallerMemory& caller)
        : memory(caller), positions(&memory), tets(&memory), triangles(&memory), file_vertices(&memory),
          tet_cells(&memory), tet_regions(&memory) {}

    vox::CallerMemory memory; // first, as the arrays are released to it
    vox::io::MeshData data;   // its arrays are empty if those below are in use
    vox::Array<double> positions;
    vox::Array<std::uint32_t> tets, triangles, file_vertices, tet_cells;
    vox::Array<std::int32_t> tet_regions;
    vox_io_mesh_view view{};
    vox_io_report report{};
    std::string warnings; // one line each
};

namespace vox::io {

struct DestroyMesh {
    void operator()(vox_io_mesh* mesh) const noexcept;
};
using MeshHandle = std::unique_ptr<vox_io_mesh, DestroyMesh>;

// Finds what is odd about a mesh, as numbers and as text (diagnosis.cpp).
vox_io_report diagnose(const MeshData& data, const Progress& progress);
// The exact sign of a tet's volume, over the whole range of finite doubles.
int volume_sign(const MeshData& data, const std::uint32_t* tet);
// One line for everything in the report that a user should know; "" if there is nothing.
std::string warnings_of(const MeshData& data, const vox_io_report& report);

} // namespace vox::io
