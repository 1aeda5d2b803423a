// The readers, one for each format, turn bytes into plain arrays. A reader checks every count against the
// remaining bytes before it reserves memory for it, and every index before it uses it. Its failures are
// Errors that name the place in the file.
#pragma once

#include "io/formats/cells.hpp"

#include <optional>

namespace vox::io {

MeshData read_gmsh(const File& file);
MeshData read_tetgen(const File& node, const File& ele);
MeshData read_medit(const File& file);
MeshData read_vega(const File& file);
// Tets, or triangles where the file is a surface (POLYDATA, .vtp).
MeshData read_vtk(const File& file, std::uint32_t mesh_index);
MeshData read_vtu(const File& file, std::uint32_t mesh_index);
MeshData read_abaqus(const File& file);
bool is_abaqus(std::string_view text); // by its first keyword

// Reads any format but TetGen, which needs two files. mesh_index, of surfaces, counts from 0, or is
// all_meshes. Files that a .gltf names are looked for in `folder`; without one it must be complete.
MeshData read_mesh(const File& file, const std::optional<std::string>& folder, vox_io_format format,
                   std::uint32_t mesh_index);

// Surfaces, as triangles.
MeshData read_gltf(const File& file, const std::optional<std::string>& folder, std::uint32_t mesh_index);
MeshData read_obj(const File& file, std::uint32_t mesh_index);
MeshData read_off(const File& file, std::uint32_t mesh_index);
MeshData read_ply(const File& file, std::uint32_t mesh_index);
MeshData read_stl(const File& file, std::uint32_t mesh_index);
bool is_binary_stl(std::string_view bytes); // by the size that its number of triangles gives
bool is_text_stl(std::string_view bytes);   // by its first word

// Surfaces of many more formats, by a library that is not made for damaged files: only where a caller asks
// for it. From memory, with an extension without its dot, or from a path, beside which other files may be
// needed.
MeshData read_by_assimp(const File& file, const std::string& extension, std::uint32_t mesh_index);
MeshData read_by_assimp_at(const std::string& path, std::uint32_t mesh_index);

// The format that the first characters of `bytes` indicate, or AUTO.
vox_io_format format_of_content(std::string_view bytes);
// Whether it is a mesh of Ogre, whose extension is .mesh too.
bool is_ogre_mesh(std::string_view bytes);
// The format that the extension indicates, or AUTO.
vox_io_format format_of_extension(const std::string& extension);
// The part of a name after its last dot, in lower case.
std::string extension_of(std::string_view name);

// Throws if the file is recognised as something other than a mesh (empty, UTF-16, compressed, a web page).
void refuse_other_content(const File& file);

// The largest number of vertices, and of tets, of a mesh.
inline constexpr std::uint64_t max_count = VOX_MAX_VERTICES;

} // namespace vox::io
