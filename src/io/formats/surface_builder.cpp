#include "io/formats/surface_builder.hpp"

#include "base/llu.hpp"
#include "io/formats/readers.hpp"
#include "io/throw_error.hpp"

#include <cmath>
#include <utility>

namespace vox::io {

SurfaceBuilder::SurfaceBuilder(std::string name, const SurfaceLimits& limits, std::uint32_t mesh_index)
    : name_(std::move(name)), limits_{std::min(limits.triangles, max_count),
                                      std::min(limits.vertices, max_count)},
      mesh_index_(mesh_index), work_left_(128 * limits_.triangles), table_(data_.positions) {}

void SurfaceBuilder::too_many(const char* what, std::uint64_t limit) const {
    throw_error(VOX_ERROR_LIMIT, "%s: the surface has more %s than the limit of %llu for a file of its size",
                name_.c_str(), what, llu(limit));
}

std::uint32_t SurfaceBuilder::vertex(const double p[3]) {
    const std::size_t count = data_.positions.size() / 3;
    if (data_.positions.size() + 3 > data_.positions.capacity())
        reserve(room_for(count + 1, limits_.vertices + 1));
    data_.positions.insert(data_.positions.end(), p, p + 3);
    const std::uint32_t vertex = table_.enter(static_cast<std::uint32_t>(count));
    if (vertex != count)
        data_.positions.resize(3 * count);
    else
        check_vertices(count + 1);
    return vertex;
}

void SurfaceBuilder::reserve(std::size_t vertices) {
    data_.positions.reserve(3 * vertices);
    table_.reserve(data_.positions.capacity() / 3);
}

void SurfaceBuilder::reserve_points(std::size_t count) {
    check_vertices(count);
    points_.reserve(3 * count);
    vertex_of_.reserve(count);
}

void SurfaceBuilder::point(const double p[3]) {
    if (points() == vertex_of_.capacity()) {
        check_vertices(points() + 1);
        reserve_points(room_for(points() + 1, limits_.vertices));
    }
    points_.insert(points_.end(), p, p + 3);
    vertex_of_.push_back(none);
}

void SurfaceBuilder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    std::vector<std::uint32_t>& triangles = data_.triangles;
    const std::size_t count = triangles.size() / 3;
    if (count >= limits_.triangles) too_many("triangles", limits_.triangles);
    if (triangles.size() + 3 > triangles.capacity())
        triangles.reserve(3 * room_for(count + 1, limits_.triangles));
    triangles.insert(triangles.end(), {a, b, c});
}

void SurfaceBuilder::end_polygon() {
    const std::size_t corners = corners_.size();
    if (corners < 3) skip(1);
    if (corners > 3) {
        const Plane plane = plane_of_polygon();
        if (!is_convex(plane)) cut_ears(plane);
    }
    for (std::size_t i = 2; i < corners_.size(); ++i)
        triangle(corners_[0], corners_[i - 1], corners_[i]); // a fan, or what ears have left
    corners_.clear();
}

// Twice the area of a triangle in a plane: negative where it turns the other way than the polygon.
double SurfaceBuilder::area(const Plane& plane, std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const auto [x, y] = plane.axes;
    const double *p = &data_.positions[3 * std::size_t{a}], *q = &data_.positions[3 * std::size_t{b}],
                 *r = &data_.positions[3 * std::size_t{c}];
    return plane.sign * ((q[x] - p[x]) * (r[y] - p[y]) - (q[y] - p[y]) * (r[x] - p[x]));
}

// The plane of two axes in which the polygon is largest, by M. Newell's normal (Sutherland, Sproull,
// Schumacker, A characterization of ten hidden-surface algorithms, 1974).
SurfaceBuilder::Plane SurfaceBuilder::plane_of_polygon() const {
    Plane planes[3] = {{{1, 2}, 1}, {{2, 0}, 1}, {{0, 1}, 1}};
    double areas[3] = {0, 0, 0};
    for (std::size_t i = 2; i < corners_.size(); ++i)
        for (int k = 0; k < 3; ++k) areas[k] += area(planes[k], corners_[0], corners_[i - 1], corners_[i]);
    int largest = 0;
    for (int k = 1; k < 3; ++k)
        if (std::fabs(areas[k]) > std::fabs(areas[largest])) largest = k;
    if (areas[largest] < 0) planes[largest].sign = -1;
    return planes[largest];
}

bool SurfaceBuilder::is_convex(const Plane& plane) const {
    const std::size_t n = corners_.size();
    for (std::size_t i = 0; i < n; ++i)
        if (area(plane, corners_[i], corners_[(i + 1) % n], corners_[(i + 2) % n]) < 0) return false;
    return true;
}

// Cuts off ears (G. H. Meisters, Polygons have ears, American Mathematical Monthly 82, 1975), each the first
// behind the last one, until three corners are left. A polygon that has none, because it crosses itself, is
// left as it is then, and so is one that is too much work.
void SurfaceBuilder::cut_ears(const Plane& plane) {
    std::vector<std::uint32_t>& corners = corners_;
    // Whether the triangle of corner i and its neighbours belongs to the polygon and holds no other corner.
    const auto is_ear = [&](std::size_t i) {
        const std::size_t n = corners.size();
        const std::uint32_t a = corners[(i + n - 1) % n], b = corners[i], c = corners[(i + 1) % n];
        if (!(area(plane, a, b, c) > 0)) return false;
        for (const std::uint32_t p : corners)
            if (p != a && p != b && p != c && area(plane, a, b, p) >= 0 && area(plane, b, c, p) >= 0 &&
                area(plane, c, a, p) >= 0)
                return false;
        return true;
    };
    std::size_t at = 0, tried = 0;
    while (corners.size() > 3 && tried < corners.size()) {
        const std::size_t n = corners.size();
        if (work_left_ < n) {
            ++uncut_;
            break;
        }
        work_left_ -= n;
        at %= n;
        if (!is_ear(at)) {
            ++at;
            ++tried;
            continue;
        }
        triangle(corners[(at + n - 1) % n], corners[at], corners[(at + 1) % n]);
        corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(at));
        tried = 0;
    }
}

void SurfaceBuilder::check_mesh_index(std::uint64_t meshes) const {
    if (mesh_index_ != all_meshes && mesh_index_ >= meshes)
        refuse(format("%s: mesh %u was asked for, but the file holds %llu", name_.c_str(), mesh_index_ + 1,
                      llu(meshes)));
}

MeshData SurfaceBuilder::finish() {
    if (!has_elements_ && points() > 0) {
        check_mesh_index(1);
        data_.positions = std::move(points_);
        data_.notes.push_back("there are no triangles: points alone");
        return std::move(data_);
    }
    check_mesh_index(meshes_);
    if (data_.triangles.empty())
        throw_error(VOX_ERROR_FORMAT, "%s: expected triangles, found none", name_.c_str());
    if (uncut_ > 0)
        data_.notes.push_back(format("%llu polygon%s not convex and %s too many corners to be cut with care: "
                                     "triangles may lie outside",
                                     llu(uncut_), uncut_ == 1 ? " is" : "s are",
                                     uncut_ == 1 ? "has" : "have"));
    return std::move(data_);
}

} // namespace vox::io
