// STL, text and binary (3D Systems, StereoLithography Interface Specification, 1989). Normals and attributes
// are skipped: the order of the corners says where outside is.
#include "io/formats/readers.hpp"
#include "io/formats/surface_builder.hpp"

#include <cctype>

namespace vox::io {
namespace {

constexpr std::size_t stl_head = 84, stl_facet = 50; // bytes: name and count; normal, corners, attribute

bool same_word(std::string_view word, std::string_view lower_case) {
    return std::equal(word.begin(), word.end(), lower_case.begin(), lower_case.end(),
                      [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

class StlText {
public:
    StlText(const File& file, std::uint32_t mesh_index)
        : in_(file), surface_(file.name, surface_limits(file.bytes.size()), mesh_index) {}

    MeshData read() {
        for (in_.skip_space(); !in_.done(); in_.skip_space()) {
            demand("solid");
            in_.skip_line(); // its name
            surface_.begin_mesh();
            while (!next_is("endsolid")) read_facet();
            in_.skip_line();
        }
        return surface_.finish();
    }

private:
    bool next_is(const char* word) {
        in_.skip_space();
        return same_word(in_.peek(), word);
    }
    void demand(const char* word) {
        if (!next_is(word)) in_.expected(word);
        in_.word(word);
    }
    void read_facet() {
        if (!next_is("facet")) in_.expected("facet or endsolid");
        in_.skip_line(); // its normal, which may be "nan nan nan"
        demand("outer");
        demand("loop");
        double p[3][3];
        for (auto& corner : p) {
            demand("vertex");
            for (double& x : corner) x = in_.real("a coordinate");
        }
        demand("endloop");
        demand("endfacet");
        if (!surface_.begin_element()) return;
        const std::uint32_t a = surface_.vertex(p[0]), b = surface_.vertex(p[1]);
        surface_.triangle(a, b, surface_.vertex(p[2]));
    }

    Scanner in_;
    SurfaceBuilder surface_;
};

MeshData read_stl_binary(const File& file, std::uint32_t mesh_index) {
    Scanner in(file);
    in.count_bytes(true);
    in.take(stl_head - 4, "a header");
    const std::size_t counted_at = in.offset();
    const std::uint64_t facets = in.binary<std::uint32_t>(host_is_big_endian, "the number of triangles");
    in.check_count("number of triangles", facets, stl_facet, max_count, counted_at);
    if (in.remaining() != facets * stl_facet)
        in.fail("expected the end of the file after %llu triangles, found %llu bytes more", llu(facets),
                llu(in.remaining() - facets * stl_facet));
    SurfaceBuilder surface(file.name, surface_limits(file.bytes.size()), mesh_index);
    for (std::uint64_t f = 0; f < facets; ++f) {
        const char* const bytes = in.take(stl_facet, "a triangle");
        std::uint32_t corners[3];
        if (!surface.begin_element()) continue;
        for (std::size_t i = 0; i < 3; ++i) {
            double p[3];
            for (std::size_t k = 0; k < 3; ++k) {
                p[k] = static_cast<double>(load<float>(bytes + 12 + 12 * i + 4 * k, host_is_big_endian));
                if (!std::isfinite(p[k]))
                    in.fail_at(in.offset() - stl_facet + 12 + 12 * i + 4 * k,
                               "triangle %llu: expected a coordinate, found %g, which is not finite", llu(f),
                               p[k]);
            }
            corners[i] = surface.vertex(p);
        }
        surface.triangle(corners[0], corners[1], corners[2]);
    }
    return surface.finish();
}

} // namespace

bool is_binary_stl(std::string_view bytes) {
    return bytes.size() >= stl_head &&
           bytes.size() - stl_head ==
               stl_facet *
                   std::uint64_t{load<std::uint32_t>(bytes.data() + stl_head - 4, host_is_big_endian)};
}

bool is_text_stl(std::string_view bytes) {
    const File file{"", bytes};
    Scanner in(file);
    in.skip_space();
    return same_word(in.peek(), "solid");
}

MeshData read_stl(const File& file, std::uint32_t mesh_index) {
    // Many binary files begin with "solid" too, so their size decides first.
    if (!is_binary_stl(file.bytes) && is_text_stl(file.bytes)) return StlText(file, mesh_index).read();
    return read_stl_binary(file, mesh_index);
}

} // namespace vox::io
