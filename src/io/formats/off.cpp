// OFF, the Object File Format of Geomview (http://www.geomview.org/docs/html/OFF.html), ASCII.
#include "io/formats/readers.hpp"
#include "io/formats/surface_builder.hpp"

#include <algorithm>

namespace vox::io {
namespace {

// The header word without its prefixes. ST (texture), C (colours) and N (normals) only add fields, which are
// skipped.
std::string_view base_keyword(std::string_view word) {
    if (word.starts_with("ST")) word.remove_prefix(2);
    if (word.starts_with('C')) word.remove_prefix(1);
    if (word.starts_with('N')) word.remove_prefix(1);
    return word;
}

} // namespace

MeshData read_off(const File& file, std::uint32_t mesh_index) {
    SurfaceBuilder surface(file.name, surface_limits(file.bytes.size()), mesh_index);
    Scanner in(file, '#');
    in.skip_space();
    if (!in.peek().ends_with("OFF")) in.expected("OFF");
    const std::string keyword(in.word("OFF"));
    if (base_keyword(keyword) != "OFF")
        in.unsupported("%s: only points of three dimensions are read (OFF, with ST, C or N before it)",
                       printable(keyword, 16).c_str());
    in.skip_space();
    if (in.peek() == "BINARY") in.unsupported("OFF BINARY is not read");

    const auto vertices = in.count("number of vertices", 6, max_count);
    in.skip_space();
    const auto faces = in.count("number of faces", 4, max_count);
    in.skip_line(); // the number of edges, which is often wrong

    surface.reserve_points(vertices);
    for (std::uint64_t v = 0; v < vertices; ++v) {
        double p[3];
        for (double& x : p) {
            in.skip_space();
            x = in.real("a coordinate");
        }
        in.skip_line(); // normal, colour, texture
        surface.point(p);
    }
    const bool wanted = surface.begin_element();
    for (std::uint64_t f = 0; f < faces; ++f) {
        in.skip_space();
        const auto corners = in.count("number of corners", 2, max_count);
        for (std::uint64_t i = 0; i < corners; ++i) {
            in.skip_space();
            const auto vertex = in.integer<std::uint64_t>("a vertex number");
            if (vertex >= vertices)
                in.fail("expected a vertex number from 0 to %llu, found %llu",
                        llu(std::max<std::uint64_t>(vertices, 1) - 1), llu(vertex));
            if (wanted) surface.corner(surface.vertex_of(static_cast<std::uint32_t>(vertex)));
        }
        if (wanted) surface.end_polygon();
        in.skip_line(); // colour
    }
    in.skip_space();
    if (!in.done()) in.expected("the end of the file after the last face");
    return surface.finish();
}

} // namespace vox::io
