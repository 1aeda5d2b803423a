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
    std::uint64_t least_points; // 0 for cells that are skipped
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

// Adds the cells to `data`. Cell c has the points connectivity[ends[c - 1]] to connectivity[ends[c] - 1],
// counted from first_vertex.
void take_vtk_cells(const std::vector<std::uint64_t>& ends, const std::vector<std::uint64_t>& connectivity,
                    const std::vector<std::uint64_t>& types, std::uint64_t first_vertex,
                    std::uint64_t vertex_count, MeshData& data, Skipped& skipped, const VtkFail& fail);

// Polygons, or strips of triangles, of a surface: as above.
struct VtkPolygons {
    std::vector<std::uint64_t> ends, connectivity;
};

// Adds them to `surface`, whose points from first_point on they name.
void take_vtk_polygons(const VtkPolygons& list, bool strips, std::size_t first_point, SurfaceBuilder& surface,
                       const VtkFail& fail);

// Adds the regions of those cells that are tets, of which there were `tets_before` before they were taken.
void take_vtk_regions(const std::vector<std::uint64_t>& types, const RegionArray& regions,
                      std::size_t tets_before, MeshData& data);

// The number type of that name in either kind of file.
std::optional<NumberType> vtk_number(std::string_view name);

} // namespace vox::io
