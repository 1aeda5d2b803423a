// Recognises formats, and holds what all readers share.
#include "io/formats/readers.hpp"

#include <algorithm>
#include <cctype>

namespace vox::io {
namespace {

// `bytes` without the byte order mark, white space and comment lines at the beginning.
std::string_view first_text(std::string_view bytes, char comment) {
    if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
    const File file{"", bytes};
    Scanner scanner(file, comment);
    scanner.skip_space();
    return scanner.rest();
}

bool contains_early(std::string_view bytes, std::string_view text) {
    return bytes.substr(0, 4096).find(text) != std::string_view::npos;
}

using Reader = MeshData (*)(const File&, const std::optional<std::string>&, std::uint32_t);

template <MeshData (*read)(const File&)>
MeshData tets(const File& file, const std::optional<std::string>&, std::uint32_t) {
    return read(file);
}
template <MeshData (*read)(const File&, std::uint32_t)>
MeshData alone(const File& file, const std::optional<std::string>&, std::uint32_t mesh_index) {
    return read(file, mesh_index);
}

struct Format {
    std::string_view extension;
    vox_io_format format;
    Reader read;
};
constexpr Format formats[] = {{"msh", VOX_IO_FORMAT_GMSH, tets<read_gmsh>},
                              {"mesh", VOX_IO_FORMAT_MEDIT, tets<read_medit>},
                              {"veg", VOX_IO_FORMAT_VEGA, tets<read_vega>},
                              {"vtk", VOX_IO_FORMAT_VTK, alone<read_vtk>},
                              {"vtu", VOX_IO_FORMAT_VTU, alone<read_vtu>},
                              {"vtp", VOX_IO_FORMAT_VTU, alone<read_vtu>},
                              {"inp", VOX_IO_FORMAT_ABAQUS, tets<read_abaqus>},
                              {"node", VOX_IO_FORMAT_TETGEN, nullptr}, // two files: read_tetgen
                              {"ele", VOX_IO_FORMAT_TETGEN, nullptr},
                              {"obj", VOX_IO_FORMAT_SURFACE, alone<read_obj>},
                              {"off", VOX_IO_FORMAT_SURFACE, alone<read_off>},
                              {"ply", VOX_IO_FORMAT_SURFACE, alone<read_ply>},
                              {"stl", VOX_IO_FORMAT_SURFACE, alone<read_stl>},
                              {"gltf", VOX_IO_FORMAT_SURFACE, read_gltf},
                              {"glb", VOX_IO_FORMAT_SURFACE, read_gltf}};

// The first that satisfies `is_it`, or null.
template <class IsIt>
const Format* find_format(const IsIt& is_it) {
    const auto* const found = std::find_if(std::begin(formats), std::end(formats), is_it);
    return found == std::end(formats) ? nullptr : found;
}

// The reader for the surface that the first characters of `bytes` indicate; null for none.
Reader surface_of_content(std::string_view bytes) {
    if (is_binary_stl(bytes)) return alone<read_stl>; // first: its header may hold any words
    const File file{"", first_text(bytes, '#')};
    const std::string_view text = file.bytes, word = Scanner(file, '#').peek();
    if (word.ends_with("OFF") && word.size() <= 9) return alone<read_off>;
    if (word == "ply") return alone<read_ply>;
    if (text.starts_with("glTF") || text.starts_with('{')) return read_gltf;
    if (is_text_stl(text)) return alone<read_stl>;
    return nullptr;
}

} // namespace

MeshData read_mesh(const File& file, const std::optional<std::string>& folder, vox_io_format format,
                   std::uint32_t mesh_index) {
    const bool surface = format == VOX_IO_FORMAT_SURFACE;
    Reader read = surface ? surface_of_content(file.bytes) : nullptr;
    const std::string extension = extension_of(file.name);
    if (!read)
        if (const Format* const found = find_format([&](const Format& each) {
                return each.format == format && (!surface || each.extension == extension);
            }))
            read = found->read;
    if (!read)
        throw_error(
            VOX_ERROR_UNSUPPORTED,
            "%s: expected a %s, found neither known content nor a known extension (%s.obj .ply .stl .off "
            ".gltf .glb)",
            file.name.c_str(), surface ? "surface" : "mesh",
            surface ? "" : ".msh .node .ele .mesh .veg .vtk .vtu .vtp .inp, and surfaces: ");
    MeshData data = read(file, folder, mesh_index);
    data.format = format;
    return data;
}

vox_io_format format_of_content(std::string_view bytes) {
    if (is_binary_stl(bytes)) return VOX_IO_FORMAT_SURFACE; // first: its header may hold any words
    const std::string_view text = first_text(bytes, 0);
    if (text.starts_with("# vtk DataFile")) return VOX_IO_FORMAT_VTK;
    if (text.starts_with('$') && text.size() > 1 && std::isalpha(static_cast<unsigned char>(text[1])))
        return VOX_IO_FORMAT_GMSH;
    if (text.starts_with('<') && contains_early(text, "<VTKFile")) return VOX_IO_FORMAT_VTU;
    const std::string_view behind_comments = first_text(bytes, '#');
    if (behind_comments.starts_with("MeshVersionFormatted")) return VOX_IO_FORMAT_MEDIT;
    for (const char* keyword :
         {"*VERTICES", "*ELEMENTS", "*MATERIAL", "*INCLUDE"}) // Abaqus has commas behind these
        if (Scanner({"", behind_comments}, '#').peek() == keyword) return VOX_IO_FORMAT_VEGA;
    if (is_abaqus(text)) return VOX_IO_FORMAT_ABAQUS;
    if (surface_of_content(bytes)) return VOX_IO_FORMAT_SURFACE;
    return VOX_IO_FORMAT_AUTO;
}

bool is_ogre_mesh(std::string_view bytes) { return contains_early(bytes, "[MeshSerializer"); }

vox_io_format format_of_extension(const std::string& extension) {
    const Format* const found = find_format([&](const Format& each) { return each.extension == extension; });
    return found ? found->format : VOX_IO_FORMAT_AUTO;
}

std::string extension_of(std::string_view name) {
    const std::size_t dot = name.rfind('.');
    if (dot == std::string_view::npos || name.find_first_of("/\\", dot) != std::string_view::npos) return "";
    std::string extension(name.substr(dot + 1));
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

void refuse_other_content(const File& file) {
    const auto refuse = [&](const char* reason) {
        throw_error(VOX_ERROR_FORMAT, "%s: %s", file.name.c_str(), reason);
    };
    const std::string_view bytes = file.bytes;
    const std::string_view text = first_text(bytes, 0);
    if (bytes.empty()) refuse("expected a mesh, found an empty file");
    if (text.empty()) refuse("expected a mesh, found nothing but white space");
    if (bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff"))
        refuse("expected ASCII or UTF-8 text, found UTF-16");
    constexpr std::pair<std::string_view, const char*> archives[] = {{"\x1f\x8b", "a gzip"},
                                                                     {"\xfd"
                                                                      "7zXZ",
                                                                      "an xz"},
                                                                     {"BZh", "a bzip2"},
                                                                     {"\x28\xb5\x2f\xfd", "a zstd"},
                                                                     {"7z\xbc\xaf\x27\x1c", "a 7z"},
                                                                     {"\x04\x22\x4d\x18", "an LZ4"}};
    for (const auto& [start, kind] : archives)
        if (bytes.starts_with(start))
            refuse(format("expected a mesh, found %s archive: unpack it first", kind).c_str());
    if (text.starts_with("version https://git-lfs"))
        refuse("expected a mesh, found a git LFS pointer: the file itself was not fetched");
    for (const char* html : {"<!DOCTYPE html", "<!doctype html", "<html", "<HTML"})
        if (text.starts_with(html)) refuse("expected a mesh, found a web page");
}

} // namespace vox::io
