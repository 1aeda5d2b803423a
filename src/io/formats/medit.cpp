// Medit .mesh, ASCII (P. Frey, "MEDIT: an interactive mesh visualization software", INRIA RT-0253, 2001).
#include "io/formats/readers.hpp"
#include "io/formats/regions.hpp"

namespace vox::io {
namespace {

struct Section {
    const char* keyword;
    int nodes;
    CellKind cell;
    const char* name;
};

constexpr Section sections[] = {{"Tetrahedra", 4, CellKind::tet, "tetrahedra"},
                                {"TetrahedraP2", 10, CellKind::high_tet, "tetrahedra of ten nodes"},
                                {"Triangles", 3, CellKind::triangle, "triangles"},
                                {"TrianglesP2", 6, CellKind::triangle, "triangles of six nodes"},
                                {"Edges", 2, CellKind::other, "edges"},
                                {"Quadrilaterals", 4, CellKind::other, "quadrilaterals"},
                                {"Hexahedra", 8, CellKind::volume, "hexahedra"},
                                {"Hexaedra", 8, CellKind::volume, "hexahedra"},
                                {"Prisms", 6, CellKind::volume, "prisms"},
                                {"Pyramids", 5, CellKind::volume, "pyramids"}};

bool is_keyword(std::string_view word) {
    return !word.empty() && ((word[0] >= 'A' && word[0] <= 'Z') || (word[0] >= 'a' && word[0] <= 'z'));
}

class MeditReader {
public:
    explicit MeditReader(const File& file) : file_(file), in_(file, '#') {}

    MeshData read() {
        in_.skip_space();
        if (!in_.accept("MeshVersionFormatted")) in_.expected("MeshVersionFormatted");
        const auto version = integer<int>("a version");
        if (version < 1 || version > 4) in_.unsupported("version %d: the versions read are 1 to 4", version);
        for (in_.skip_space(); !in_.done(); in_.skip_space()) {
            const std::string keyword(in_.peek());
            if (!is_keyword(keyword)) in_.expected("a keyword");
            in_.word("a keyword");
            if (keyword == "End") break;
            in_.skip_space();
            read_section(keyword);
        }
        if (!have_vertices_) in_.fail("expected a section Vertices, found none");
        const std::size_t vertices = data_.positions.size() / 3;
        if (highest_at_ > 0 && highest_ >= vertices)
            in_.fail_at(highest_at_, "expected a vertex number from 1 to %zu, found %llu", vertices,
                        llu(highest_) + 1);
        return finished(std::move(data_), skipped_, file_.name);
    }

private:
    template <class Integer>
    Integer integer(const char* what) {
        in_.skip_space();
        return in_.integer<Integer>(what);
    }

    void read_section(const std::string& keyword) {
        const auto* section = std::find_if(std::begin(sections), std::end(sections),
                                           [&](const Section& s) { return keyword == s.keyword; });
        if (keyword == "Dimension") {
            const auto dimension = in_.integer<int>("a dimension");
            if (dimension != 3) in_.fail("expected dimension 3, found %d", dimension);
            have_dimension_ = true;
        } else if (keyword == "Vertices") {
            read_vertices();
        } else if (section != std::end(sections)) {
            read_elements(*section);
        } else {
            // Corners, Ridges, Normals and others hold numbers up to the next keyword.
            for (; !in_.done() && !is_keyword(in_.peek()); in_.skip_space()) in_.word("a number");
        }
    }

    void read_vertices() {
        if (have_vertices_) in_.fail("expected one section Vertices, found a second one");
        if (!have_dimension_) in_.fail("expected Dimension before Vertices");
        have_vertices_ = true;
        const auto count = in_.count("number of vertices", 8, max_count);
        data_.positions.reserve(3 * count);
        for (std::uint64_t i = 0; i < count; ++i) {
            for (int k = 0; k < 3; ++k) {
                in_.skip_space();
                data_.positions.push_back(in_.real("a coordinate"));
            }
            integer<std::int64_t>("a reference");
        }
    }

    void read_elements(const Section& section) {
        const auto count =
            in_.count("number of elements", 2 * static_cast<std::size_t>(section.nodes + 1), max_count);
        const bool tets = section.cell == CellKind::tet || section.cell == CellKind::high_tet;
        const int wanted = tets ? 4 : section.cell == CellKind::triangle ? 3 : 0;
        std::vector<std::uint32_t>& corners = tets ? data_.tets : data_.triangles;
        if (wanted) corners.reserve(corners.size() + static_cast<std::size_t>(wanted) * count);
        for (std::uint64_t e = 0; e < count; ++e) {
            for (int i = 0; i < section.nodes; ++i) {
                const auto number = integer<std::int64_t>("a vertex number");
                if (i >= wanted) continue;
                if (number < 1 || number > static_cast<std::int64_t>(max_count))
                    in_.fail("expected a vertex number, counted from 1, found %lld", lld(number));
                corners.push_back(static_cast<std::uint32_t>(number - 1));
                if (corners.back() >= highest_) {
                    highest_ = corners.back();
                    highest_at_ = in_.offset();
                }
            }
            const std::int32_t region = region_of(integer<std::int64_t>("a reference"));
            if (tets) data_.tet_regions.push_back(region);
        }
        if (!wanted) skipped_.add(section.cell, section.name, count);
        if (section.cell == CellKind::high_tet) data_.second_order_tets += count;
    }

    const File& file_;
    Scanner in_;
    MeshData data_;
    Skipped skipped_;
    bool have_vertices_ = false, have_dimension_ = false;
    // The highest corner and where it is. It is checked at the end, as sections may come in any order.
    std::uint32_t highest_ = 0;
    std::size_t highest_at_ = 0;
};

} // namespace

MeshData read_medit(const File& file) { return MeditReader(file).read(); }

} // namespace vox::io
