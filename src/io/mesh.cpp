#include "io/mesh.hpp"

#include <memory>
#include <utility>

namespace vox::io {

vox_io_mesh_view view_of(const MeshData& data) {
    return {data.positions.data(), data.positions.size() / 3, data.tets.data(),
            data.tets.size() / 4,  data.triangles.data(),     data.triangles.size() / 3};
}

vox_io_mesh* make_mesh(MeshData data) {
    auto mesh = std::make_unique<vox_io_mesh>();
    mesh->data = std::move(data);
    mesh->report = diagnose(mesh->data);
    mesh->warnings = warnings_of(mesh->data, mesh->report);
    return mesh.release();
}

} // namespace vox::io
