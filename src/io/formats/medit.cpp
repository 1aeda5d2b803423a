// Medit .mesh, ASCII (P. Frey, "MEDIT: an interactive mesh visualization software", INRIA RT-0253, 2001).
#include "io/formats/readers.hpp"

namespace vox::io {
namespace {

struct Section {
    const char* keyword;
    int nodes;
    Cell cell;
    const char* name;
};

constexpr Section sections[] = {{"Tetrahedra", 4, Cell::tet, "tetrahedra"},
                                {"TetrahedraP2", 10, Cell::high_tet, "tetrahedra of ten nodes"},
                                {"Triangles", 3, Cell::triangle, "triangles"},
                                {"TrianglesP2", 6, Cell::triangle, "triangles of six nodes"},
                                {"Edges", 2, Cell::other, "edges"},
                                {"Quadrilaterals", 4, Cell::other, "quadrilaterals"},
                                {"Hexahedra", 8, Cell::volume, "hexahedra"},
                                {"Hexaedra", 8, Cell::volume, "hexahedra"},
                                {"Prisms", 6, Cell::volume, "prisms"},
                                {"Pyramids", 5, Cell::volume, "pyramids"}};

bool is_keyword(std::string_view word) {
    return !word.empty() && ((word[0] >= 'A' && word[0] <= 'Z') || (word[0] >= 'a' && word[0] <= 'z'));
}

} // namespace

MeshData read_medit(const File& file) {
    MeshData data;
    data.format = VOX_IO_FORMAT_MEDIT;
    Scanner in(file, '#');
    Skipped skipped;
    bool have_vertices = false, have_dimension = false;

    const auto next = [&] { in.skip_space(); };
    next();
    if (!in.accept("MeshVersionFormatted")) in.expected("MeshVersionFormatted");
    next();
    const auto version = in.integer<int>("a version");
    if (version < 1 || version > 4)
        in.fail(format("version %d: the versions read are 1 to 4", version), VOX_ERROR_UNSUPPORTED);

    // Corners are checked against the number of vertices at the end: sections stand in any order.
    std::uint32_t highest = 0;
    std::size_t highest_at = 0;
    for (next(); !in.done(); next()) {
        const std::string keyword(in.peek());
        if (!is_keyword(keyword)) in.expected("a keyword");
        in.word("a keyword");
        if (keyword == "End") break;
        next();
        if (keyword == "Dimension") {
            const auto dimension = in.integer<int>("a dimension");
            if (dimension != 3) in.fail(format("expected dimension 3, found %d", dimension));
            have_dimension = true;
        } else if (keyword == "Vertices") {
            if (have_vertices) in.fail("expected one section Vertices, found a second one");
            if (!have_dimension) in.fail("expected Dimension before Vertices");
            have_vertices = true;
            const auto count = in.count("number of vertices", 8, max_count);
            data.positions.reserve(3 * count);
            for (std::uint64_t i = 0; i < count; ++i) {
                for (int k = 0; k < 3; ++k) {
                    next();
                    data.positions.push_back(in.real("a coordinate"));
                }
                next();
                in.integer<std::int64_t>("a reference");
            }
        } else if (const Section* section =
                       std::find_if(std::begin(sections), std::end(sections),
                                    [&](const Section& candidate) { return keyword == candidate.keyword; });
                   section != std::end(sections)) {
            const auto count =
                in.count("number of elements", 2 * static_cast<std::size_t>(section->nodes + 1), max_count);
            const bool tets = section->cell == Cell::tet || section->cell == Cell::high_tet;
            const int wanted = tets ? 4 : section->cell == Cell::triangle ? 3 : 0;
            std::vector<std::uint32_t>& corners = tets ? data.tets : data.triangles;
            if (wanted) corners.reserve(corners.size() + static_cast<std::size_t>(wanted) * count);
            for (std::uint64_t e = 0; e < count; ++e) {
                for (int i = 0; i < section->nodes; ++i) {
                    next();
                    const auto number = in.integer<std::int64_t>("a vertex number");
                    if (i >= wanted) continue;
                    if (number < 1 || number > static_cast<std::int64_t>(max_count))
                        in.fail(format("expected a vertex number, counted from 1, found %lld",
                                       static_cast<long long>(number)));
                    corners.push_back(static_cast<std::uint32_t>(number - 1));
                    if (corners.back() >= highest) {
                        highest = corners.back();
                        highest_at = in.offset();
                    }
                }
                next();
                in.integer<std::int64_t>("a reference");
            }
            if (!wanted) skipped.add(section->cell, section->name, count);
            if (section->cell == Cell::high_tet) data.second_order_tets += count;
        } else {
            // Corners, Ridges, Normals and what else there may be: numbers up to the next keyword.
            while (!in.done() && !is_keyword(in.peek())) {
                in.word("a number");
                next();
            }
        }
    }
    if (!have_vertices) in.fail("expected a section Vertices, found none");
    if (highest_at > 0 && highest >= data.positions.size() / 3) {
        in.seek(highest_at);
        in.fail(format("expected a vertex number from 1 to %zu, found %llu", data.positions.size() / 3,
                       static_cast<unsigned long long>(highest) + 1));
    }
    skipped.tell(data);
    require_tets(data, file.name);
    return data;
}

} // namespace vox::io
