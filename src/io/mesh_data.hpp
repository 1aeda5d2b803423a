// The plain arrays that every reader and mesher produces, numbered as in the file.
#pragma once

#include "io/progress.hpp"

#include <vox/vox_io.h>

#include <cstdint>
#include <string>
#include <vector>

namespace vox::io {

struct MeshData {
    vox_io_format format = VOX_IO_FORMAT_AUTO;
    std::vector<double> positions;            // 3 a vertex
    std::vector<std::uint32_t> tets;          // 4 a tet
    std::vector<std::uint32_t> triangles;     // 3 a triangle
    std::vector<std::int32_t> tet_regions;    // 1 a tet, or none
    std::vector<std::uint32_t> tet_cells;     // 1 a tet, or none: tet t is cell t of the file
    std::vector<std::uint32_t> file_vertices; // 1 a vertex, or none: as in the file
    std::uint64_t skipped_elements = 0;
    std::uint64_t second_order_tets = 0, left_out_tets = 0, split_cells = 0;
    std::uint64_t left_out_vertices = 0, left_out_triangles = 0;
    std::uint64_t cells = 0;              // of the file so far, of any kind
    std::vector<std::uint32_t> high_tets; // of more than four nodes, until all cells are read
    double unit_in_metres = 0;            // 0: unknown
    std::vector<std::string> notes;       // lines for the warnings, from the reader
};

constexpr std::uint32_t all_meshes = ~std::uint32_t{0}; // as a mesh_index; vox_io_load_desc.mesh is one more

// Of MeshData, or of a vox_io_mesh that has arrays of its own.
template <class Arrays>
vox_io_mesh_view view_of(const Arrays& of) {
    return {of.positions.data(),
            of.positions.size() / 3,
            of.tets.data(),
            of.tets.size() / 4,
            of.triangles.data(),
            of.triangles.size() / 3,
            of.tet_regions.empty() ? nullptr : of.tet_regions.data(),
            of.file_vertices.empty() ? nullptr : of.file_vertices.data(),
            of.tet_cells.empty() ? nullptr : of.tet_cells.data()};
}

// Makes the public object, with report and warnings, from data whose positions are finite and whose indices
// are below the number of vertices. This is the only way to make a vox_io_mesh. Its arrays are those of
// `data`, or copies in the memory of an allocator that has functions, which has been checked.
vox_io_mesh* make_mesh(MeshData data, const vox_allocator* allocator = nullptr,
                       const Progress& progress = {});

} // namespace vox::io
