// The points of a file whose triangles name them by number.
#pragma once

#include "io/formats/surface_builder.hpp"

#include <cstdint>
#include <vector>

namespace vox::io {

class IndexedPoints {
public:
    std::size_t size() const noexcept { return vertices_.size(); }
    void reserve(std::size_t points) {
        positions_.reserve(3 * points);
        vertices_.reserve(points);
    }
    void add(const double p[3]) { // finite
        positions_.insert(positions_.end(), p, p + 3);
        vertices_.push_back(none);
    }
    // The vertex of `surface` that lies at a point.
    std::uint32_t vertex(std::uint32_t point, SurfaceBuilder& surface) {
        if (vertices_[point] == none) vertices_[point] = surface.vertex(&positions_[3 * std::size_t{point}]);
        return vertices_[point];
    }

private:
    static constexpr std::uint32_t none = 0xffffffffu;

    std::vector<double> positions_;
    std::vector<std::uint32_t> vertices_; // none: not used yet
};

} // namespace vox::io
