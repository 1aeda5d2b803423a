// Medit .mesh, ASCII (P. Frey, "MEDIT: an interactive mesh visualization software", INRIA RT-0253, 2001).
#include "io/formats/readers.hpp"
#include "io/formats/regions.hpp"

#include <charconv>
#include <optional>

namespace vox::io {
namespace {

struct Section {
    std::string_view keyword;
    CellKind cell;
    const char* name;
    std::uint64_t (*nodes)(std::uint64_t order);
    std::uint64_t order = 1;
};

using Order = std::uint64_t;
constexpr Section sections[] = {
    {"Tetrahedra", CellKind::tet, "tetrahedra", [](Order p) { return (p + 1) * (p + 2) * (p + 3) / 6; }},
    {"Triangles", CellKind::triangle, "triangles", [](Order p) { return (p + 1) * (p + 2) / 2; }},
    {"Edges", CellKind::other, "edges", [](Order p) { return p + 1; }},
    {"Quadrilaterals", CellKind::other, "quadrilaterals", [](Order p) { return (p + 1) * (p + 1); }},
    {"Hexahedra", CellKind::hexahedron, "hexahedra", [](Order p) { return (p + 1) * (p + 1) * (p + 1); }},
    {"Hexaedra", CellKind::hexahedron, "hexahedra", [](Order p) { return (p + 1) * (p + 1) * (p + 1); }},
    {"Prisms", CellKind::wedge, "prisms", [](Order p) { return (p + 1) * (p + 1) * (p + 2) / 2; }},
    {"Pyramids", CellKind::pyramid, "pyramids", [](Order p) { return (p + 1) * (p + 2) * (2 * p + 3) / 6; }}};

// The elements that follow a keyword: Tetrahedra, TetrahedraP2, HexahedraQ3 (libMeshb, gmf). `behind` is what
// follows that, as in TetrahedraP2Ordering.
std::optional<Section> section_of(std::string_view keyword, std::string_view& behind) {
    constexpr Order most = 100; // so that no number of nodes overflows
    for (Section section : sections) {
        if (!keyword.starts_with(section.keyword)) continue;
        behind = keyword.substr(section.keyword.size());
        if (behind.starts_with('P') || behind.starts_with('Q')) {
            const char* const end = behind.data() + behind.size();
            const auto [stop, error] = std::from_chars(behind.data() + 1, end, section.order);
            if (error != std::errc{} || section.order < 1 || section.order > most) return std::nullopt;
            behind = {stop, static_cast<std::size_t>(end - stop)};
        }
        return section;
    }
    return std::nullopt;
}

bool is_keyword(std::string_view word) {
    return !word.empty() && ((word[0] >= 'A' && word[0] <= 'Z') || (word[0] >= 'a' && word[0] <= 'z'));
}

class MeditReader {
public:
    explicit MeditReader(const File& file) : in_(file, '#'), cells_(file) {}

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
        return cells_.finished(std::move(data_));
    }

private:
    template <class Integer>
    Integer integer(const char* what) {
        in_.skip_space();
        return in_.integer<Integer>(what);
    }

    void read_section(const std::string& keyword) {
        std::string_view behind;
        const std::optional<Section> section = section_of(keyword, behind);
        if (keyword == "Dimension") {
            const auto dimension = in_.integer<int>("a dimension");
            if (dimension != 3) in_.fail("expected dimension 3, found %d", dimension);
            have_dimension_ = true;
        } else if (keyword == "Vertices") {
            read_vertices();
        } else if (section && behind.empty()) {
            read_elements(*section);
        } else if (section && behind == "Ordering" && cells_.corners_of(section->cell)) {
            check_ordering(*section, keyword);
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

    // The coordinates of the nodes of an element, in the file's order, times the order of the element:
    // barycentric ones, of a prism its triangle's and the height, of a hexahedron or pyramid Cartesian ones.
    void check_ordering(const Section& section, const std::string& keyword) {
        static constexpr std::string_view all_corners[] = {"1000"
                                                           "0100"
                                                           "0010"
                                                           "0001",
                                                           "100"
                                                           "010"
                                                           "001",
                                                           "000"
                                                           "100"
                                                           "110"
                                                           "010"
                                                           "001"
                                                           "101"
                                                           "111"
                                                           "011",
                                                           "1000"
                                                           "0100"
                                                           "0010"
                                                           "1001"
                                                           "0101"
                                                           "0011",
                                                           "000"
                                                           "100"
                                                           "110"
                                                           "010"
                                                           "??1"};
        const std::string_view corners = all_corners[static_cast<std::size_t>(section.cell)];
        const std::uint64_t nodes = section.nodes(section.order);
        const std::uint64_t coordinates = corners.size() / corner_count(section.cell);
        const auto count = in_.count("number of nodes", 2 * static_cast<std::size_t>(coordinates), max_count);
        if (count != nodes) in_.fail("expected %llu nodes, found %llu", llu(nodes), llu(count));
        for (std::uint64_t i = 0; i < nodes * coordinates; ++i) {
            const auto found = integer<std::int64_t>("a coordinate of a node");
            if (i >= corners.size() || corners[i] == '?') continue;
            if (found != (corners[i] == '1' ? static_cast<std::int64_t>(section.order) : 0))
                in_.unsupported("%s: elements are read whose corners come first", keyword.c_str());
        }
    }

    void read_elements(const Section& section) {
        const std::uint64_t nodes = section.nodes(section.order), wanted = cells_.corners_of(section.cell);
        const auto count =
            in_.count("number of elements", 2 * static_cast<std::size_t>(nodes + 1), max_count);
        if (section.cell == CellKind::tet)
            data_.tets.reserve(data_.tets.size() + 4 * static_cast<std::size_t>(count));
        for (std::uint64_t e = 0; e < count; ++e) {
            std::uint32_t corners[most_corners];
            for (std::uint64_t i = 0; i < nodes; ++i) {
                const auto number = integer<std::int64_t>("a vertex number");
                if (i >= wanted) continue;
                if (number < 1 || number > static_cast<std::int64_t>(max_count))
                    in_.fail("expected a vertex number, counted from 1, found %lld", lld(number));
                corners[i] = static_cast<std::uint32_t>(number - 1);
                if (corners[i] >= highest_) {
                    highest_ = corners[i];
                    highest_at_ = in_.offset();
                }
            }
            const std::int32_t region = region_of(integer<std::int64_t>("a reference"));
            if (wanted) cells_.add(section.cell, section.name, nodes, corners, region, data_);
        }
        if (!wanted) cells_.skip(section.cell, section.name, count, data_);
    }

    Scanner in_;
    MeshData data_;
    Cells cells_;
    bool have_vertices_ = false, have_dimension_ = false;
    // The highest corner and where it is. It is checked at the end, as sections may come in any order.
    std::uint32_t highest_ = 0;
    std::size_t highest_at_ = 0;
};

} // namespace

MeshData read_medit(const File& file) { return MeditReader(file).read(); }

} // namespace vox::io
