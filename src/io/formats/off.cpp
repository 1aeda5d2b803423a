// OFF, the Object File Format of Geomview (http://www.geomview.org/docs/html/OFF.html), ASCII. assimp 5.2.5
// is not used for it because it expects each face on a line of its own and crashes otherwise.
#include "io/formats/readers.hpp"

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

bool starts_as_off(std::string_view bytes) {
    const File file{"", bytes};
    Scanner in(file, '#');
    in.skip_space();
    const std::string_view keyword = in.peek();
    return keyword.ends_with("OFF") && keyword.size() <= 7;
}

bool is_off(const File& file) { return extension_of(file.name) == "off" || starts_as_off(file.bytes); }

MeshData read_off(const File& file) {
    MeshData data;
    data.format = VOX_IO_FORMAT_SURFACE;
    Scanner in(file, '#');
    in.skip_space();
    if (!starts_as_off(in.rest())) in.expected("OFF");
    const std::string keyword(in.word("OFF"));
    if (base_keyword(keyword) != "OFF")
        in.fail(format("%s: only points of three dimensions are read (OFF, with ST, C or N before it)",
                       printable(keyword, 16).c_str()),
                VOX_ERROR_UNSUPPORTED);
    in.skip_space();
    if (in.peek() == "BINARY") in.fail("OFF BINARY is not read", VOX_ERROR_UNSUPPORTED);

    const auto vertices = in.count("number of vertices", 6, max_count);
    in.skip_space();
    const auto faces = in.count("number of faces", 4, max_count);
    in.skip_line(); // the number of edges, which is often wrong

    data.positions.reserve(3 * vertices);
    for (std::uint64_t v = 0; v < vertices; ++v) {
        for (int k = 0; k < 3; ++k) {
            in.skip_space();
            data.positions.push_back(in.real("a coordinate"));
        }
        in.skip_line(); // normal, colour, texture
    }
    for (std::uint64_t f = 0; f < faces; ++f) {
        in.skip_space();
        const auto corners = in.count("number of corners", 2, max_count);
        std::uint32_t first = 0, last = 0;
        for (std::uint64_t i = 0; i < corners; ++i) {
            in.skip_space();
            const auto vertex = in.integer<std::uint64_t>("a vertex number");
            if (vertex >= vertices)
                in.fail(format("expected a vertex number from 0 to %llu, found %llu",
                               llu(std::max<std::uint64_t>(vertices, 1) - 1), llu(vertex)));
            const auto corner = static_cast<std::uint32_t>(vertex);
            if (i == 0) first = corner;
            if (i >= 2) data.triangles.insert(data.triangles.end(), {first, last, corner}); // a fan
            last = corner;
        }
        if (corners < 3) ++data.skipped_elements; // points and lines
        in.skip_line();                           // colour
    }
    in.skip_space();
    if (!in.done()) in.expected("the end of the file after the last face");
    if (data.triangles.size() / 3 > max_count) in.fail("too many triangles", VOX_ERROR_LIMIT);
    if (data.triangles.empty()) in.fail("expected triangles, found none");
    return data;
}

} // namespace vox::io
