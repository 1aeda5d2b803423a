// VTK's cell types and number types, shared by the legacy and the XML reader.
#pragma once

#include "io/formats/number_type.hpp"
#include "io/formats/readers.hpp"
#include "io/formats/regions.hpp"

#include <algorithm>

namespace vox::io {

struct VtkCellType {
    CellKind cell;
    std::uint64_t least_points; // 0 for cells that are skipped
    const char* name;
};

// `type` is a number of vtkCellType.h.
VtkCellType vtk_cell_type(std::uint64_t type);

// Adds the cells to `data`. Cell c has the points connectivity[ends[c - 1]] to connectivity[ends[c] - 1],
// counted from first_vertex. `fail(cell, text)` must throw.
template <class Fail>
void take_vtk_cells(const std::vector<std::uint64_t>& ends, const std::vector<std::uint64_t>& connectivity,
                    const std::vector<std::uint64_t>& types, std::uint64_t first_vertex,
                    std::uint64_t vertex_count, MeshData& data, Skipped& skipped, const Fail& fail) {
    for (std::size_t c = 0; c < types.size(); ++c) {
        const std::uint64_t start = c == 0 ? 0 : ends[c - 1];
        if (ends[c] < start || ends[c] > connectivity.size())
            fail(c, format("expected offsets that ascend up to %zu, found %llu after %llu",
                           connectivity.size(), llu(ends[c]), llu(start)));
        const VtkCellType type = vtk_cell_type(types[c]);
        const std::uint64_t points = ends[c] - start;
        if (type.cell == CellKind::volume || type.cell == CellKind::other) {
            skipped.add(type.cell, type.name, 1);
            continue;
        }
        const std::uint64_t corners = type.cell == CellKind::triangle ? 3 : 4;
        if (points < type.least_points || (points > type.least_points && type.least_points == corners))
            fail(c, format("expected %llu points (%s), found %llu", llu(type.least_points), type.name,
                           llu(points)));
        if (type.cell == CellKind::high_tet) ++data.second_order_tets;
        std::vector<std::uint32_t>& out = type.cell == CellKind::triangle ? data.triangles : data.tets;
        for (std::uint64_t i = 0; i < corners; ++i) {
            const std::uint64_t point = connectivity[start + i];
            if (point >= vertex_count)
                fail(c, format("expected a point from 0 to %lld, found %lld",
                               static_cast<long long>(vertex_count) - 1, static_cast<long long>(point)));
            out.push_back(static_cast<std::uint32_t>(first_vertex + point));
        }
    }
}

// Adds the regions of those cells that are tets, of which there were `tets_before` before they were taken.
void take_vtk_regions(const std::vector<std::uint64_t>& types, const RegionArray& regions,
                      std::size_t tets_before, MeshData& data);

// The number type of that name in either kind of file.
std::optional<NumberType> vtk_number(std::string_view name);

} // namespace vox::io
