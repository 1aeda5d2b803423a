#include "io/solids/bodies.hpp"

#include "base/eigen.hpp"
#include "io/buckets.hpp"
#include "io/solids/distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace vox::io {
namespace {

using Eigen::Vector3d;

Vector3d corner(const vox_io_mesh_view& mesh, std::uint32_t vertex) {
    return Vector3d(mesh.positions + 3 * std::size_t{vertex});
}

void measure_tets(const vox_io_mesh_view& mesh, vox_io_quality& quality) {
    if (mesh.tet_count == 0) return;
    double smallest = std::numbers::pi, largest = 0;
    for (std::size_t t = 0; t < mesh.tet_count; ++t) {
        std::array<Vector3d, 4> p;
        for (std::size_t k = 0; k < 4; ++k) p[k] = corner(mesh, mesh.tets[4 * t + k]);
        quality.volume += (p[1] - p[0]).dot((p[2] - p[0]).cross(p[3] - p[0])) / 6;
        // Normals of the facets opposite each corner, all outward or all inward.
        const std::array<Vector3d, 4> normal = {
            (p[2] - p[1]).cross(p[3] - p[1]), (p[3] - p[0]).cross(p[2] - p[0]),
            (p[1] - p[0]).cross(p[3] - p[0]), (p[2] - p[0]).cross(p[1] - p[0])};
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = i + 1; j < 4; ++j) {
                const double angle = std::numbers::pi -
                                     std::atan2(normal[i].cross(normal[j]).norm(), normal[i].dot(normal[j]));
                smallest = std::min(smallest, angle);
                largest = std::max(largest, angle);
            }
    }
    quality.min_dihedral = smallest * 180 / std::numbers::pi;
    quality.max_dihedral = largest * 180 / std::numbers::pi;
}

// The facets of exactly one tet, three vertices each.
std::vector<std::uint32_t> boundary_facets(const vox_io_mesh_view& mesh) {
    using Others = std::pair<std::uint32_t, std::uint32_t>;
    const auto each = [&](const auto& put) {
        for (std::size_t t = 0; t < mesh.tet_count; ++t)
            for (std::size_t left_out = 0; left_out < 4; ++left_out) {
                std::array<std::uint32_t, 3> facet{};
                for (std::size_t k = 0, n = 0; k < 4; ++k)
                    if (k != left_out) facet[n++] = mesh.tets[4 * t + k];
                std::sort(facet.begin(), facet.end());
                put(facet[0], Others{facet[1], facet[2]});
            }
    };
    std::vector<std::uint32_t> boundary;
    for_each_run<Others>(mesh.vertex_count, each,
                         [&](std::uint32_t lowest, const Others& others, std::ptrdiff_t tets) {
                             if (tets == 1)
                                 boundary.insert(boundary.end(), {lowest, others.first, others.second});
                         });
    return boundary;
}

// Visits samples of a thin triangle, at most `spacing` apart, in rows along its longest side: as many as its
// area needs. Returns false for one that is not thin.
template <class Visit>
bool for_each_row_sample(Vector3d a, Vector3d b, Vector3d c, double longest, double spacing,
                         const Visit& visit) {
    while ((b - a).norm() < longest) { // to its longest side, (a, b)
        std::swap(a, b);
        std::swap(b, c);
    }
    const double height = (b - a).cross(c - a).norm() / longest;
    if (!(8 * height < longest)) return false;
    const auto parts_of = [&](double length) { return std::clamp(std::ceil(length / spacing), 2.0, 1000.0); };
    const double rows = parts_of(height);
    for (double row = 0; row <= rows; ++row) {
        const Vector3d first = a + (c - a) * (row / rows), last = b + (c - b) * (row / rows);
        const double parts = parts_of((last - first).norm());
        for (double part = 0; part <= parts; ++part) visit(first + (last - first) * (part / parts));
    }
    return true;
}

// The largest distance from sample points on the triangles, at most `spacing` apart, to the triangles of the
// tree.
double largest_distance(const vox_io_mesh_view& mesh, const std::uint32_t* triangles, std::size_t count,
                        double spacing, const TriangleTree& tree) {
    double largest = 0; // squared
    for (std::size_t t = 0; t < count; ++t) {
        const Vector3d a = corner(mesh, triangles[3 * t]), b = corner(mesh, triangles[3 * t + 1]),
                       c = corner(mesh, triangles[3 * t + 2]);
        const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
        const auto visit = [&](const Vector3d& p) {
            largest = std::max(largest, tree.squared_distance(p, largest));
        };
        if (for_each_row_sample(a, b, c, longest, spacing, visit)) continue;
        // At least two parts a side; at most a thousand, to bound the work for very large triangles.
        const int parts = static_cast<int>(std::clamp(std::ceil(longest / spacing), 2.0, 1000.0));
        for (int i = 0; i <= parts; ++i)
            for (int j = 0; i + j <= parts; ++j) {
                visit(a + (b - a) * (double(i) / parts) + (c - a) * (double(j) / parts));
            }
    }
    return std::sqrt(largest);
}

} // namespace

vox_io_quality measure_quality(const vox_io_mesh_view& mesh, const vox_io_mesh_view* surface) {
    vox_io_quality quality{};
    quality.vertices = mesh.vertex_count;
    quality.tets = mesh.tet_count;
    measure_tets(mesh, quality);
    const std::vector<std::uint32_t> boundary = boundary_facets(mesh);
    quality.boundary_facets = boundary.size() / 3;
    if (!surface || surface->triangle_count == 0) return quality;
    for (std::size_t t = 0; t < surface->triangle_count; ++t) {
        // Volumes are summed around the first vertex, as the true origin may be far away.
        const Vector3d origin = corner(*surface, surface->triangles[0]);
        const Vector3d a = corner(*surface, surface->triangles[3 * t]) - origin;
        const Vector3d b = corner(*surface, surface->triangles[3 * t + 1]) - origin;
        const Vector3d c = corner(*surface, surface->triangles[3 * t + 2]) - origin;
        quality.surface_volume += a.dot(b.cross(c)) / 6;
    }
    if (boundary.empty()) return quality;

    double edges = 0;
    for (std::size_t i = 0; i < boundary.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k)
            edges += (corner(mesh, boundary[i + k]) - corner(mesh, boundary[i + (k + 1) % 3])).norm();
    const double spacing = edges / static_cast<double>(boundary.size()) / 2;
    const TriangleTree surface_tree(
        surface->positions,
        std::vector<std::uint32_t>(surface->triangles, surface->triangles + 3 * surface->triangle_count));
    const TriangleTree boundary_tree(mesh.positions, boundary);
    quality.mesh_to_surface =
        largest_distance(mesh, boundary.data(), boundary.size() / 3, spacing, surface_tree);
    quality.surface_to_mesh =
        largest_distance(*surface, surface->triangles, surface->triangle_count, spacing, boundary_tree);
    quality.hausdorff = std::max(quality.mesh_to_surface, quality.surface_to_mesh);
    return quality;
}

} // namespace vox::io
