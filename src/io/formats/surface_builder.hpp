// Collects the triangles of a surface file, for the readers of surface formats.
#pragma once

#include "io/formats/scan.hpp"
#include "io/mesh_data.hpp"
#include "io/position_table.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace vox::io {

struct SurfaceLimits {
    std::uint64_t triangles, vertices;
};

// How many triangles and vertices a surface file of S bytes may give, and how many points it may have. The
// smallest that people use take 6 bytes a triangle (strips) and 12 a vertex; but polygons, strips and scenes
// that show a mesh many times can stand for any number. With these limits no file takes more memory than
// 12 S and 14 MB, and so no more than 16 S and 16 MB, the report and the text of a pipe (2 S) included.
// While it is read, in bytes:
//   32 a vertex (24, 8 in the hash table), 45 for half as many while room is made, and 18 a triangle while
//   room is made (where vertices collide in the table, 48 more, but then each has three long numbers):
//                                                                                    7.2 S and 7.9 MB
//   28 a point and 12 a corner of a polygon, at most as many as vertices and triangles: 4.8 S and 5.3 MB
//   or, for glTF, what is kept of the document (formats/gltf_document.hpp):          6 S
// Then, with the report, 32 a vertex and 24 a triangle:                              7.2 S and 7.4 MB
constexpr SurfaceLimits surface_limits(std::uint64_t bytes) {
    constexpr std::uint64_t at_least = std::uint64_t{1} << 17;
    return {bytes / 6 + at_least, bytes / 10 + at_least};
}

// How many things to make room for if there are `count` of them, and may be `most`. The room is doubled so
// that it ends at `most`: then the arrays before and after that take no more than 1.5 times the last one.
inline std::size_t room_for(std::size_t count, std::size_t most) {
    while ((most + 1) / 2 >= std::max<std::size_t>(count, 1024)) most = (most + 1) / 2;
    return most;
}

// Merges vertices at exactly the same position, in order of first use: formats repeat a vertex for every
// normal, texture coordinate or material that it has, which would leave a closed surface open.
class SurfaceBuilder {
public:
    // mesh_index counts from 0, or is all_meshes. More than the limits is a failure.
    SurfaceBuilder(std::string name, const SurfaceLimits& limits, std::uint32_t mesh_index);

    const SurfaceLimits& limits() const noexcept { return limits_; }
    // Fails if a surface may not have that many.
    void check_vertices(std::uint64_t count) const {
        if (count > limits_.vertices) too_many("vertices", limits_.vertices);
    }

    // The next element begins another mesh of the file. Meshes without elements do not count.
    void begin_mesh() noexcept { begins_ = true; }
    // Begins an element. Returns whether it belongs to a mesh that was asked for; if not, leave it out.
    bool begin_element() noexcept {
        has_elements_ = true;
        meshes_ += begins_;
        begins_ = false;
        return mesh_index_ == all_meshes || meshes_ == mesh_index_ + std::uint64_t{1};
    }

    // The number of the vertex at `p`, which must be finite.
    std::uint32_t vertex(const double p[3]);
    // Makes room for that many vertices.
    void reserve(std::size_t vertices);
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
    // The next corner of a polygon.
    void corner(std::uint32_t vertex) {
        if (corners_.size() >= limits_.triangles + 2) too_many("triangles", limits_.triangles);
        corners_.push_back(vertex);
    }
    // Cuts the polygon of these corners into triangles. One with fewer than three is skipped.
    void end_polygon();
    void skip(std::uint64_t elements) noexcept { data_.skipped_elements += elements; }

    // Points, which elements name by number. There may be as many as vertices.
    std::size_t points() const noexcept { return vertex_of_.size(); }
    void reserve_points(std::size_t count);
    void point(const double p[3]); // finite
    std::uint32_t vertex_of(std::uint32_t point) {
        if (vertex_of_[point] == none) vertex_of_[point] = vertex(&points_[3 * std::size_t{point}]);
        return vertex_of_[point];
    }

    // Throws if there is no triangle, or no mesh with the index that was asked for. A file without elements
    // gives its points, which are one mesh and not merged.
    MeshData finish();

private:
    static constexpr std::uint32_t none = 0xffffffffu;

    struct Plane { // of two axes, in which a polygon is seen
        int axes[2];
        double sign; // 1, or -1 where the polygon is clockwise
    };

    [[noreturn]] void too_many(const char* what, std::uint64_t limit) const;
    void check_mesh_index(std::uint64_t meshes) const; // how many the file holds
    double area(const Plane& plane, std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
    Plane plane_of_polygon() const;
    bool is_convex(const Plane& plane) const;
    void cut_ears(const Plane& plane);

    std::string name_;
    SurfaceLimits limits_;
    std::uint32_t mesh_index_;
    bool begins_ = true, has_elements_ = false;
    std::uint64_t meshes_ = 0;
    std::uint64_t work_left_;            // how many corners may still be compared with ears
    std::uint64_t uncut_ = 0;            // polygons for which that did not suffice
    std::vector<std::uint32_t> corners_; // of the polygon at hand
    std::vector<double> points_;
    std::vector<std::uint32_t> vertex_of_; // of each point, or none
    MeshData data_;
    PositionTable table_;
};

} // namespace vox::io
