// Scenes of a few meshes for the tests of stages, and the views that the stages and the oracle take.
#pragma once

#include "internal/meshes.hpp"
#include "support/oracle.h"

#include <cmath>
#include <utility>
#include <vector>

namespace vox::test {

using Meshes = std::vector<Mesh>;

inline std::vector<Body> bodies(const Meshes& scene) {
    std::vector<Body> views;
    for (const Mesh& mesh : scene) views.push_back(body_of(mesh, views.size(), mesh.self_collision));
    return views;
}

inline std::vector<oracle_mesh> oracle_meshes(const Meshes& scene) {
    static_assert(sizeof(Vec3f) == 3 * sizeof(float) && sizeof(Tet) == 4 * sizeof(std::uint32_t));
    std::vector<oracle_mesh> meshes;
    for (const Mesh& mesh : scene)
        meshes.push_back({reinterpret_cast<const float*>(mesh.positions.data()),
                          reinterpret_cast<const std::uint32_t*>(mesh.tets.data()),
                          static_cast<std::uint32_t>(mesh.positions.size()),
                          static_cast<std::uint32_t>(mesh.tets.size()), mesh.self_collision});
    return meshes;
}

template <class Function>
Meshes mapped(Meshes scene, Function&& function) {
    for (Mesh& mesh : scene)
        for (Vec3f& p : mesh.positions) p = function(p);
    return scene;
}

inline Meshes swapped_winding(Meshes scene) {
    for (Mesh& mesh : scene)
        for (Tet& tet : mesh.tets) std::swap(tet.v[2], tet.v[3]);
    return scene;
}

// Mean edge length over the tetrahedra, for cell sizes; 1 where there is none.
inline double mean_edge(const Meshes& scene) {
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

} // namespace vox::test
