// OFF, the Object File Format of Geomview (http://www.geomview.org/docs/html/OFF.html), ASCII.
#include "io/formats/readers.hpp"
#include "io/formats/surface_builder.hpp"

#include <algorithm>

namespace vox::io {
namespace {

struct Header {
    bool weights = false;    // 4: a fourth coordinate, by which the others are divided
    bool dimensions = false; // n: their number comes first
};

// The header word without its prefixes, each once and in any order, as programs write them. ST (texture), C
// (colours) and N (normals) only add fields behind the coordinates, which are skipped.
std::string_view base_keyword(std::string_view word, Header& header) {
    const auto pass = [&](std::string_view prefix, bool& found) {
        const bool is_next = !found && word.starts_with(prefix);
        if (is_next) word.remove_prefix(prefix.size());
        found |= is_next;
        return is_next;
    };
    bool textures = false, colours = false, normals = false;
    while (pass("ST", textures) || pass("C", colours) || pass("N", normals) || pass("4", header.weights) ||
           pass("n", header.dimensions)) {
    }
    return word;
}

} // namespace

MeshData read_off(const File& file, std::uint32_t mesh_index) {
    SurfaceBuilder surface(file.name, surface_limits(file.bytes.size()), mesh_index);
    Scanner in(file, '#');
    in.skip_space();
    if (!in.peek().ends_with("OFF")) in.expected("OFF");
    const std::string keyword(in.word("OFF"));
    Header header;
    if (base_keyword(keyword, header) != "OFF")
        in.unsupported("%s: expected OFF, with ST, C, N, 4 or n before it", printable(keyword, 16).c_str());
    in.skip_space();
    if (in.peek() == "BINARY") in.unsupported("OFF BINARY is not read");
    if (header.dimensions) {
        const auto dimensions = in.integer<std::int64_t>("a number of dimensions");
        if (dimensions != 3)
            in.unsupported("only points of three dimensions are read, found %lld", lld(dimensions));
        in.skip_space();
    }

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
        if (header.weights) {
            in.skip_space();
            const double weight = in.real("a fourth coordinate");
            for (double& x : p) x /= weight;
            if (!is_finite(p))
                in.fail("expected a fourth coordinate that divides the others, found %g", weight);
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
