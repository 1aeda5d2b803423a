// The C border of loading and diagnosis.
#include "base/border.hpp"
#include "base/llu.hpp"
#include "base/structs.hpp"
#include "io/formats/file_bytes.hpp"
#include "io/formats/readers.hpp"
#include "io/mesh.hpp"
#include "io/unused.hpp"

#include <cstddef>

namespace vox::io {
namespace {

vox_io_load_desc checked(const vox_io_load_desc* in) {
    if (!in) return {};
    const vox_io_load_desc desc = read_struct(in, "vox_io_load_desc");
    check_enum(desc.format, VOX_IO_FORMAT_ABAQUS, "vox_io_load_desc.format");
    check_allocator(desc.allocator, "vox_io_load_desc.allocator");
    if ((desc.flags & ~std::uint32_t{VOX_IO_LOAD_KEEP_UNUSED | VOX_IO_LOAD_SPLIT_CELLS}) != 0)
        refuse(format("vox_io_load_desc.flags is 0x%x, expected vox_io_load_flags", desc.flags));
    return desc;
}

// The requested format or, for AUTO, the one that the content or else the name indicates.
vox_io_format format_of(const File& file, vox_io_format wanted) {
    if (wanted != VOX_IO_FORMAT_AUTO) return wanted;
    const vox_io_format by_content = format_of_content(file.bytes);
    if (by_content != VOX_IO_FORMAT_AUTO) return by_content;
    if (is_ogre_mesh(file.bytes)) return VOX_IO_FORMAT_AUTO; // a .mesh, but not Medit's
    return format_of_extension(extension_of(file.name));
}

File without_byte_order_mark(File file) {
    if (file.bytes.starts_with("\xef\xbb\xbf")) file.bytes.remove_prefix(3);
    return file;
}

// Reads any format except TetGen, which needs two files. Scenes may name other files in `folder`, that of the
// file if it was given by its path.
MeshData read_one(const File& file, const std::optional<std::string>& folder, vox_io_format which,
                  std::uint32_t mesh_index) {
    if (which != VOX_IO_FORMAT_ASSIMP)
        return read_mesh(without_byte_order_mark(file), folder, which, mesh_index);
    MeshData data = folder ? read_by_assimp_at(file.name, mesh_index)
                           : read_by_assimp(file, extension_of(file.name), mesh_index);
    data.format = which;
    return data;
}

std::string folder_of(const std::string& path) {
    const std::size_t slash = path.find_last_of("/\\");
    return slash == std::string::npos ? "." : path.substr(0, slash + 1);
}

// Each file has its part of the progress.
MeshData read_pair(File node, File ele, const Progress& progress) {
    const auto size = [](const File& file) { return static_cast<double>(file.bytes.size()); };
    const double nodes = size(node) / (size(node) + size(ele));
    node.progress = progress.part(0, nodes);
    ele.progress = progress.part(nodes, 1);
    MeshData data =
        read_tetgen(without_byte_order_mark(std::move(node)), without_byte_order_mark(std::move(ele)));
    data.format = VOX_IO_FORMAT_TETGEN;
    return data;
}

MeshData load(const std::string& path, const vox_io_load_desc& desc, const Progress& progress) {
    const FileBytes bytes(path);
    File file = bytes.file();
    file.progress = progress;
    file.split_cells = (desc.flags & VOX_IO_LOAD_SPLIT_CELLS) != 0;
    refuse_other_content(file);
    const vox_io_format which = format_of(file, desc.format);
    if (which != VOX_IO_FORMAT_TETGEN) return read_one(file, folder_of(path), which, desc.mesh - 1);

    const std::string extension = extension_of(path);
    if (extension != "node" && extension != "ele")
        throw_error(VOX_ERROR_UNSUPPORTED, "%s: expected a TetGen file named .node or .ele", path.c_str());
    const bool is_node = extension == "node";
    const FileBytes other(path_beside(path, is_node ? "ele" : "node"));
    refuse_other_content(other.file());
    return is_node ? read_pair(file, other.file(), progress) : read_pair(other.file(), file, progress);
}

File file_of(const vox_io_source& source, std::size_t index) {
    if (!source.data && source.size > 0) refuse(format("sources[%zu].data is null", index));
    const char* data = source.data ? static_cast<const char*>(source.data) : "";
    return {source.name ? source.name : format("source %zu", index), {data, source.size}};
}

MeshData read(const vox_io_source* sources, std::size_t count, const vox_io_load_desc& desc,
              const Progress& progress) {
    if (count != 1 && count != 2) refuse(format("source_count is %zu, not 1 or 2", count));
    require(sources, "sources");
    File first = file_of(sources[0], 0);
    first.progress = progress;
    first.split_cells = (desc.flags & VOX_IO_LOAD_SPLIT_CELLS) != 0;
    refuse_other_content(first);
    if (count == 1) {
        const vox_io_format which = format_of(first, desc.format);
        if (which == VOX_IO_FORMAT_TETGEN)
            refuse(format("%s: TetGen meshes need two sources, .node and .ele", first.name.c_str()));
        return read_one(first, std::nullopt, which, desc.mesh - 1);
    }
    if (desc.format != VOX_IO_FORMAT_AUTO && desc.format != VOX_IO_FORMAT_TETGEN)
        refuse("source_count is 2, which only TetGen meshes need");
    const File second = file_of(sources[1], 1);
    refuse_other_content(second);
    const bool swapped = extension_of(first.name) == "ele" || extension_of(second.name) == "node";
    return swapped ? read_pair(second, first, progress) : read_pair(first, second, progress);
}

// Makes the mesh that `read` reads. Reading takes about as long as the diagnosis.
template <class Read>
vox_io_mesh* made(const vox_io_load_desc& desc, const Read& read) {
    const Progress progress(desc.progress, desc.progress_user);
    progress.report(0);
    MeshData data = read(progress.part(0, 0.5));
    if ((desc.flags & VOX_IO_LOAD_KEEP_UNUSED) == 0) leave_out_unused(data);
    return make_mesh(std::move(data), desc.allocator, progress.part(0.5, 1));
}

MeshData checked(const vox_io_mesh_view& arrays) {
    const auto check_array = [](const void* data, std::uint64_t count, std::uint64_t limit,
                                const char* name) {
        if (count > limit)
            throw_error(VOX_ERROR_LIMIT, "%s: %llu are more than the limit of %llu", name, llu(count),
                        llu(limit));
        if (count > 0) require(data, name);
    };
    check_array(arrays.positions, arrays.vertex_count, VOX_MAX_VERTICES, "arrays->positions");
    check_array(arrays.tets, arrays.tet_count, VOX_MAX_TETS, "arrays->tets");
    check_array(arrays.triangles, arrays.triangle_count, VOX_MAX_TETS, "arrays->triangles");
    for (std::uint64_t i = 0; i < 3 * arrays.vertex_count; ++i)
        if (!std::isfinite(arrays.positions[i]))
            throw_error(VOX_ERROR_NON_FINITE, "vertex %llu has a coordinate that is not finite", llu(i / 3));
    const auto check_indices = [&](const std::uint32_t* indices, std::uint64_t count, unsigned corners,
                                   const char* name) {
        for (std::uint64_t i = 0; i < corners * count; ++i)
            if (indices[i] >= arrays.vertex_count)
                throw_error(VOX_ERROR_INVALID_MESH, "%s %llu names vertex %u of %llu", name, llu(i / corners),
                            indices[i], llu(arrays.vertex_count));
    };
    check_indices(arrays.tets, arrays.tet_count, 4, "tet");
    check_indices(arrays.triangles, arrays.triangle_count, 3, "triangle");
    MeshData data;
    if (arrays.tet_regions)
        data.tet_regions.assign(arrays.tet_regions, arrays.tet_regions + arrays.tet_count);
    if (arrays.tet_cells) data.tet_cells.assign(arrays.tet_cells, arrays.tet_cells + arrays.tet_count);
    if (arrays.file_vertices)
        data.file_vertices.assign(arrays.file_vertices, arrays.file_vertices + arrays.vertex_count);
    if (arrays.vertex_count)
        data.positions.assign(arrays.positions, arrays.positions + 3 * arrays.vertex_count);
    if (arrays.tet_count) data.tets.assign(arrays.tets, arrays.tets + 4 * arrays.tet_count);
    if (arrays.triangle_count)
        data.triangles.assign(arrays.triangles, arrays.triangles + 3 * arrays.triangle_count);
    return data;
}

} // namespace
} // namespace vox::io

using namespace vox;
using namespace vox::io;

vox_result vox_io_load(const char* path, const vox_io_load_desc* desc, vox_io_mesh** out_mesh) {
    return border([&] {
        require(path, "path");
        require(out_mesh, "out_mesh");
        const vox_io_load_desc wanted = checked(desc);
        *out_mesh = made(wanted, [&](const Progress& progress) { return load(path, wanted, progress); });
    });
}

vox_result vox_io_read(const vox_io_source* sources, size_t source_count, const vox_io_load_desc* desc,
                       vox_io_mesh** out_mesh) {
    return border([&] {
        require(out_mesh, "out_mesh");
        const vox_io_load_desc wanted = checked(desc);
        *out_mesh = made(
            wanted, [&](const Progress& progress) { return read(sources, source_count, wanted, progress); });
    });
}

void vox_io_mesh_destroy(vox_io_mesh* mesh) {
    if (mesh) DestroyMesh()(mesh);
}

vox_result vox_io_mesh_get_arrays(const vox_io_mesh* mesh, vox_io_mesh_view* out_view) {
    return border([&] {
        require(mesh, "mesh");
        require(out_view, "out_view");
        *out_view = mesh->view;
    });
}

vox_result vox_io_mesh_describe(const vox_io_mesh* mesh, vox_mesh_desc* desc) {
    return border([&] {
        require(mesh, "mesh");
        vox_mesh_desc described = read_struct(desc, "desc");
        constexpr std::size_t least = offsetof(vox_mesh_desc, tet_count) + sizeof(described.tet_count);
        if (desc->struct_size < least)
            refuse(format("desc.struct_size is %u, which does not reach to tet_count; expected at least %zu",
                          desc->struct_size, least));
        const vox_io_mesh_view& view = mesh->view;
        described.positions = vox_double_positions(view.positions, view.vertex_count);
        described.tets = view.tets;
        described.tet_count = view.tet_count;
        write_struct(desc, described, "desc");
    });
}

vox_result vox_io_mesh_create(const vox_io_mesh_view* arrays, vox_io_mesh** out_mesh) {
    return border([&] {
        require(arrays, "arrays");
        require(out_mesh, "out_mesh");
        *out_mesh = make_mesh(checked(*arrays));
    });
}

vox_result vox_io_mesh_get_report(const vox_io_mesh* mesh, vox_io_report* out_report) {
    return border([&] {
        require(mesh, "mesh");
        write_struct(out_report, mesh->report, "out_report");
    });
}

const char* vox_io_mesh_get_warnings(const vox_io_mesh* mesh) {
    return mesh ? mesh->warnings.c_str() : nullptr;
}

const char* vox_io_format_string(vox_io_format format) {
    static constexpr const char* names[] = {"no file",
                                            "Gmsh .msh",
                                            "TetGen .node/.ele",
                                            "Medit .mesh",
                                            "Vega .veg",
                                            "VTK legacy .vtk",
                                            "VTK XML .vtu and .vtp",
                                            "surface",
                                            "surface, by assimp",
                                            "Abaqus .inp"};
    const auto index = static_cast<std::uint32_t>(enum_value(format));
    return index < std::size(names) ? names[index] : "unknown format";
}
