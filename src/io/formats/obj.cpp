// Wavefront OBJ (Advanced Visualizer manual, appendix B1): vertices and polygons. Normals, texture
// coordinates, materials, curves and surfaces are skipped.
#include "io/formats/readers.hpp"
#include "io/formats/surface_builder.hpp"

namespace vox::io {
namespace {

class ObjReader {
public:
    ObjReader(const File& file, std::uint32_t mesh_index)
        : in_(file, '#'), surface_(file.name, surface_limits(file.bytes.size()), mesh_index) {}

    MeshData read() {
        for (in_.skip_space(); !in_.done(); in_.skip_space()) {
            const std::string_view keyword = in_.word("a keyword");
            if (keyword == "v")
                pass_vertex();
            else if (keyword == "f")
                read_face();
            else if (keyword == "o" || keyword == "g" || keyword == "usemtl")
                name_mesh(keyword[0]);
            else if (keyword == "l")
                skip_element();
            else if (keyword == "p") // of a cloud, which is its vertices
                surface_.skip(1);
            else if (!is_letter(keyword[0]))
                refuse_keyword(keyword);
            skip_line();
        }
        return surface_.finish();
    }

private:
    static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

    [[noreturn]] void refuse_keyword(std::string_view keyword) {
        in_.seek(in_.offset() - keyword.size());
        in_.expected("a keyword");
    }

    // Whether the line ends here. A backslash at its end continues it.
    bool at_end() {
        while (!in_.at_line_end()) {
            if (!in_.rest().starts_with('\\') || in_.peek() != "\\") return false;
            in_.skip_line();
        }
        return true;
    }
    void skip_line() {
        while (!at_end()) in_.word("a word");
        in_.skip_line();
    }
    double real(const char* what) {
        if (at_end()) in_.expected(what);
        return in_.real(what);
    }

    void pass_vertex() {
        ++passed_;
        if (!read_all_) read_vertex();
    }
    // Positive numbers name vertices wherever they are: reads those below, once.
    void read_vertices_below() {
        const std::size_t here = in_.offset();
        skip_line();
        for (in_.skip_space(); !in_.done(); in_.skip_space()) {
            if (in_.word("a keyword") == "v") read_vertex();
            skip_line();
        }
        in_.seek(here);
        read_all_ = true;
    }

    void read_vertex() {
        double p[3];
        for (double& x : p) x = real("a coordinate");
        // A fourth number alone is a weight, by which the position is divided; three more are a colour.
        if (!at_end()) {
            const std::size_t at = in_.offset();
            const double weight = in_.real("a weight or the end of the line");
            if (weight != 1 && at_end())
                for (double& x : p) {
                    x /= weight;
                    if (!std::isfinite(x)) {
                        in_.seek(at);
                        in_.expected("a weight by which coordinates can be divided");
                    }
                }
        }
        surface_.point(p);
    }

    void read_face() {
        const bool wanted = surface_.begin_element();
        while (!at_end()) {
            const std::uint32_t point = read_corner();
            if (wanted) surface_.corner(surface_.vertex_of(point));
        }
        if (wanted) surface_.end_polygon();
    }

    // A vertex number, and numbers of other things behind slashes. Negative numbers count from the last
    // vertex.
    std::uint32_t read_corner() {
        const std::string_view word = in_.peek();
        const char* const end = word.data() + word.size();
        std::int64_t number = 0;
        const auto [stop, error] = std::from_chars(word.data(), end, number);
        if (error != std::errc{} || (stop != end && *stop != '/')) in_.expected("a vertex number");
        const auto points = [&] { return static_cast<std::int64_t>(surface_.points()); };
        const bool backwards = number < 0;
        if (backwards) number += passed_ + 1;
        if (number > points() && !read_all_) read_vertices_below();
        if (number < 1 || number > points())
            in_.fail("expected a vertex number from 1 to %lld%s, found %s",
                     lld(backwards ? passed_ : points()), backwards ? ", of the vertices above" : "",
                     printable(word).c_str());
        in_.word("a vertex number");
        return static_cast<std::uint32_t>(number - 1);
    }

    // Objects, groups and materials each begin a mesh; the same name once more does not.
    void name_mesh(char kind) {
        std::string_view& name = kind == 'o' ? object_ : kind == 'g' ? group_ : material_;
        std::string_view line = in_.rest();
        line = line.substr(0, line.find_first_of("\r\n"));
        if (line != name) surface_.begin_mesh();
        name = line;
    }

    void skip_element() {
        if (surface_.begin_element()) surface_.skip(1);
    }

    Scanner in_;
    SurfaceBuilder surface_;
    std::int64_t passed_ = 0;                    // vertices above
    bool read_all_ = false;                      // those below as well
    std::string_view object_, group_, material_; // the names in force
};

} // namespace

MeshData read_obj(const File& file, std::uint32_t mesh_index) { return ObjReader(file, mesh_index).read(); }

} // namespace vox::io
