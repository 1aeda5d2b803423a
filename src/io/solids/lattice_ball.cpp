// A ball is a cubic lattice with each cube split into five tetrahedra, the boundary moved onto the sphere and
// the inside smoothed. It reproduces the mean edge and the optima that Tables 1 and 2 of the cell size paper
// state for the five spheres (n_trad within .4 %, n_a within .5 %). Fitting a lattice to the boundary of a
// shape follows Spillmann, Wagner, Teschner, "Robust tetrahedral meshing of triangle soups", VMV 2006.
//
// The result is the same on every platform, since it uses only + - * / and square roots, in a fixed order.
#include "io/solids/bodies.hpp"

#include "io/determinant.hpp"
#include "io/solids/five_tets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace vox::io {
namespace {

using Point = std::array<double, 3>;

// The origin's position in its cube, chosen so that the body has no exact symmetry.
constexpr Point offset = {.137, .271, .419};
constexpr double pi = std::numbers::pi;

double norm(const Point& p) { return std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]); }

// Uses Newton's iteration rather than std::cbrt, whose last bit depends on the platform. `x` must be
// positive.
double cube_root(double x) {
    int exponent = 0;
    (void)std::frexp(x, &exponent);
    double root = std::ldexp(1.0, exponent / 3 + 1); // above the root, so the iterates descend
    for (;;) {
        const double next = (2 * root + x / (root * root)) / 3;
        if (!(next < root)) return root;
        root = next;
    }
}

// A lattice with cubes from -half to half - 1 on each axis. Points are indexed with x fastest.
struct Lattice {
    std::int64_t half = 0;
    std::int64_t side = 0;             // points along an axis
    std::vector<std::uint8_t> inside;  // for each point, whether it is in the ball
    std::vector<std::uint8_t> kept;    // for each cube, by its lowest corner, whether it is in the ball
    std::vector<std::uint32_t> vertex; // for each point its vertex, or no_vertex
    std::uint64_t cubes = 0;

    std::int64_t step(int axis) const { return axis == 0 ? 1 : axis == 1 ? side : side * side; }
    // The point at a corner of the cube at a point; the bits of its number are its coordinates.
    std::size_t corner(std::size_t cube, int number) const {
        return cube + static_cast<std::size_t>((number & 1) + (number >> 1 & 1) * side +
                                               (number >> 2) * side * side);
    }
    // Of a point, from the origin's cube on.
    std::int64_t sum_of_coordinates(std::size_t point) const {
        const auto p = static_cast<std::int64_t>(point);
        return p % side + p / side % side + p / (side * side) - 3 * half;
    }
};

constexpr std::uint32_t no_vertex = 0xffffffffu;

Point lattice_point(std::int64_t half, double spacing, std::int64_t x, std::int64_t y, std::int64_t z) {
    return {(static_cast<double>(x - half) + offset[0]) * spacing,
            (static_cast<double>(y - half) + offset[1]) * spacing,
            (static_cast<double>(z - half) + offset[2]) * spacing};
}

Lattice select_cubes(double spacing) {
    Lattice lattice;
    lattice.half = static_cast<std::int64_t>(1 / spacing) + 3;
    lattice.side = 2 * lattice.half + 1;
    const std::int64_t side = lattice.side;
    lattice.inside.resize(static_cast<std::size_t>(side * side * side));
    lattice.kept.resize(lattice.inside.size());
    std::size_t at = 0;
    for (std::int64_t z = 0; z < side; ++z)
        for (std::int64_t y = 0; y < side; ++y)
            for (std::int64_t x = 0; x < side; ++x)
                lattice.inside[at++] = norm(lattice_point(lattice.half, spacing, x, y, z)) <= 1;
    // The outermost points are well outside the ball, so every point of an inner cube has all its neighbours.
    for (std::size_t i = 0; i + static_cast<std::size_t>(side * side + side + 1) < lattice.inside.size();
         ++i) {
        bool all = true;
        for (int corner = 0; corner < 8; ++corner) all = all && lattice.inside[lattice.corner(i, corner)];
        lattice.kept[i] = all;
        lattice.cubes += all;
    }
    return lattice;
}

double signed_volume(const double* a, const double* b, const double* c, const double* d) {
    const Point u = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const Point v = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const Point w = {d[0] - a[0], d[1] - a[1], d[2] - a[2]};
    return determinant(u, v, w) / 6;
}

// Moves all inner vertices at once to the mean of their neighbours, three times. An inner vertex has all of
// its eight cubes and therefore six neighbours along the axes and, if the diagonals of the faces around it
// end in it, twelve along those.
void smooth_inside(std::vector<double>& positions, const Lattice& lattice,
                   const std::vector<std::uint32_t>& points, const std::vector<std::uint8_t>& boundary) {
    std::array<std::int64_t, 18> neighbours{};
    std::size_t count = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (const int i : {-1, 1}) neighbours[count++] = i * lattice.step(axis);
    for (int axis = 0; axis < 3; ++axis)
        for (const int i : {-1, 1})
            for (const int j : {-1, 1})
                neighbours[count++] = i * lattice.step(axis) + j * lattice.step((axis + 1) % 3);
    std::vector<double> old;
    for (int sweep = 0; sweep < 3; ++sweep) {
        old = positions;
        for (std::size_t v = 0; v < points.size(); ++v) {
            if (boundary[v]) continue;
            const std::int64_t p = points[v];
            const bool diagonals = ends_diagonals(lattice.sum_of_coordinates(points[v]));
            const std::size_t degree = diagonals ? 18 : 6;
            Point sum = {0, 0, 0};
            for (std::size_t n = 0; n < degree; ++n) {
                const std::uint32_t w = lattice.vertex[static_cast<std::size_t>(p + neighbours[n])];
                for (std::size_t k = 0; k < 3; ++k) sum[k] += old[3 * std::size_t{w} + k];
            }
            for (std::size_t k = 0; k < 3; ++k) positions[3 * v + k] = sum[k] / static_cast<double>(degree);
        }
    }
}

// Removes tets of less than a thousandth of the median volume (most of them have four corners on the sphere),
// and the vertices that are no longer used.
void drop_flat(MeshData& mesh) {
    const std::size_t count = mesh.tets.size() / 4;
    std::vector<double> volumes(count);
    const double* p = mesh.positions.data();
    for (std::size_t t = 0; t < count; ++t) {
        const std::uint32_t* v = &mesh.tets[4 * t];
        volumes[t] = signed_volume(p + 3 * std::size_t{v[0]}, p + 3 * std::size_t{v[1]},
                                   p + 3 * std::size_t{v[2]}, p + 3 * std::size_t{v[3]});
    }
    std::vector<double> sorted = volumes;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    double median = *middle;
    if (count % 2 == 0) median = (median + *std::max_element(sorted.begin(), middle)) / 2;

    std::vector<std::uint32_t> number(mesh.positions.size() / 3, no_vertex);
    std::size_t kept = 0;
    for (std::size_t t = 0; t < count; ++t) {
        if (!(volumes[t] > 1e-3 * median)) continue;
        for (std::size_t k = 0; k < 4; ++k) {
            mesh.tets[4 * kept + k] = mesh.tets[4 * t + k];
            number[mesh.tets[4 * t + k]] = 0;
        }
        ++kept;
    }
    mesh.tets.resize(4 * kept);
    std::uint32_t used = 0;
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] == no_vertex) continue;
        for (std::size_t k = 0; k < 3; ++k)
            mesh.positions[3 * std::size_t{used} + k] = mesh.positions[3 * v + k];
        number[v] = used++;
    }
    mesh.positions.resize(3 * std::size_t{used});
    for (std::uint32_t& v : mesh.tets) v = number[v];
}

// The ball of radius 1 over a lattice of the given spacing; empty if no cube fits.
MeshData build(double spacing) {
    MeshData mesh;
    Lattice lattice = select_cubes(spacing);
    if (lattice.cubes == 0) return mesh;
    const std::int64_t side = lattice.side;

    std::vector<std::uint32_t> points; // lattice point of each vertex
    std::vector<std::uint8_t> used(lattice.inside.size()), outer(lattice.inside.size());
    for (std::size_t cube = 0; cube < lattice.kept.size(); ++cube) {
        if (!lattice.kept[cube]) continue;
        for (int corner = 0; corner < 8; ++corner) {
            const std::size_t point = lattice.corner(cube, corner);
            used[point] = 1;
            // A corner is on the boundary if a face of this cube that it belongs to has no cube behind it.
            for (int k = 0; k < 3; ++k) {
                const std::int64_t step = corner >> k & 1 ? lattice.step(k) : -lattice.step(k);
                if (!lattice.kept[cube + static_cast<std::size_t>(step)]) outer[point] = 1;
            }
        }
    }
    lattice.vertex.assign(used.size(), no_vertex);
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (!used[i]) continue;
        lattice.vertex[i] = static_cast<std::uint32_t>(points.size());
        points.push_back(static_cast<std::uint32_t>(i));
    }

    std::vector<std::uint8_t> boundary(points.size());
    mesh.positions.resize(3 * points.size());
    for (std::size_t v = 0; v < points.size(); ++v) {
        const std::int64_t p = points[v];
        Point position = lattice_point(lattice.half, spacing, p % side, p / side % side, p / (side * side));
        boundary[v] = outer[points[v]];
        if (boundary[v]) {
            const double length = norm(position);
            for (double& x : position) x /= length;
        }
        std::copy(position.begin(), position.end(),
                  mesh.positions.begin() + static_cast<std::ptrdiff_t>(3 * v));
    }
    smooth_inside(mesh.positions, lattice, points, boundary);

    mesh.tets.reserve(20 * lattice.cubes);
    for (std::size_t cube = 0; cube < lattice.kept.size(); ++cube) {
        if (!lattice.kept[cube]) continue;
        for (const auto& tet : five_tets(lattice.sum_of_coordinates(cube)))
            for (const std::uint8_t corner : tet)
                mesh.tets.push_back(lattice.vertex[lattice.corner(cube, corner)]);
    }
    drop_flat(mesh);
    return mesh;
}

std::uint64_t distance(const MeshData& mesh, std::uint64_t tet_count) {
    const std::uint64_t tets = mesh.tets.size() / 4;
    return tets > tet_count ? tets - tet_count : tet_count - tets;
}

// For few tets. Tries every spacing at which one more cube fits in, around the wanted number of cubes.
MeshData search_all(std::uint64_t tet_count) {
    const double cubes_wanted = static_cast<double>(tet_count) / 5;
    const std::int64_t reach = static_cast<std::int64_t>(cube_root(3 * (cubes_wanted + 8) / (4 * pi))) + 3;
    std::vector<double> farthest; // of each cube near the origin, for spacing 1
    for (std::int64_t z = -reach; z < reach; ++z)
        for (std::int64_t y = -reach; y < reach; ++y)
            for (std::int64_t x = -reach; x < reach; ++x) {
                double most = 0; // distance of the farthest corner
                for (int c = 0; c < 8; ++c)
                    most = std::max(most,
                                    norm(lattice_point(0, 1, x + (c & 1), y + (c >> 1 & 1), z + (c >> 2))));
                farthest.push_back(most);
            }
    std::sort(farthest.begin(), farthest.end());
    MeshData best;
    const std::size_t last = static_cast<std::size_t>(1.5 * cubes_wanted) + 4;
    const std::size_t first = std::max<std::size_t>(static_cast<std::size_t>(cubes_wanted), 2) - 2;
    for (std::size_t k = first; k <= last; ++k) {
        MeshData mesh = build((1 - 1e-9) / farthest[k]); // k + 1 cubes, or more if several fit in at once
        if (mesh.tets.empty()) continue;
        if (best.tets.empty() || distance(mesh, tet_count) < distance(best, tet_count))
            best = std::move(mesh);
    }
    return best;
}

// For many tets, whose number is nearly proportional to 1 / spacing^3.
MeshData search_spacing(std::uint64_t tet_count) {
    const double wanted = static_cast<double>(tet_count);
    double spacing = cube_root(5 * 4 * pi / 3 / wanted);
    MeshData best;
    for (int attempt = 0; attempt < 14; ++attempt) {
        MeshData mesh = build(spacing);
        const double ratio = static_cast<double>(mesh.tets.size() / 4) / wanted;
        if (best.tets.empty() || distance(mesh, tet_count) < distance(best, tet_count))
            best = std::move(mesh);
        if (std::abs(ratio - 1) < 1e-3) break;
        spacing *= cube_root(ratio);
    }
    return best;
}

} // namespace

MeshData make_lattice_ball(std::uint64_t tet_count, double radius) {
    MeshData mesh = tet_count < 2000 ? search_all(tet_count) : search_spacing(tet_count);
    for (double& x : mesh.positions) x *= radius;
    return mesh;
}

} // namespace vox::io
