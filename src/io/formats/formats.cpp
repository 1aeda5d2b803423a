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

using SurfaceReader = MeshData (*)(const File&, const std::optional<std::string>&, std::uint32_t);

template <MeshData (*read)(const File&, std::uint32_t)>
MeshData alone(const File& file, const std::optional<std::string>&, std::uint32_t mesh_index) {
    return read(file, mesh_index);
}

// The reader for the surface that the first characters of `bytes` indicate; null for none.
SurfaceReader surface_of_content(std::string_view bytes) {
    if (is_binary_stl(bytes)) return alone<read_stl>; // first: its header may hold any words
    const File file{"", first_text(bytes, '#')};
    const std::string_view text = file.bytes, word = Scanner(file, '#').peek();
    if (word.ends_with("OFF") && word.size() <= 7) return alone<read_off>;
    if (word == "ply") return alone<read_ply>;
    if (text.starts_with("glTF") || text.starts_with('{')) return read_gltf;
    if (is_text_stl(text)) return alone<read_stl>;
    return nullptr;
}

SurfaceReader surface_of_extension(const std::string& extension) {
    if (extension == "obj") return alone<read_obj>;
    if (extension == "off") return alone<read_off>;
    if (extension == "ply") return alone<read_ply>;
    if (extension == "stl") return alone<read_stl>;
    if (extension == "gltf" || extension == "glb") return read_gltf;
    return nullptr;
}

} // namespace

MeshData read_surface(const File& file, const std::optional<std::string>& folder, std::uint32_t mesh_index) {
    SurfaceReader read = surface_of_content(file.bytes);
    if (!read) read = surface_of_extension(extension_of(file.name));
    if (!read)
        throw Error(
            VOX_ERROR_UNSUPPORTED,
            format("%s: expected a surface, found neither known content nor a known extension (.obj .ply "
                   ".stl .off .gltf .glb)",
                   file.name.c_str()));
    return read(file, folder, mesh_index);
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
    for (const char* keyword : {"*VERTICES", "*ELEMENTS", "*MATERIAL", "*INCLUDE"})
        if (behind_comments.starts_with(keyword)) return VOX_IO_FORMAT_VEGA;
    if (surface_of_content(bytes)) return VOX_IO_FORMAT_SURFACE;
    return VOX_IO_FORMAT_AUTO;
}

bool is_ogre_mesh(std::string_view bytes) { return contains_early(bytes, "[MeshSerializer"); }

vox_io_format format_of_extension(const std::string& extension) {
    if (extension == "msh") return VOX_IO_FORMAT_GMSH;
    if (extension == "node" || extension == "ele") return VOX_IO_FORMAT_TETGEN;
    if (extension == "mesh") return VOX_IO_FORMAT_MEDIT;
    if (extension == "veg") return VOX_IO_FORMAT_VEGA;
    if (extension == "vtk") return VOX_IO_FORMAT_VTK;
    if (extension == "vtu") return VOX_IO_FORMAT_VTU;
    if (surface_of_extension(extension)) return VOX_IO_FORMAT_SURFACE;
    return VOX_IO_FORMAT_AUTO;
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
        throw Error(VOX_ERROR_FORMAT, format("%s: %s", file.name.c_str(), reason));
    };
    const std::string_view bytes = file.bytes;
    const std::string_view text = first_text(bytes, 0);
    if (bytes.empty()) refuse("expected a mesh, found an empty file");
    if (text.empty()) refuse("expected a mesh, found nothing but white space");
    if (bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff"))
        refuse("expected ASCII or UTF-8 text, found UTF-16");
    if (bytes.starts_with("\x1f\x8b")) refuse("expected a mesh, found a gzip archive: unpack it first");
    if (text.starts_with("version https://git-lfs"))
        refuse("expected a mesh, found a git LFS pointer: the file itself was not fetched");
    for (const char* html : {"<!DOCTYPE html", "<!doctype html", "<html", "<HTML"})
        if (text.starts_with(html)) refuse("expected a mesh, found a web page");
}

void Skipped::add(Cell cell, const char* name, std::uint64_t number) {
    elements_ += number;
    if (cell != Cell::volume) return;
    for (Kind& kind : volumes_)
        if (kind.name == name) {
            kind.number += number;
            return;
        }
    volumes_.push_back({name, number});
}

void Skipped::report(MeshData& data) const {
    data.skipped_elements += elements_;
    for (const Kind& kind : volumes_)
        data.notes.push_back(format("%llu volume element%s of another kind %s left out: %s", llu(kind.number),
                                    kind.number == 1 ? "" : "s", kind.number == 1 ? "was" : "were",
                                    kind.name.c_str()));
}

void require_tets(const MeshData& data, const std::string& name) {
    if (!data.tets.empty()) return;
    std::string text = format("%s: expected tetrahedra, found none", name.c_str());
    if (!data.triangles.empty()) text += format(" (but %zu triangles)", data.triangles.size() / 3);
    for (const std::string& note : data.notes) text.append("; ").append(note);
    throw Error(VOX_ERROR_FORMAT, text);
}

} // namespace vox::io
