// One reader a format: bytes in, plain arrays out. A reader checks every count against the bytes that are
// left before it reserves memory by it, and every index before it uses it; failures are Errors that name the
// place.
#pragma once

#include "io/formats/scan.hpp"
#include "io/mesh_data.hpp"

namespace vox::io {

MeshData read_gmsh(const File& file);
MeshData read_tetgen(const File& node, const File& ele);
MeshData read_medit(const File& file);
MeshData read_vega(const File& file);
MeshData read_vtk(const File& file);
MeshData read_vtu(const File& file);

// OFF surfaces; polygons are cut into fans.
bool starts_as_off(std::string_view bytes);
bool is_off(const File& file); // by content or by name: assimp never gets a file it takes for OFF
MeshData read_off(const File& file);

// Surfaces through assimp: from memory, or from a path when other files may lie beside it.
// `extension` without its dot; mesh_index as in vox_io_load_desc.
MeshData read_surface(const File& file, const std::string& extension, std::uint32_t mesh_index);
MeshData read_surface_at(const std::string& path, std::uint32_t mesh_index);
bool is_surface_extension(const std::string& extension);

// What `bytes` is, told by its first characters; AUTO when they say nothing.
vox_io_format format_of_content(std::string_view bytes);
// What a file of this name holds; AUTO when the extension is unknown.
vox_io_format format_of_extension(const std::string& extension);
// The part of a name after its last dot, in lower case.
std::string extension_of(std::string_view name);

// Throws when the file is none of ours for a reason worth telling: empty, UTF-16, compressed, a web page.
void refuse_strangers(const File& file);

// ---- shared by the readers ----

// What becomes of one cell of a mixed mesh.
enum class Cell : std::uint8_t {
    tet,      // four nodes
    high_tet, // more nodes, the corners first
    triangle, // three nodes, or more with the corners first
    volume,   // another volume element: worth a word when skipped
    other     // points, lines, quadrilaterals and the like
};

// Counts skipped cells and says afterwards which volume elements were left out.
class Skipped {
public:
    void add(Cell cell, const char* name, std::uint64_t number);
    void tell(MeshData& data) const;

private:
    struct Kind {
        std::string name;
        std::uint64_t number;
    };
    std::vector<Kind> volumes_;
    std::uint64_t elements_ = 0;
};

// Throws, naming the file, when data holds no tet. Every reader of a tet format ends with it.
void require_tets(const MeshData& data, const std::string& name);

// Most vertices and most tets of a mesh.
inline constexpr std::uint64_t max_count = VOX_MAX_VERTICES;

} // namespace vox::io
