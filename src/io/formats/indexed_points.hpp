// The points of a file whose triangles name them by number.
#pragma once

#include "io/formats/surface_builder.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace vox::io {

class IndexedPoints {
public:
    // The surface that the triangles are added to. There may be as many points as vertices of the surface.
    explicit IndexedPoints(SurfaceBuilder& surface) : surface_(surface) {}

    std::size_t size() const noexcept { return vertices_.size(); }
    // Makes room for that many points.
    void reserve(std::size_t points) {
        surface_.check_vertices(points);
        positions_.reserve(3 * points);
        vertices_.reserve(points);
    }
    void add(const double p[3]) { // finite
        if (size() == vertices_.capacity()) {
            surface_.check_vertices(size() + 1);
            reserve(room_for(size() + 1, surface_.limits().vertices));
        }
        positions_.insert(positions_.end(), p, p + 3);
        vertices_.push_back(none);
    }
    // The vertex of the surface that lies at a point.
    std::uint32_t vertex(std::uint32_t point) {
        if (vertices_[point] == none) vertices_[point] = surface_.vertex(&positions_[3 * std::size_t{point}]);
        return vertices_[point];
    }
    // The mesh: the surface or, where the file has no element at all, the points.
    MeshData finish() {
        if (surface_.has_elements() || size() == 0) return surface_.finish();
        vertices_ = {};
        return surface_.finish_points(std::move(positions_));
    }

private:
    static constexpr std::uint32_t none = 0xffffffffu;

    SurfaceBuilder& surface_;
    std::vector<double> positions_;
    std::vector<std::uint32_t> vertices_; // none: not used yet
};

} // namespace vox::io
