// Scenes for the stage tests: small bodies of many kinds, and the views that the stages and the oracle take.
#pragma once

#include "base/scene.hpp"
#include "internal/random.hpp"
#include "support/oracle.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace vox {

struct Mesh {
    std::vector<Vec3f> positions;
    std::vector<Tet> tets;
    bool self_collision = false;
};

using Scene = std::vector<Mesh>;

inline std::vector<Body> bodies(const Scene& scene) {
    std::vector<Body> views;
    for (const Mesh& mesh : scene) {
        const Positions positions{reinterpret_cast<const std::byte*>(mesh.positions.data()), sizeof(Vec3f)};
        views.push_back({static_cast<std::uint32_t>(views.size()),
                         static_cast<std::uint32_t>(mesh.positions.size()), positions, mesh.tets,
                         mesh.self_collision});
    }
    return views;
}

inline std::vector<oracle_mesh> oracle_meshes(const Scene& scene) {
    static_assert(sizeof(Vec3f) == 3 * sizeof(float) && sizeof(Tet) == 4 * sizeof(std::uint32_t));
    std::vector<oracle_mesh> meshes;
    for (const Mesh& mesh : scene)
        meshes.push_back({reinterpret_cast<const float*>(mesh.positions.data()),
                          reinterpret_cast<const std::uint32_t*>(mesh.tets.data()),
                          static_cast<std::uint32_t>(mesh.positions.size()),
                          static_cast<std::uint32_t>(mesh.tets.size()), mesh.self_collision});
    return meshes;
}

// nx * ny * nz cubes of edge `edge` from `corner` on, each cut into six tetrahedra around its diagonal
// (Kuhn), so that neighbours share facets. Positions are exact where the numbers are small dyadic ones.
inline Mesh block(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, const Vec3d& corner, double edge) {
    Mesh mesh;
    for (std::uint32_t k = 0; k <= nz; ++k)
        for (std::uint32_t j = 0; j <= ny; ++j)
            for (std::uint32_t i = 0; i <= nx; ++i)
                mesh.positions.push_back({static_cast<float>(corner.x + edge * i),
                                          static_cast<float>(corner.y + edge * j),
                                          static_cast<float>(corner.z + edge * k)});
    const std::uint32_t step[3] = {1, nx + 1, (nx + 1) * (ny + 1)};
    for (std::uint32_t k = 0; k < nz; ++k)
        for (std::uint32_t j = 0; j < ny; ++j)
            for (std::uint32_t i = 0; i < nx; ++i) {
                const std::uint32_t v = i * step[0] + j * step[1] + k * step[2];
                std::uint32_t axes[3] = {0, 1, 2};
                do { // from one end of the diagonal to the other along the axes in every order
                    const std::uint32_t first = v + step[axes[0]], second = first + step[axes[1]];
                    mesh.tets.push_back({{v, first, second, second + step[axes[2]]}});
                } while (std::next_permutation(axes, axes + 3));
            }
    return mesh;
}

// Moves every vertex by up to `amount` on each axis.
inline Mesh jittered(Mesh mesh, Random& random, double amount) {
    for (Vec3f& p : mesh.positions)
        p = {p.x + random.uniform(-amount, amount), p.y + random.uniform(-amount, amount),
             p.z + random.uniform(-amount, amount)};
    return mesh;
}

// Vertices at random, tetrahedra over random vertices, equal ones included: nothing a mesh should be.
template <class Coordinate>
Mesh soup(Random& random, std::uint32_t vertices, std::uint32_t tets, Coordinate&& coordinate) {
    Mesh mesh;
    for (std::uint32_t v = 0; v < vertices; ++v)
        mesh.positions.push_back({coordinate(random), coordinate(random), coordinate(random)});
    for (std::uint32_t t = 0; t < tets; ++t)
        mesh.tets.push_back({{random.below(vertices), random.below(vertices), random.below(vertices),
                              random.below(vertices)}});
    return mesh;
}

template <class Function>
Scene mapped(Scene scene, Function&& function) {
    for (Mesh& mesh : scene)
        for (Vec3f& p : mesh.positions) p = function(p);
    return scene;
}

inline Scene swapped_winding(Scene scene) {
    for (Mesh& mesh : scene)
        for (Tet& tet : mesh.tets) std::swap(tet.v[2], tet.v[3]);
    return scene;
}

// A random order of 0 .. count-1.
inline std::vector<std::uint32_t> permutation(Random& random, std::size_t count) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    for (std::size_t i = count; i > 1; --i)
        std::swap(order[i - 1], order[random.below(static_cast<std::uint32_t>(i))]);
    return order;
}

// Mean edge length over the tetrahedra, for cell sizes; 1 where there is none.
inline double mean_edge(const Scene& scene) {
    double sum = 0;
    std::size_t count = 0;
    for (const Mesh& mesh : scene)
        for (const Tet& tet : mesh.tets)
            for (int i = 0; i < 4; ++i)
                for (int j = 0; j < i; ++j) {
                    const Vec3f &a = mesh.positions[tet.v[i]], &b = mesh.positions[tet.v[j]];
                    sum += std::hypot(double(a.x) - double(b.x), double(a.y) - double(b.y),
                                      double(a.z) - double(b.z));
                    ++count;
                }
    return sum > 0 ? sum / static_cast<double>(count) : 1;
}

} // namespace vox
