// Collects the triangles of a surface file, for the readers of surface formats.
#pragma once

#include "io/formats/scan.hpp"
#include "io/mesh_data.hpp"
#include "io/position_table.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace vox::io {

// How many triangles a surface file of that many bytes may give. Polygons, strips and scenes that repeat a
// mesh can stand for any number of triangles; with this limit no file takes more memory than 16 times its
// size and 16 MB, the report included.
constexpr std::uint64_t most_triangles(std::uint64_t bytes) { return bytes / 6 + (std::uint64_t{1} << 17); }

// Merges vertices at exactly the same position, in order of first use: formats repeat a vertex for every
// normal, texture coordinate or material that it has, which would leave a closed surface open.
class SurfaceBuilder {
public:
    // mesh_index is as in vox_io_load_desc. More than `most` triangles are a failure.
    SurfaceBuilder(std::string name, std::uint64_t most, std::uint32_t mesh_index);

    // The next element begins another mesh of the file. Meshes without elements do not count.
    void begin_mesh() noexcept { begins_ = true; }
    // Begins an element. Returns whether it belongs to a mesh that was asked for; if not, leave it out.
    bool begin_element() noexcept {
        meshes_ += begins_;
        begins_ = false;
        return mesh_index_ == VOX_IO_ALL_MESHES || meshes_ == mesh_index_ + std::uint64_t{1};
    }

    // The number of the vertex at `p`, which must be finite.
    std::uint32_t vertex(const double p[3]);
    // Makes room for that many vertices.
    void reserve(std::size_t vertices);
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
    // Cuts a polygon into triangles. One with fewer than three corners is skipped.
    void polygon(const std::vector<std::uint32_t>& corners);
    void skip(std::uint64_t elements) noexcept { data_.skipped_elements += elements; }

    // Throws if there is no triangle, or no mesh with the index that was asked for.
    MeshData finish();

private:
    bool is_convex(const std::vector<std::uint32_t>& corners);
    void cut_ears(std::vector<std::uint32_t> corners);

    std::string name_;
    std::uint64_t most_;
    std::uint32_t mesh_index_;
    bool begins_ = true;
    std::uint64_t meshes_ = 0;
    std::uint64_t work_left_; // how many corners may still be compared with ears
    std::uint64_t uncut_ = 0; // polygons for which that did not suffice
    int axes_[2] = {0, 1};    // the plane of the polygon at hand
    double sign_ = 1;         // and its orientation there
    MeshData data_;
    PositionTable table_;
};

} // namespace vox::io
