#include "io/mesh.hpp"
#include "base/array.hpp"

#include <utility>

namespace vox::io {

namespace {

// Moves an array to another memory. `= {}` would empty it, but keep its room.
template <class Number>
Array<Number> moved(std::vector<Number>& from, std::pmr::memory_resource* memory) {
    Array<Number> to(from.begin(), from.end(), memory);
    from = std::vector<Number>();
    return to;
}

} // namespace

vox_io_mesh* make_mesh(MeshData data, const vox_allocator* allocator, const Progress& progress) {
    CallerMemory memory(allocator);
    MeshHandle mesh(std::pmr::polymorphic_allocator<>(&memory).new_object<vox_io_mesh>(memory));
    mesh->report = diagnose(data, progress);
    mesh->warnings = warnings_of(data, mesh->report);
    mesh->data = std::move(data);
    MeshData& own = mesh->data;
    own.notes = std::vector<std::string>(); // the warnings hold them
    mesh->view = view_of(own);
    if (allocator && allocator->allocate) {
        mesh->positions = moved(own.positions, &mesh->memory);
        mesh->tets = moved(own.tets, &mesh->memory);
        mesh->triangles = moved(own.triangles, &mesh->memory);
        mesh->file_vertices = moved(own.file_vertices, &mesh->memory);
        mesh->tet_cells = moved(own.tet_cells, &mesh->memory);
        mesh->tet_regions = moved(own.tet_regions, &mesh->memory);
        mesh->view = view_of(*mesh);
    }
    progress.report(1);
    return mesh.release();
}

void DestroyMesh::operator()(vox_io_mesh* mesh) const noexcept {
    CallerMemory memory = mesh->memory;
    std::pmr::polymorphic_allocator<>(&memory).delete_object(mesh);
}

} // namespace vox::io
