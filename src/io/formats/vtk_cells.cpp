#include "io/formats/vtk_cells.hpp"

namespace vox::io {
namespace {

template <class Stored, class Out>
void append(const char* bytes, std::uint64_t count, bool swap, std::vector<Out>& out) {
    for (std::uint64_t i = 0; i < count; ++i)
        out.push_back(static_cast<Out>(load<Stored>(bytes + i * sizeof(Stored), swap)));
}

template <class Out>
void append_any(VtkNumber type, const char* bytes, std::uint64_t count, bool swap, std::vector<Out>& out) {
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
        if constexpr (std::is_floating_point_v<Out>) {
            if (type == VtkNumber::f32)
                append<float>(bytes, count, swap, out);
            else
                append<double>(bytes, count, swap, out);
        }
        return;
    }
}

} // namespace

VtkCellType vtk_cell_type(std::uint64_t type) {
    switch (type) {
    case 5:
        return {Cell::triangle, 3, "triangle"};
    case 22:
        return {Cell::triangle, 6, "quadratic triangle"};
    case 34:
        return {Cell::triangle, 7, "biquadratic triangle"};
    case 69:
        return {Cell::triangle, 3, "Lagrange triangle"};
    case 10:
        return {Cell::tet, 4, "tetrahedron"};
    case 24:
        return {Cell::high_tet, 10, "quadratic tetrahedron"};
    case 71:
        return {Cell::high_tet, 4, "Lagrange tetrahedron"};
    case 78:
        return {Cell::high_tet, 4, "Bezier tetrahedron"};
    case 11:
        return {Cell::volume, 0, "voxels"};
    case 12:
        return {Cell::volume, 0, "hexahedra"};
    case 13:
        return {Cell::volume, 0, "wedges"};
    case 14:
        return {Cell::volume, 0, "pyramids"};
    case 15:
        return {Cell::volume, 0, "pentagonal prisms"};
    case 16:
        return {Cell::volume, 0, "hexagonal prisms"};
    case 42:
        return {Cell::volume, 0, "polyhedra"};
    default:
        break;
    }
    for (const unsigned volume : {25u, 26u, 27u, 29u, 32u, 33u, 37u, 41u, 72u, 73u, 74u, 79u, 80u, 81u})
        if (type == volume) return {Cell::volume, 0, "cells of higher order"};
    return {Cell::other, 0, "other cells"};
}

VtkNumber vtk_number(std::string_view name) {
    struct Name {
        std::string_view text;
        VtkNumber number;
    };
    static constexpr Name names[] = {{"Int8", VtkNumber::i8},
                                     {"UInt8", VtkNumber::u8},
                                     {"Int16", VtkNumber::i16},
                                     {"UInt16", VtkNumber::u16},
                                     {"Int32", VtkNumber::i32},
                                     {"UInt32", VtkNumber::u32},
                                     {"Int64", VtkNumber::i64},
                                     {"UInt64", VtkNumber::u64},
                                     {"Float32", VtkNumber::f32},
                                     {"Float64", VtkNumber::f64},
                                     {"char", VtkNumber::i8},
                                     {"unsigned_char", VtkNumber::u8},
                                     {"short", VtkNumber::i16},
                                     {"unsigned_short", VtkNumber::u16},
                                     {"int", VtkNumber::i32},
                                     {"unsigned_int", VtkNumber::u32},
                                     {"long", VtkNumber::i64},
                                     {"unsigned_long", VtkNumber::u64},
                                     {"vtktypeint64", VtkNumber::i64},
                                     {"vtktypeuint64", VtkNumber::u64},
                                     {"vtktypeint32", VtkNumber::i32},
                                     {"vtktypeuint32", VtkNumber::u32},
                                     {"vtktypeint16", VtkNumber::i16},
                                     {"vtktypeuint16", VtkNumber::u16},
                                     {"vtktypeint8", VtkNumber::i8},
                                     {"vtktypeuint8", VtkNumber::u8},
                                     {"vtktypefloat32", VtkNumber::f32},
                                     {"vtktypefloat64", VtkNumber::f64},
                                     {"vtkIdType", VtkNumber::i32}, // legacy files store it as int
                                     {"float", VtkNumber::f32},
                                     {"double", VtkNumber::f64}};
    for (const Name& candidate : names)
        if (candidate.text == name) return candidate.number;
    return VtkNumber::none;
}

std::size_t size_of(VtkNumber number) {
    static constexpr std::size_t sizes[] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return sizes[static_cast<std::size_t>(number)];
}

void append_vtk_numbers(VtkNumber type, const char* bytes, std::uint64_t count, bool swap,
                        std::vector<double>& out) {
    append_any(type, bytes, count, swap, out);
}

void append_vtk_numbers(VtkNumber type, const char* bytes, std::uint64_t count, bool swap,
                        std::vector<std::uint64_t>& out) {
    append_any(type, bytes, count, swap, out);
}

} // namespace vox::io
