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
                                   {69, {CellKind::triangle, 3, "Lagrange triangle"}},
                                   {10, {CellKind::tet, 4, "tetrahedron"}},
                                   {24, {CellKind::high_tet, 10, "quadratic tetrahedron"}},
                                   {71, {CellKind::high_tet, 4, "Lagrange tetrahedron"}},
                                   {78, {CellKind::high_tet, 4, "Bezier tetrahedron"}},
                                   {11, {CellKind::volume, 0, "voxels"}},
                                   {12, {CellKind::volume, 0, "hexahedra"}},
                                   {13, {CellKind::volume, 0, "wedges"}},
                                   {14, {CellKind::volume, 0, "pyramids"}},
                                   {15, {CellKind::volume, 0, "pentagonal prisms"}},
                                   {16, {CellKind::volume, 0, "hexagonal prisms"}},
                                   {42, {CellKind::volume, 0, "polyhedra"}}};
    for (const Row& row : rows)
        if (row.type == type) return row.is;
    for (const unsigned volume : {25u, 26u, 27u, 29u, 32u, 33u, 37u, 41u, 72u, 73u, 74u, 79u, 80u, 81u})
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

std::optional<NumberType> vtk_number(std::string_view name) {
    // In the order of NumberType: the name in XML files, and those in legacy files.
    static constexpr std::string_view names[][3] = {
        {"Int8", "vtktypeint8", "char"},        {"UInt8", "vtktypeuint8", "unsigned_char"},
        {"Int16", "vtktypeint16", "short"},     {"UInt16", "vtktypeuint16", "unsigned_short"},
        {"Int32", "vtktypeint32", "int"},       {"UInt32", "vtktypeuint32", "unsigned_int"},
        {"Int64", "vtktypeint64", "long"},      {"UInt64", "vtktypeuint64", "unsigned_long"},
        {"Float32", "vtktypefloat32", "float"}, {"Float64", "vtktypefloat64", "double"}};
    if (name == "vtkIdType") return NumberType::int32; // legacy files store it as int
    for (std::size_t i = 0; i < std::size(names); ++i)
        if (std::count(std::begin(names[i]), std::end(names[i]), name)) return static_cast<NumberType>(i);
    return std::nullopt;
}

} // namespace vox::io
