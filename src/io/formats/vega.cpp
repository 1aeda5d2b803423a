// Vega .veg (F. S. Sin, D. Schroeder, J. Barbic, "Vega: non-linear FEM deformable object simulator", Computer
// Graphics Forum 32(1), 2013; user's manual, "Volumetric mesh file formats").
#include "io/formats/node_numbers.hpp"
#include "io/formats/readers.hpp"

namespace vox::io {

MeshData read_vega(const File& file) {
    MeshData data;
    Scanner in(file, '#');
    NodeNumbers numbers("vertex", "vertices");
    Cells cells(file);
    bool have_vertices = false, have_elements = false;
    for (in.skip_space(); !in.done(); in.skip_space()) {
        const std::string keyword(in.peek());
        if (!keyword.starts_with('*')) in.expected("a section (*...)");
        if (keyword == "*INCLUDE") in.unsupported("*INCLUDE of another file is not read");
        in.skip_line();
        if (keyword == "*VERTICES") {
            if (have_vertices) in.fail("expected one section *VERTICES, found a second one");
            have_vertices = true;
            in.skip_space();
            if (in.peek() == "*INCLUDE") in.unsupported("*INCLUDE of another file is not read");
            const auto count = in.count("number of vertices", 7, max_count);
            const auto dimension = in.integer<std::int64_t>("number of dimensions");
            if (dimension != 3) in.fail("expected 3 dimensions, found %lld", lld(dimension));
            in.skip_line();
            data.positions.reserve(3 * count);
            for (std::uint64_t i = 0; i < count; ++i) {
                in.skip_space();
                numbers.add(in.integer<std::int64_t>("a vertex number"));
                for (int k = 0; k < 3; ++k) data.positions.push_back(in.real("a coordinate"));
                in.skip_line();
            }
            numbers.finish(in);
        } else if (keyword == "*ELEMENTS") {
            if (!have_vertices) in.fail("expected *VERTICES before *ELEMENTS");
            have_elements = true;
            in.skip_space();
            const std::string kind(in.word("an element kind (TET or CUBIC)"));
            const bool tets = kind == "TET" || kind == "TETS";
            if (!tets && kind != "CUBIC")
                in.fail("expected an element kind (TET or CUBIC), found \"%s\"", printable(kind).c_str());
            in.skip_space();
            const auto count = in.count("number of elements", 9, max_count);
            const auto corners = in.integer<std::int64_t>("number of vertices per element");
            if (corners != (tets ? 4 : 8))
                in.fail("expected %d vertices per element, found %lld", tets ? 4 : 8, lld(corners));
            in.skip_line();
            const CellKind cell = tets ? CellKind::tet : CellKind::hexahedron;
            const bool wanted = cells.corners_of(cell) > 0;
            if (tets) data.tets.reserve(data.tets.size() + 4 * count);
            for (std::uint64_t e = 0; e < count; ++e) {
                in.skip_space();
                in.integer<std::int64_t>("an element number");
                std::uint32_t nodes[most_corners];
                for (std::int64_t i = 0; i < corners; ++i) {
                    const auto number = in.integer<std::int64_t>("a vertex number");
                    nodes[i] = numbers.vertex_of(number, in);
                }
                in.line_end();
                if (wanted) cells.add(cell, "cubes", static_cast<std::uint64_t>(corners), nodes, 0, data);
            }
            if (!wanted) cells.skip(cell, "cubes", count, data);
        }
        // Skips the lines of sections that are not needed (*MATERIAL, *SET ...).
        const bool needed = keyword == "*VERTICES" || keyword == "*ELEMENTS";
        for (in.skip_space(); !in.done() && !in.peek().starts_with('*'); in.skip_space()) {
            if (needed) in.expected("a section (*...)");
            in.skip_line();
        }
    }
    if (!have_vertices) in.fail("expected a section *VERTICES, found none");
    if (!have_elements) in.fail("expected a section *ELEMENTS, found none");
    return cells.finished(std::move(data));
}

} // namespace vox::io
