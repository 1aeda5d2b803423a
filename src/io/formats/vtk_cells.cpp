#include "io/formats/vtk_cells.hpp"

namespace vox::io {
namespace {

template <class Stored, class Out>
void append(const char* bytes, std::uint64_t count, bool swap, std::vector<Out>& out) {
    for (std::uint64_t i = 0; i < count; ++i)
        out.push_back(static_cast<Out>(load<Stored>(bytes + i * sizeof(Stored), swap)));
}

} // namespace

VtkCellType vtk_cell_type(std::uint64_t type) {
    struct Row {
        unsigned type;
        VtkCellType is;
    };
    static constexpr Row rows[] = {{5, {Cell::triangle, 3, "triangle"}},
                                   {22, {Cell::triangle, 6, "quadratic triangle"}},
                                   {34, {Cell::triangle, 7, "biquadratic triangle"}},
                                   {69, {Cell::triangle, 3, "Lagrange triangle"}},
                                   {10, {Cell::tet, 4, "tetrahedron"}},
                                   {24, {Cell::high_tet, 10, "quadratic tetrahedron"}},
                                   {71, {Cell::high_tet, 4, "Lagrange tetrahedron"}},
                                   {78, {Cell::high_tet, 4, "Bezier tetrahedron"}},
                                   {11, {Cell::volume, 0, "voxels"}},
                                   {12, {Cell::volume, 0, "hexahedra"}},
                                   {13, {Cell::volume, 0, "wedges"}},
                                   {14, {Cell::volume, 0, "pyramids"}},
                                   {15, {Cell::volume, 0, "pentagonal prisms"}},
                                   {16, {Cell::volume, 0, "hexagonal prisms"}},
                                   {42, {Cell::volume, 0, "polyhedra"}}};
    for (const Row& row : rows)
        if (row.type == type) return row.is;
    for (const unsigned volume : {25u, 26u, 27u, 29u, 32u, 33u, 37u, 41u, 72u, 73u, 74u, 79u, 80u, 81u})
        if (type == volume) return {Cell::volume, 0, "cells of higher order"};
    return {Cell::other, 0, "other cells"};
}

VtkNumber vtk_number(std::string_view name) {
    // In the order of VtkNumber: the name in XML files, and those in legacy files.
    static constexpr std::string_view names[][3] = {
        {"Int8", "vtktypeint8", "char"},        {"UInt8", "vtktypeuint8", "unsigned_char"},
        {"Int16", "vtktypeint16", "short"},     {"UInt16", "vtktypeuint16", "unsigned_short"},
        {"Int32", "vtktypeint32", "int"},       {"UInt32", "vtktypeuint32", "unsigned_int"},
        {"Int64", "vtktypeint64", "long"},      {"UInt64", "vtktypeuint64", "unsigned_long"},
        {"Float32", "vtktypefloat32", "float"}, {"Float64", "vtktypefloat64", "double"}};
    for (std::size_t i = 0; i < std::size(names); ++i)
        if (std::count(std::begin(names[i]), std::end(names[i]), name)) return static_cast<VtkNumber>(i + 1);
    return name == "vtkIdType" ? VtkNumber::i32 : VtkNumber::none; // legacy files store it as int
}

std::size_t size_of(VtkNumber number) {
    static constexpr std::size_t sizes[] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return sizes[static_cast<std::size_t>(number)];
}

template <class Out>
void append_vtk_numbers(VtkNumber type, const char* bytes, std::uint64_t count, bool swap,
                        std::vector<Out>& out) {
    switch (type) {
    case VtkNumber::none:
        return;
    case VtkNumber::i8:
        return append<std::int8_t>(bytes, count, swap, out);
    case VtkNumber::u8:
        return append<std::uint8_t>(bytes, count, swap, out);
    case VtkNumber::i16:
        return append<std::int16_t>(bytes, count, swap, out);
    case VtkNumber::u16:
        return append<std::uint16_t>(bytes, count, swap, out);
    case VtkNumber::i32:
        return append<std::int32_t>(bytes, count, swap, out);
    case VtkNumber::u32:
        return append<std::uint32_t>(bytes, count, swap, out);
    case VtkNumber::i64:
        return append<std::int64_t>(bytes, count, swap, out);
    case VtkNumber::u64:
        return append<std::uint64_t>(bytes, count, swap, out);
    case VtkNumber::f32:
    case VtkNumber::f64:
        if constexpr (std::is_floating_point_v<Out>)
            return type == VtkNumber::f32 ? append<float>(bytes, count, swap, out)
                                          : append<double>(bytes, count, swap, out);
    }
}

template void append_vtk_numbers(VtkNumber, const char*, std::uint64_t, bool, std::vector<double>&);
template void append_vtk_numbers(VtkNumber, const char*, std::uint64_t, bool, std::vector<std::uint64_t>&);

} // namespace vox::io
