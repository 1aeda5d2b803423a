// Mean sizes of a mesh's elements, computed in double from the file's coordinates.
#pragma once

#include <vox/vox_io.h>

#include <optional>

namespace tool {

// Means over the tetrahedra or, in a file without any, over the triangles. A mean over nothing has no value.
struct Shape {
    std::optional<double> mean_edge;         // mean over the unique edges
    std::optional<double> mean_longest_edge; // mean over the elements
    std::optional<double> mean_facet_area;   // mean over the unique facets
    std::optional<double> mean_volume;       // mean of |volume|; tetrahedra only
};

Shape measure_shape(const vox_io_mesh_view& mesh);

} // namespace tool
