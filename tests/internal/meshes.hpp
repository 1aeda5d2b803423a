// The bodies of scenes/ as the arrays that the stages take, and operations on them.
#pragma once

#include "base/scene.hpp"
#include "internal/random.hpp"
#include "scenes/bodies.h"

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace vox::test {

struct Mesh {
    std::vector<Vec3f> positions;
    std::vector<Tet> tets;
    bool self_collision = false;
};

inline Mesh mesh_of(body made) {
    Mesh mesh;
    for (const float* p = made.positions; p != made.positions + 3 * std::size_t{made.vertex_count}; p += 3)
        mesh.positions.push_back({p[0], p[1], p[2]});
    for (const std::uint32_t* v = made.tets; v != made.tets + 4 * std::size_t{made.tet_count}; v += 4)
        mesh.tets.push_back({{v[0], v[1], v[2], v[3]}});
    free_body(&made);
    return mesh;
}

inline void move(Mesh& mesh, double scale, double x, double y, double z) {
    for (Vec3f& p : mesh.positions)
        p = {float(p.x * scale + x), float(p.y * scale + y), float(p.z * scale + z)};
}

// Cubes with edge 1 from the origin on, five tetrahedra each.
inline Mesh block(int nx, int ny, int nz) {
    return mesh_of(make_block(&five_cut_exchanged, std::uint32_t(nx), std::uint32_t(ny), std::uint32_t(nz)));
}

// Cubes with edge `edge` from `corner` on, six tetrahedra each.
inline Mesh kuhn_block(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, const Vec3d& corner,
                       double edge) {
    Mesh mesh = mesh_of(make_block(&kuhn_cut, nx, ny, nz));
    move(mesh, edge, corner.x, corner.y, corner.z);
    return mesh;
}

// A ball of about `tets` tetrahedra around the origin, of cubes with edge 1; *radius is what came out.
inline Mesh ball(double tets, double* radius = nullptr) {
    const double r = std::cbrt(tets / 5 * 3 / (4 * 3.14159265358979));
    if (radius) *radius = r;
    return mesh_of(make_lattice_ball(&five_cut_exchanged, std::uint32_t(std::ceil(r + 1)), r));
}

// Moves every vertex by up to `amount` on each axis.
inline void jitter(Mesh& mesh, double amount, Random& random) {
    for (Vec3f& p : mesh.positions)
        p = {p.x + random.uniform(-amount, amount), p.y + random.uniform(-amount, amount),
             p.z + random.uniform(-amount, amount)};
}

inline Mesh jittered(Mesh mesh, Random& random, double amount) {
    jitter(mesh, amount, random);
    return mesh;
}

// Puts the vertices and tets of `other` behind those of `mesh`.
inline void append(Mesh& mesh, const Mesh& other) {
    const auto first = std::uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    for (Tet tet : other.tets) {
        for (std::uint32_t& v : tet.v) v += first;
        mesh.tets.push_back(tet);
    }
}

// A random order of 0 .. count - 1.
inline std::vector<std::uint32_t> permutation(Random& random, std::size_t count) {
    std::vector<std::uint32_t> order(count);
    random_order(&random.state, std::uint32_t(count), order.data());
    return order;
}

template <class T>
void shuffle(std::vector<T>& list, Random& random) {
    std::vector<T> shuffled;
    for (const std::uint32_t i : permutation(random, list.size())) shuffled.push_back(list[i]);
    list = std::move(shuffled);
}

// New numbers for the vertices, and a new order of the tets.
inline void renumber(Mesh& mesh, Random& random) {
    const std::vector<std::uint32_t> number = permutation(random, mesh.positions.size());
    std::vector<Vec3f> positions(mesh.positions.size());
    for (std::size_t v = 0; v < number.size(); ++v) positions[number[v]] = mesh.positions[v];
    mesh.positions = std::move(positions);
    for (Tet& tet : mesh.tets)
        for (std::uint32_t& v : tet.v) v = number[v];
    shuffle(mesh.tets, random);
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

// The view of a mesh that the stages and engines take.
inline Body body_of(const Mesh& mesh, std::size_t id, bool self_collision) {
    Body body;
    body.mesh_id = std::uint32_t(id);
    body.vertex_count = std::uint32_t(mesh.positions.size());
    body.positions = {reinterpret_cast<const std::byte*>(mesh.positions.data()), sizeof(Vec3f)};
    body.tets = mesh.tets;
    body.self_collision = self_collision;
    return body;
}

} // namespace vox::test
