// Writes VTK XML unstructured grids ("VTK XML Formats", Kitware) as text, or with raw appended arrays that
// have 64-bit headers.
#include "io/formats/writers.hpp"

#include <algorithm>

namespace vox::io {
namespace {

constexpr std::uint32_t triangle_type = 5, tet_type = 10; // of vtkCellType.h

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out.append("&amp;");
        else if (c == '<')
            out.append("&lt;");
        else if (c == '>')
            out.append("&gt;");
        else
            out.push_back(c);
    }
    return out;
}

// A DataArray is declared with its values (text) or with the offset of its values (binary).
class Arrays {
public:
    Arrays(bool binary, Output& out) : binary_(binary), out_(out) {}

    // `each` calls its argument with every value, in order. T is the type of the values in a binary file.
    template <class T, class Each>
    void declare(const char* type, std::string_view name, std::uint64_t components, std::uint64_t values,
                 const Each& each) {
        out_ << "<DataArray type=\"" << type << "\" Name=\"" << escaped(name) << "\" NumberOfComponents=\""
             << components << "\" format=\"" << (binary_ ? "appended" : "ascii");
        if (binary_) {
            out_ << "\" offset=\"" << offset_ << "\"/>\n";
            const std::uint64_t bytes = values * sizeof(T);
            offset_ += sizeof bytes + bytes;
            append_.push_back([this, bytes, each] {
                out_.binary(bytes);
                each([this](auto value) { out_.binary(static_cast<T>(value)); });
            });
            return;
        }
        out_ << "\">\n";
        std::uint64_t in_line = 0;
        each([&](auto value) {
            out_ << value;
            in_line = in_line + 1 < components ? in_line + 1 : 0;
            out_ << (in_line > 0 ? ' ' : '\n');
        });
        out_ << "</DataArray>\n";
    }

    // Writes the values of all arrays declared so far.
    void append() {
        if (!binary_) return;
        out_ << "<AppendedData encoding=\"raw\">\n_";
        for (const auto& values : append_) values();
        out_ << "\n</AppendedData>\n";
    }

private:
    bool binary_;
    Output& out_;
    std::uint64_t offset_ = 0;
    std::vector<std::function<void()>> append_;
};

} // namespace

void write_vtu(const vox_io_mesh_view& mesh, const WrittenData& values, bool binary, Output& out) {
    const std::uint64_t vertices = mesh.vertex_count, triangles = mesh.triangle_count, tets = mesh.tet_count;
    out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\""
        << (std::endian::native == std::endian::big ? "BigEndian" : "LittleEndian")
        << "\" header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" << vertices
        << "\" NumberOfCells=\"" << triangles + tets << "\">\n";
    Arrays arrays(binary, out);

    const auto declare = [&](std::span<const vox_io_point_data> list, std::uint64_t owners) {
        for (const vox_io_point_data& data : list) {
            const std::uint64_t count = data.components * owners;
            arrays.declare<double>("Float64", data.name, data.components, count,
                                   [count, &data](const auto& put) {
                                       for (std::uint64_t i = 0; i < count; ++i) put(data.values[i]);
                                   });
        }
    };
    out << "<PointData>\n";
    declare(values.points, vertices);
    out << "</PointData>\n<CellData>\n";
    declare(values.cells, triangles + tets);
    const auto is_region = [](const vox_io_point_data& data) {
        return std::string_view(data.name) == "region";
    };
    if (mesh.tet_regions && std::none_of(values.cells.begin(), values.cells.end(), is_region))
        arrays.declare<std::int32_t>("Int32", "region", 1, triangles + tets, [&](const auto& put) {
            for (std::uint64_t t = 0; t < triangles; ++t) put(0);
            for (std::uint64_t t = 0; t < tets; ++t) put(mesh.tet_regions[t]);
        });
    out << "</CellData>\n<Points>\n";
    arrays.declare<double>("Float64", "Points", 3, 3 * vertices, [&](const auto& put) {
        for (std::uint64_t i = 0; i < 3 * vertices; ++i) put(mesh.positions[i]);
    });
    out << "</Points>\n<Cells>\n";
    arrays.declare<std::int64_t>("Int64", "connectivity", 1, 3 * triangles + 4 * tets, [&](const auto& put) {
        for (std::uint64_t i = 0; i < 3 * triangles; ++i) put(mesh.triangles[i]);
        for (std::uint64_t i = 0; i < 4 * tets; ++i) put(mesh.tets[i]);
    });
    arrays.declare<std::int64_t>("Int64", "offsets", 1, triangles + tets, [=](const auto& put) {
        for (std::uint64_t t = 1; t <= triangles; ++t) put(3 * t);
        for (std::uint64_t t = 1; t <= tets; ++t) put(3 * triangles + 4 * t);
    });
    arrays.declare<std::uint8_t>("UInt8", "types", 1, triangles + tets, [=](const auto& put) {
        for (std::uint64_t t = 0; t < triangles; ++t) put(triangle_type);
        for (std::uint64_t t = 0; t < tets; ++t) put(tet_type);
    });
    out << "</Cells>\n</Piece>\n</UnstructuredGrid>\n";
    arrays.append();
    out << "</VTKFile>\n";
}

} // namespace vox::io
