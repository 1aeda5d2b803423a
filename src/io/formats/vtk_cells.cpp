#include "io/formats/vtk_cells.hpp"

namespace vox::io {

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
                                   {24, {CellKind::high_tet, 10, "quadratic tetrahedron"}},
                                   {64, {CellKind::high_tet, 4, "tetrahedron of higher order", true}},
                                   {71, {CellKind::high_tet, 4, "Lagrange tetrahedron", true}},
                                   {78, {CellKind::high_tet, 4, "Bezier tetrahedron", true}},
                                   {11, {CellKind::volume, 0, "voxels"}},
                                   {12, {CellKind::volume, 0, "hexahedra"}},
                                   {13, {CellKind::volume, 0, "wedges"}},
                                   {14, {CellKind::volume, 0, "pyramids"}},
                                   {15, {CellKind::volume, 0, "pentagonal prisms"}},
                                   {16, {CellKind::volume, 0, "hexagonal prisms"}},
                                   {42, {CellKind::volume, 0, "polyhedra"}}};
    for (const Row& row : rows)
        if (row.type == type) return row.is;
    for (const unsigned volume :
         {25u, 26u, 27u, 29u, 32u, 33u, 37u, 41u, 65u, 66u, 67u, 72u, 73u, 74u, 79u, 80u, 81u})
        if (type == volume) return {CellKind::volume, 0, "cells of higher order"};
    return {CellKind::other, 0, "other cells"};
}

void take_vtk_regions(const std::vector<std::uint64_t>& types, const RegionArray& regions,
                      std::size_t tets_before, MeshData& data) {
    if (regions.of_cells().size() != types.size()) return;
    data.tet_regions.resize(tets_before, 0);
    for (std::size_t c = 0; c < types.size(); ++c) {
        const CellKind kind = vtk_cell_type(types[c]).cell;
        if (kind == CellKind::tet || kind == CellKind::high_tet)
            data.tet_regions.push_back(regions.of_cells()[c]);
    }
    if (data.tet_regions.size() != data.tets.size() / 4)
        data.tet_regions.resize(tets_before); // some were left out
}

void take_vtk_cells(const std::vector<std::uint64_t>& ends, const std::vector<std::uint64_t>& connectivity,
                    const std::vector<std::uint64_t>& types, std::uint64_t first_vertex,
                    std::uint64_t vertex_count, MeshData& data, Skipped& skipped, const VtkFail& fail) {
    for (std::size_t c = 0; c < types.size(); ++c) {
        const std::uint64_t start = c == 0 ? 0 : ends[c - 1], points = ends[c] - start;
        check_vtk_cell(start, ends[c], connectivity.size(), c, fail);
        const VtkCellType type = vtk_cell_type(types[c]);
        if (type.cell == CellKind::volume || type.cell == CellKind::other) {
            skipped.add(type.cell, type.name, 1);
            continue;
        }
        const std::uint64_t corners = type.cell == CellKind::triangle ? 3 : 4;
        const bool exactly = type.least_points == corners && !type.any_order;
        if (points < type.least_points || (exactly && points > corners))
            fail(c, format("expected %llu points (%s), found %llu", llu(type.least_points), type.name,
                           llu(points)));
        if (type.cell == CellKind::high_tet && points > corners) ++data.second_order_tets;
        std::vector<std::uint32_t>& out = type.cell == CellKind::triangle ? data.triangles : data.tets;
        for (std::uint64_t i = 0; i < corners; ++i)
            out.push_back(static_cast<std::uint32_t>(
                first_vertex + checked_vtk_point(connectivity[start + i], vertex_count, c, fail)));
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
