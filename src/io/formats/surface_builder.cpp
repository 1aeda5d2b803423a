#include "io/formats/surface_builder.hpp"

#include "base/error.hpp"
#include "base/llu.hpp"
#include "io/formats/readers.hpp"

#include <cmath>
#include <utility>

namespace vox::io {

SurfaceBuilder::SurfaceBuilder(std::string name, std::uint64_t most, std::uint32_t mesh_index)
    : name_(std::move(name)), most_(std::min(most, max_count)), mesh_index_(mesh_index),
      work_left_(128 * most_), table_(data_.positions) {
    data_.format = VOX_IO_FORMAT_SURFACE;
}

std::uint32_t SurfaceBuilder::vertex(const double p[3]) {
    const std::size_t count = data_.positions.size() / 3;
    data_.positions.insert(data_.positions.end(), p, p + 3);
    const std::uint32_t vertex = table_.enter(static_cast<std::uint32_t>(count));
    if (vertex != count)
        data_.positions.resize(3 * count);
    else if (count >= max_count)
        throw Error(VOX_ERROR_LIMIT, format("%s: the surface has more vertices than the limit of %llu",
                                            name_.c_str(), llu(max_count)));
    return vertex;
}

void SurfaceBuilder::reserve(std::size_t vertices) {
    data_.positions.reserve(3 * vertices);
    table_.reserve(vertices);
}

void SurfaceBuilder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (data_.triangles.size() / 3 >= most_)
        throw Error(VOX_ERROR_LIMIT, format("%s: the surface has more triangles than the limit of %llu for a "
                                            "file of its size",
                                            name_.c_str(), llu(most_)));
    data_.triangles.insert(data_.triangles.end(), {a, b, c});
}

void SurfaceBuilder::polygon(const std::vector<std::uint32_t>& corners) {
    if (corners.size() < 3) return skip(1);
    if (corners.size() > 3 && !is_convex(corners)) return cut_ears(corners);
    for (std::size_t i = 2; i < corners.size(); ++i)
        triangle(corners[0], corners[i - 1], corners[i]); // a fan
}

namespace {

// Twice the signed area of a triangle in the plane of two axes.
double area(const std::vector<double>& positions, const int axes[2], std::uint32_t a, std::uint32_t b,
            std::uint32_t c) {
    const double *p = &positions[3 * std::size_t{a}], *q = &positions[3 * std::size_t{b}],
                 *r = &positions[3 * std::size_t{c}];
    return (q[axes[0]] - p[axes[0]]) * (r[axes[1]] - p[axes[1]]) -
           (q[axes[1]] - p[axes[1]]) * (r[axes[0]] - p[axes[0]]);
}

} // namespace

// Chooses the plane of two axes in which the polygon is largest, by M. Newell's normal (Sutherland, Sproull,
// Schumacker, A characterization of ten hidden-surface algorithms, 1974), and looks for reflex corners there.
bool SurfaceBuilder::is_convex(const std::vector<std::uint32_t>& corners) {
    double normal[3] = {0, 0, 0};
    for (std::size_t i = 2; i < corners.size(); ++i)
        for (int k = 0; k < 3; ++k) {
            const int axes[2] = {(k + 1) % 3, (k + 2) % 3};
            normal[k] += area(data_.positions, axes, corners[0], corners[i - 1], corners[i]);
        }
    int longest = 0;
    for (int k = 1; k < 3; ++k)
        if (std::fabs(normal[k]) > std::fabs(normal[longest])) longest = k;
    axes_[0] = (longest + 1) % 3;
    axes_[1] = (longest + 2) % 3;
    sign_ = normal[longest] < 0 ? -1 : 1;
    const std::size_t n = corners.size();
    for (std::size_t i = 0; i < n; ++i)
        if (sign_ * area(data_.positions, axes_, corners[i], corners[(i + 1) % n], corners[(i + 2) % n]) < 0)
            return false;
    return true;
}

// Cuts off ears (G. H. Meisters, Polygons have ears, American Mathematical Monthly 82, 1975), each the first
// behind the last one. A polygon that has none, because it crosses itself, is cut into a fan, and so is one
// that is too much work.
void SurfaceBuilder::cut_ears(std::vector<std::uint32_t> corners) {
    const auto side = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        return sign_ * area(data_.positions, axes_, a, b, c);
    };
    // Whether the triangle of corner i and its neighbours belongs to the polygon and holds no other corner.
    const auto is_ear = [&](std::size_t i) {
        const std::size_t n = corners.size();
        const std::uint32_t a = corners[(i + n - 1) % n], b = corners[i], c = corners[(i + 1) % n];
        if (!(side(a, b, c) > 0)) return false;
        for (const std::uint32_t p : corners)
            if (p != a && p != b && p != c && side(a, b, p) >= 0 && side(b, c, p) >= 0 && side(c, a, p) >= 0)
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
    for (std::size_t i = 2; i < corners.size(); ++i) triangle(corners[0], corners[i - 1], corners[i]);
}

MeshData SurfaceBuilder::finish() {
    if (mesh_index_ != VOX_IO_ALL_MESHES && mesh_index_ >= meshes_)
        refuse(format("%s: mesh %u was asked for, but the file holds %llu", name_.c_str(), mesh_index_,
                      llu(meshes_)));
    if (data_.triangles.empty())
        throw Error(VOX_ERROR_FORMAT, format("%s: expected triangles, found none", name_.c_str()));
    if (uncut_ > 0)
        data_.notes.push_back(format("%llu polygon%s not convex and %s too many corners to be cut with care: "
                                     "triangles may lie outside",
                                     llu(uncut_), uncut_ == 1 ? " is" : "s are",
                                     uncut_ == 1 ? "has" : "have"));
    return std::move(data_);
}

} // namespace vox::io
