// Embedding lattice: Müller, Teschner, Gross, "Physically-based simulation of objects represented by surface
// meshes", CGI 2004. Triangle against cube: Akenine-Möller, "Fast 3D triangle-box overlap testing", 2001.
#include "io/solids/cubes.hpp"

#include "base/error.hpp"
#include "base/llu.hpp"
#include "io/solids/five_tets.hpp"

#include <algorithm>
#include <cmath>

namespace vox::io {
namespace {

using Vector = std::array<double, 3>;

Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Whether the triangle intersects the unit cube at `cube`, enlarged a little so that no cube is missed
// because of rounding.
bool touches(const std::array<Vector, 3>& triangle, const Vector& cube) {
    constexpr double half = 0.5 + 1e-7;
    std::array<Vector, 3> p = triangle;
    for (Vector& point : p)
        for (std::size_t k = 0; k < 3; ++k) point[k] -= cube[k] + 0.5;
    const auto apart = [&](const Vector& axis) {
        std::array<double, 3> at{};
        for (std::size_t i = 0; i < 3; ++i) at[i] = axis[0] * p[i][0] + axis[1] * p[i][1] + axis[2] * p[i][2];
        const double reach = half * (std::abs(axis[0]) + std::abs(axis[1]) + std::abs(axis[2]));
        return std::min({at[0], at[1], at[2]}) > reach || std::max({at[0], at[1], at[2]}) < -reach;
    };
    std::array<Vector, 3> edges{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) edges[i][k] = p[(i + 1) % 3][k] - p[i][k];
    for (std::size_t k = 0; k < 3; ++k) {
        Vector axis = {0, 0, 0};
        axis[k] = 1;
        if (apart(axis)) return false;
        for (const Vector& edge : edges)
            if (apart(cross(axis, edge))) return false;
    }
    return !apart(cross(edges[0], edges[1]));
}

// Calls visit(i, j, k) for the unit cubes that the triangle touches. It searches columns along the axis
// closest to the triangle's normal, so that the work is proportional to the area.
template <class Visit>
void for_each_touched(const std::array<Vector, 3>& triangle, Visit&& visit) {
    Vector e1{}, e2{};
    for (std::size_t k = 0; k < 3; ++k) {
        e1[k] = triangle[1][k] - triangle[0][k];
        e2[k] = triangle[2][k] - triangle[0][k];
    }
    const Vector normal = cross(e1, e2);
    std::size_t w = 0; // the column's axis
    for (std::size_t k = 1; k < 3; ++k)
        if (std::abs(normal[k]) > std::abs(normal[w])) w = k;
    const std::size_t u = (w + 1) % 3, v = (w + 2) % 3;
    std::array<std::int32_t, 3> low{}, high{};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto [least, most] = std::minmax({triangle[0][k], triangle[1][k], triangle[2][k]});
        low[k] = static_cast<std::int32_t>(std::floor(least - 1e-6));
        high[k] = static_cast<std::int32_t>(std::floor(most + 1e-6));
    }
    for (std::int32_t i = low[u]; i <= high[u]; ++i)
        for (std::int32_t j = low[v]; j <= high[v]; ++j) {
            // The range where the plane passes through the column, or all of the triangle's extent if it has
            // no normal.
            double least = low[w], most = high[w];
            if (normal[w] != 0) {
                const double at = triangle[0][w] - ((i + 0.5 - triangle[0][u]) * normal[u] +
                                                    (j + 0.5 - triangle[0][v]) * normal[v]) /
                                                       normal[w];
                // The slope is at most 1 in u and in v.
                least = std::max(least, std::floor(at - 1.01));
                most = std::min(most, std::floor(at + 1.01));
            }
            for (auto k = static_cast<std::int32_t>(least); k <= static_cast<std::int32_t>(most); ++k) {
                Vector cube{};
                cube[u] = i;
                cube[v] = j;
                cube[w] = k;
                if (touches(triangle, cube))
                    visit(static_cast<std::int32_t>(cube[0]), static_cast<std::int32_t>(cube[1]),
                          static_cast<std::int32_t>(cube[2]));
            }
        }
}

void check_count(std::uint64_t cubes, std::uint64_t max_tets) {
    if (5 * cubes > max_tets)
        throw Error(VOX_ERROR_LIMIT,
                    format("%llu cubes make %llu tets, at most %llu are allowed: choose larger cells",
                           llu(cubes), llu(5 * cubes), llu(max_tets)));
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
    for (std::size_t t = 0; t < surface.triangle_count; ++t) {
        std::array<Vector, 3> triangle{};
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k)
                triangle[i][k] =
                    (surface.positions[3 * std::size_t{surface.triangles[3 * t + i]} + k] - frame.origin[k]) /
                    cell;
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
    corners.for_each_run([&](std::uint32_t, const Run& run) {
        for (std::int32_t i = run.first; i <= run.last; ++i) {
            const Vector p = frame.position(2 * i, run.y, run.z);
            mesh.positions.insert(mesh.positions.end(), p.begin(), p.end());
        }
    });
    mesh.tets.reserve(20 * std::size_t{cubes.size()});
    cubes.for_each_run([&](std::uint32_t, const Run& run) {
        for (std::int32_t i = run.first; i <= run.last; ++i) {
            std::array<std::uint32_t, 8> number{};
            for (std::int32_t c = 0; c < 8; ++c)
                number[static_cast<std::size_t>(c)] =
                    corners.find({2 * (i + (c & 1)), run.y + (c & 2), run.z + (c & 4) / 2});
            for (const auto& tet : five_tets(i + run.y / 2 + run.z / 2))
                for (const std::uint8_t corner : tet) mesh.tets.push_back(number[corner]);
        }
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
