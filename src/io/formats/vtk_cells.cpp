#include "io/formats/vtk_cells.hpp"

namespace vox::io {

static constexpr unsigned voxel = 11; // a hexahedron whose corners are in the order of a lattice

VtkCellType vtk_cell_type(std::uint64_t type) {
    struct Row {
        unsigned type;
        VtkCellType is;
    };
    static constexpr Row rows[] = {{5, {CellKind::triangle, 3, "triangle"}},
                                   {22, {CellKind::triangle, 6, "quadratic triangle"}},
                                   {34, {CellKind::triangle, 7, "biquadratic triangle"}},
                                   {61, {CellKind::triangle, 3, "triangle of higher order", true}},
                                   {69, {CellKind::triangle, 3, "Lagrange triangle", true}},
                                   {76, {CellKind::triangle, 3, "Bezier triangle", true}},
                                   {10, {CellKind::tet, 4, "tetrahedron"}},
                                   {24, {CellKind::tet, 10, "quadratic tetrahedron"}},
                                   {64, {CellKind::tet, 4, "tetrahedron of higher order", true}},
                                   {71, {CellKind::tet, 4, "Lagrange tetrahedron", true}},
                                   {78, {CellKind::tet, 4, "Bezier tetrahedron", true}},
                                   {voxel, {CellKind::hexahedron, 8, "voxels"}},
                                   {12, {CellKind::hexahedron, 8, "hexahedra"}},
                                   {25, {CellKind::hexahedron, 20, "quadratic hexahedra"}},
                                   {29, {CellKind::hexahedron, 27, "triquadratic hexahedra"}},
                                   {33, {CellKind::hexahedron, 24, "biquadratic hexahedra"}},
                                   {67, {CellKind::hexahedron, 8, "hexahedra of higher order", true}},
                                   {72, {CellKind::hexahedron, 8, "Lagrange hexahedra", true}},
                                   {79, {CellKind::hexahedron, 8, "Bezier hexahedra", true}},
                                   {13, {CellKind::wedge, 6, "wedges"}},
                                   {26, {CellKind::wedge, 15, "quadratic wedges"}},
                                   {31, {CellKind::wedge, 12, "quadratic-linear wedges"}},
                                   {32, {CellKind::wedge, 18, "biquadratic wedges"}},
                                   {65, {CellKind::wedge, 6, "wedges of higher order", true}},
                                   {73, {CellKind::wedge, 6, "Lagrange wedges", true}},
                                   {80, {CellKind::wedge, 6, "Bezier wedges", true}},
                                   {14, {CellKind::pyramid, 5, "pyramids"}},
                                   {27, {CellKind::pyramid, 13, "quadratic pyramids"}},
                                   {37, {CellKind::pyramid, 19, "triquadratic pyramids"}},
                                   {66, {CellKind::pyramid, 5, "pyramids of higher order", true}},
                                   {74, {CellKind::pyramid, 5, "Lagrange pyramids", true}},
                                   {81, {CellKind::pyramid, 5, "Bezier pyramids", true}},
                                   {15, {CellKind::volume, 0, "pentagonal prisms"}},
                                   {16, {CellKind::volume, 0, "hexagonal prisms"}},
                                   {41, {CellKind::volume, 0, "convex point sets"}},
                                   {42, {CellKind::volume, 0, "polyhedra"}}};
    for (const Row& row : rows)
        if (row.type == type) return row.is;
    return {CellKind::other, 0, "other cells"};
}

void take_vtk_cells(const VtkPolygons& list, const std::vector<std::uint64_t>& types,
                    const RegionArray& regions, std::uint64_t first_vertex, std::uint64_t vertex_count,
                    MeshData& data, Cells& cells, const VtkFail& fail) {
    const bool have_regions = regions.of_cells().size() == types.size();
    for (std::size_t c = 0; c < types.size(); ++c) {
        const std::uint64_t start = c == 0 ? 0 : list.ends[c - 1], points = list.ends[c] - start;
        check_vtk_cell(start, list.ends[c], list.connectivity.size(), c, fail);
        const VtkCellType type = vtk_cell_type(types[c]);
        const std::size_t corners = cells.corners_of(type.cell);
        if (corners == 0) {
            cells.skip(type.cell, type.name, 1, data);
            continue;
        }
        const bool exactly = type.least_points == corners && !type.any_order;
        if (points < type.least_points || (exactly && points > corners))
            fail(c, format("expected %llu points (%s), found %llu", llu(type.least_points), type.name,
                           llu(points)));
        std::uint32_t vertices[most_corners];
        for (std::size_t i = 0; i < corners; ++i)
            vertices[i] = static_cast<std::uint32_t>(
                first_vertex + checked_vtk_point(list.connectivity[start + i], vertex_count, c, fail));
        if (types[c] == voxel)
            for (const std::size_t i : {std::size_t{2}, std::size_t{6}})
                std::swap(vertices[i], vertices[i + 1]);
        cells.add(type.cell, type.name, points, vertices, have_regions ? regions.of_cells()[c] : 0, data);
    }
}

std::optional<NumberType> vtk_number(std::string_view name) {
    // In the order of NumberType: the name in XML files, and those in legacy files.
    static constexpr std::string_view names[][3] = {
        {"Int8", "vtktypeint8", "char"},        {"UInt8", "vtktypeuint8", "unsigned_char"},
        {"Int16", "vtktypeint16", "short"},     {"UInt16", "vtktypeuint16", "unsigned_short"},
        {"Int32", "vtktypeint32", "int"},       {"UInt32", "vtktypeuint32", "unsigned_int"},
        {"Int64", "vtktypeint64", "long"},      {"UInt64", "vtktypeuint64", "unsigned_long"},
        {"Float32", "vtktypefloat32", "float"}, {"Float64", "vtktypefloat64", "double"}};
    if (name == "signed_char") return NumberType::int8;
    if (name == "vtkIdType") return NumberType::int32; // legacy files store it as int
    for (std::size_t i = 0; i < std::size(names); ++i)
        if (std::count(std::begin(names[i]), std::end(names[i]), name)) return static_cast<NumberType>(i);
    return std::nullopt;
}

void take_vtk_polygons(const VtkPolygons& list, bool strips, std::size_t first_point, SurfaceBuilder& surface,
                       const VtkFail& fail) {
    const std::size_t points = surface.points() - first_point;
    for (std::size_t c = 0; c < list.ends.size(); ++c) {
        const std::uint64_t start = c == 0 ? 0 : list.ends[c - 1], end = list.ends[c];
        check_vtk_cell(start, end, list.connectivity.size(), c, fail);
        if (!surface.begin_element()) continue;
        std::uint32_t last[2] = {0, 0};
        for (std::uint64_t i = start; i < end; ++i) {
            const std::uint32_t vertex = surface.vertex_of(static_cast<std::uint32_t>(
                first_point + checked_vtk_point(list.connectivity[i], points, c, fail)));
            if (!strips)
                surface.corner(vertex);
            else if (i >= start + 2)
                surface.triangle(last[0], last[1], vertex);
            last[(i - start) % 2] = vertex; // every other triangle of a strip is turned over so
        }
        if (!strips) surface.end_polygon();
    }
}

} // namespace vox::io
