// Mean sizes of a mesh's elements, in double, over the file's own coordinates.
#pragma once

#include <vox/vox_io.h>

#include <optional>

namespace tool {

// Over the tetrahedra; in a file without any, over its triangles. A mean over nothing has no value.
struct Shape {
    std::optional<double> mean_edge;         // of the unique edges
    std::optional<double> mean_longest_edge; // over the elements
    std::optional<double> mean_facet_area;   // of the unique facets
    std::optional<double> mean_volume;       // of |volume|, tetrahedra only
};

Shape measure_shape(const vox_io_mesh_view& mesh);

} // namespace tool
