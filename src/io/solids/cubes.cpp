// Embedding lattice: Müller, Teschner, Gross, "Physically-based simulation of objects represented by surface
// meshes", CGI 2004. Triangle against cube: Akenine-Möller, "Fast 3D triangle-box overlap testing", 2001.
#include "io/solids/cubes.hpp"

#include "base/llu.hpp"
#include "io/solids/bodies.hpp"
#include "io/solids/five_tets.hpp"
#include "io/throw_error.hpp"

#include <algorithm>
#include <cmath>

namespace vox::io {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

// Whether the triangle, whose corners are columns, intersects the unit cube at `cube`, enlarged a little so
// that no cube is missed because of rounding.
bool touches(const Matrix3d& triangle, const Vector3d& cube) {
    constexpr double half = 0.5 + 1e-7;
    const Matrix3d p = triangle.colwise() - (cube + Vector3d::Constant(0.5));
    const auto apart = [&](const Vector3d& axis) {
        const Vector3d at = p.transpose() * axis;
        const double reach = half * axis.lpNorm<1>();
        return at.minCoeff() > reach || at.maxCoeff() < -reach;
    };
    Matrix3d edges;
    for (int i = 0; i < 3; ++i) edges.col(i) = p.col((i + 1) % 3) - p.col(i);
    for (int k = 0; k < 3; ++k) {
        const Vector3d axis = Vector3d::Unit(k);
        if (apart(axis)) return false;
        for (int i = 0; i < 3; ++i)
            if (apart(axis.cross(edges.col(i)))) return false;
    }
    return !apart(edges.col(0).cross(edges.col(1)));
}

// Calls visit(i, j, k) for the unit cubes that the triangle touches. It searches columns along the axis
// closest to the triangle's normal, so that the work is proportional to the area.
template <class Visit>
void for_each_touched(const Matrix3d& triangle, Visit&& visit) {
    const Vector3d first = triangle.col(0);
    const Vector3d normal = (triangle.col(1) - first).cross(triangle.col(2) - first);
    int w = 0; // the column's axis
    normal.cwiseAbs().maxCoeff(&w);
    const int u = (w + 1) % 3, v = (w + 2) % 3;
    const Eigen::Vector3i low = (triangle.rowwise().minCoeff().array() - 1e-6).floor().cast<int>(),
                          high = (triangle.rowwise().maxCoeff().array() + 1e-6).floor().cast<int>();
    for (std::int32_t i = low[u]; i <= high[u]; ++i)
        for (std::int32_t j = low[v]; j <= high[v]; ++j) {
            // The range where the plane passes through the column, or all of the triangle's extent if it has
            // no normal.
            double least = low[w], most = high[w];
            if (normal[w] != 0) {
                const double at =
                    first[w] -
                    ((i + 0.5 - first[u]) * normal[u] + (j + 0.5 - first[v]) * normal[v]) / normal[w];
                // The slope is at most 1 in u and in v.
                least = std::max(least, std::floor(at - 1.01));
                most = std::min(most, std::floor(at + 1.01));
            }
            for (auto k = static_cast<std::int32_t>(least); k <= static_cast<std::int32_t>(most); ++k) {
                Eigen::Vector3i cube;
                cube[u] = i;
                cube[v] = j;
                cube[w] = k;
                if (touches(triangle, cube.cast<double>())) visit(cube[0], cube[1], cube[2]);
            }
        }
}

void check_count(std::uint64_t cubes, std::uint64_t max_tets) {
    if (5 * cubes > max_tets)
        throw_error(VOX_ERROR_LIMIT,
                    "%llu cubes make %llu tets, at most %llu are allowed: choose larger cells", llu(cubes),
                    llu(5 * cubes), llu(max_tets));
}

} // namespace

MeshData make_cubes(const vox_io_mesh_view& surface, const Frame& frame, const NodeSet& inside,
                    std::uint64_t max_tets) {
    // Cube (i, j, k) is named by its lowest corner, the node (2 i, 2 j, 2 k).
    std::vector<Run> runs;
    inside.for_each_run([&](std::uint32_t, const Run& run) {
        if (run.y & 1) runs.push_back({run.y - 1, run.z - 1, run.first, run.last});
    });
    const double cell = 2 * frame.half_cell;
    const Vector3d origin(frame.origin.data());
    for (std::size_t t = 0; t < surface.triangle_count; ++t) {
        Matrix3d triangle;
        for (int i = 0; i < 3; ++i) {
            const std::size_t v = surface.triangles[3 * t + static_cast<std::size_t>(i)];
            triangle.col(i) = (Vector3d(surface.positions + 3 * v) - origin) / cell;
        }
        for_each_touched(triangle, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
            runs.push_back({2 * j, 2 * k, i, i});
        });
    }
    const NodeSet cubes(frame, std::move(runs));
    check_count(cubes.size(), max_tets);

    runs.clear();
    cubes.for_each_run([&](std::uint32_t, const Run& run) {
        for (const std::int32_t y : {0, 2})
            for (const std::int32_t z : {0, 2})
                runs.push_back({run.y + y, run.z + z, run.first, run.last + 1});
    });
    const NodeSet corners(frame, std::move(runs));
    MeshData mesh;
    mesh.positions.reserve(3 * std::size_t{corners.size()});
    corners.for_each_node([&](std::uint32_t, const Node& node) {
        const std::array<double, 3> p = frame.position(node.x, node.y, node.z);
        mesh.positions.insert(mesh.positions.end(), p.begin(), p.end());
    });
    mesh.tets.reserve(20 * std::size_t{cubes.size()});
    cubes.for_each_node([&](std::uint32_t, const Node& node) {
        std::array<std::uint32_t, 8> number{};
        for (std::int32_t c = 0; c < 8; ++c)
            number[static_cast<std::size_t>(c)] = corners.find(node + Node{2 * (c & 1), c & 2, (c & 4) / 2});
        for (const auto& tet : five_tets(node.x / 2 + node.y / 2 + node.z / 2))
            for (const std::uint8_t corner : tet) mesh.tets.push_back(number[corner]);
    });
    return mesh;
}

MeshData make_box(const std::array<double, 3>& size, const std::array<std::int32_t, 3>& cells) {
    std::array<std::uint64_t, 3> points{};
    for (std::size_t k = 0; k < 3; ++k) points[k] = static_cast<std::uint64_t>(cells[k]) + 1;
    check_count((points[0] - 1) * (points[1] - 1) * (points[2] - 1), VOX_MAX_TETS);
    const auto place = [&](std::size_t k, std::uint64_t i) {
        return (static_cast<double>(2 * i) - cells[k]) / (2.0 * cells[k]) * size[k];
    };
    MeshData mesh;
    mesh.positions.reserve(3 * points[0] * points[1] * points[2]);
    for (std::uint64_t z = 0; z < points[2]; ++z)
        for (std::uint64_t y = 0; y < points[1]; ++y)
            for (std::uint64_t x = 0; x < points[0]; ++x)
                for (const double p : {place(0, x), place(1, y), place(2, z)}) mesh.positions.push_back(p);
    for (std::uint64_t z = 0; z + 1 < points[2]; ++z)
        for (std::uint64_t y = 0; y + 1 < points[1]; ++y)
            for (std::uint64_t x = 0; x + 1 < points[0]; ++x)
                for (const auto& tet : five_tets(static_cast<std::int64_t>(x + y + z)))
                    for (const std::uint8_t c : tet)
                        mesh.tets.push_back(static_cast<std::uint32_t>(
                            ((z + (c >> 2)) * points[1] + y + (c >> 1 & 1u)) * points[0] + x + (c & 1u)));
    return mesh;
}

} // namespace vox::io
