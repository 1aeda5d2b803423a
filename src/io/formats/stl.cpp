// STL, text and binary (3D Systems, StereoLithography Interface Specification, 1989). Normals and attributes
// are skipped: the order of the corners says where outside is.
#include "io/formats/readers.hpp"
#include "io/formats/surface_builder.hpp"

#include <algorithm>
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
            skip_name();
            surface_.begin_mesh();
            bool ended = false;
            while (!ended && !in_.done() && !next_is("solid")) {
                ended = accept_end("solid");
                if (!ended && !in_.done()) read_facet();
            }
            if (!ended) continue;
            if (one_line_)
                while (!in_.at_line_end() && !next_is("solid")) in_.word("a name");
            else
                in_.skip_line(); // the name again
        }
        return surface_.finish();
    }

private:
    bool next_is(const std::string& word) {
        in_.skip_space();
        return same_word(in_.peek(), word);
    }
    void demand(const std::string& word) {
        if (!next_is(word)) in_.expected(word.c_str());
        in_.word(word.c_str());
    }
    // Passes "endsolid", which some programs write as two words.
    bool accept_end(const std::string& of) {
        if (next_is("end")) {
            demand("end");
            demand(of);
            return true;
        }
        const bool found = next_is("end" + of);
        if (found) demand("end" + of);
        return found;
    }
    void demand_end(const std::string& of) {
        if (!accept_end(of)) in_.expected(("end" + of).c_str());
    }
    // The rest of the line, or what is before the first facet where that is in the same line.
    void skip_name() {
        while (!in_.at_line_end()) {
            const std::size_t here = in_.offset();
            const bool facet = next_is("facet");
            in_.word("a name");
            if (!facet || !same_word(in_.peek(), "normal")) continue;
            one_line_ = true;
            return in_.seek(here);
        }
    }
    void read_facet() {
        if (!next_is("facet")) in_.expected("facet or endsolid");
        in_.word("facet");
        while (!in_.at_line_end() && !next_is("outer")) in_.word("a normal"); // which may be "nan nan nan"
        demand("outer");
        demand("loop");
        double p[3][3];
        for (auto& corner : p) {
            demand("vertex");
            for (double& x : corner) {
                in_.skip_space();
                x = in_.real("a coordinate");
            }
        }
        demand_end("loop");
        demand_end("facet");
        if (!surface_.begin_element()) return;
        const std::uint32_t a = surface_.vertex(p[0]), b = surface_.vertex(p[1]);
        surface_.triangle(a, b, surface_.vertex(p[2]));
    }

    Scanner in_;
    SurfaceBuilder surface_;
    bool one_line_ = false; // a solid and its facets share lines
};

MeshData read_stl_binary(const File& file, std::uint32_t mesh_index) {
    Scanner in(file);
    in.count_bytes(true);
    in.take(stl_head - 4, "a header");
    const std::size_t counted_at = in.offset();
    const std::uint64_t facets = in.binary<std::uint32_t>(host_is_big_endian, "the number of triangles");
    in.check_count("number of triangles", facets, stl_facet, max_count, counted_at);
    const std::uint64_t more = in.remaining() - facets * stl_facet;
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
    MeshData data = surface.finish();
    if (more > 0)
        data.notes.push_back(format("%llu byte%s behind the last triangle %s left out", llu(more),
                                    more == 1 ? "" : "s", more == 1 ? "was" : "were"));
    return data;
}

// Whether the file is long enough for the number of triangles of a binary file, and this is no text.
bool may_be_binary(std::string_view bytes) {
    if (bytes.size() < stl_head + stl_facet) return false;
    const std::string_view count = bytes.substr(stl_head - 4, 4);
    const auto facets = std::uint64_t{load<std::uint32_t>(count.data(), host_is_big_endian)};
    const bool is_text =
        std::all_of(count.begin(), count.end(), [](char c) { return c >= ' ' || (c >= '\t' && c <= '\r'); });
    return !is_text && facets > 0 && facets <= (bytes.size() - stl_head) / stl_facet;
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
    if (!is_binary_stl(file.bytes) && is_text_stl(file.bytes) && !may_be_binary(file.bytes))
        return StlText(file, mesh_index).read();
    return read_stl_binary(file, mesh_index);
}

} // namespace vox::io
