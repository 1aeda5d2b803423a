// Surfaces and cuts of tetrahedral meshes: plain functions over plain arrays.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace play {

using Vec = std::array<double, 3>;

inline Vec operator+(const Vec& a, const Vec& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vec operator-(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec operator*(double s, const Vec& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline double dot(const Vec& a, const Vec& b) { return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]; }
inline Vec cross(const Vec& a, const Vec& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class T>
std::span<const T> list(const T* data, std::uint64_t count) {
    return {data, static_cast<std::size_t>(count)};
}
inline Vec at(std::span<const double> positions, std::uint32_t vertex) {
    return {positions[3 * vertex], positions[3 * vertex + 1], positions[3 * vertex + 2]};
}

// Three corners for each facet of exactly one tetrahedron, counter-clockwise as seen from outside in the
// shape `rest`.
std::vector<std::uint32_t> surface_of(std::span<const std::uint32_t> tets, std::span<const double> rest);

// A cut: the part of the plane through `eye` that lies between the rays to two points.
class Stroke {
public:
    Stroke(const Vec& eye, const Vec& first, const Vec& second);
    const Vec& normal() const { return normal_; } // of length 1
    bool above(const Vec& point) const { return dot(normal_, point - eye_) > 0; }
    bool between_rays(const Vec& point) const {
        return dot(from_first_, point - eye_) >= 0 && dot(from_second_, point - eye_) >= 0;
    }

private:
    Vec eye_, normal_, from_first_, from_second_;
};

// One of the parts that a mesh comes apart into.
struct Part {
    std::vector<std::uint32_t> tets;
    std::vector<std::uint32_t> old_vertex; // of each vertex of the part, that of the whole
};

// Opens every facet that the stroke crosses: it lies between two tetrahedra whose centres are on either side
// of the plane. What then hangs together by facets stays together. Empty if the stroke crosses no facet.
std::vector<Part> cut(std::span<const std::uint32_t> tets, std::span<const double> positions,
                      const Stroke& stroke);

} // namespace play
