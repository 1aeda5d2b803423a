// VTK's cell types and number types, shared by the legacy and the XML reader.
#pragma once

#include "io/formats/number_type.hpp"
#include "io/formats/readers.hpp"
#include "io/formats/regions.hpp"
#include "io/formats/surface_builder.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vox::io {

struct VtkCellType {
    CellKind cell;
    std::uint64_t least_points; // 0 for cells that are always skipped
    const char* name;
    bool any_order = false; // it may have more points
};

// `type` is a number of vtkCellType.h.
VtkCellType vtk_cell_type(std::uint64_t type);

// fail(cell, text) must throw.
using VtkFail = std::function<void(std::size_t cell, const std::string& text)>;

// A cell has points `start` to `end` of a list of `size`.
inline void check_vtk_cell(std::uint64_t start, std::uint64_t end, std::size_t size, std::size_t cell,
                           const VtkFail& fail) {
    if (end < start || end > size)
        fail(cell, format("expected offsets that ascend up to %zu, found %llu after %llu", size, llu(end),
                          llu(start)));
}
inline std::uint64_t checked_vtk_point(std::uint64_t point, std::uint64_t points, std::size_t cell,
                                       const VtkFail& fail) {
    if (point >= points)
        fail(cell, format("expected a point from 0 to %lld, found %lld", static_cast<long long>(points) - 1,
                          static_cast<long long>(point)));
    return point;
}

// Cells, or of a surface polygons or strips of triangles: c has the points connectivity[ends[c - 1]] to
// connectivity[ends[c] - 1].
struct VtkPolygons {
    std::vector<std::uint64_t> ends, connectivity;
};

// Adds the cells to `data`, whose vertices from first_vertex on they name.
void take_vtk_cells(const VtkPolygons& list, const std::vector<std::uint64_t>& types,
                    const RegionArray& regions, std::uint64_t first_vertex, std::uint64_t vertex_count,
                    MeshData& data, Cells& cells, const VtkFail& fail);

// Adds them to `surface`, whose points from first_point on they name.
void take_vtk_polygons(const VtkPolygons& list, bool strips, std::size_t first_point, SurfaceBuilder& surface,
                       const VtkFail& fail);

// The number type of that name in either kind of file.
std::optional<NumberType> vtk_number(std::string_view name);

} // namespace vox::io
