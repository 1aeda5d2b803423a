// Scenes for the tests and the benchmark of the engines: bodies cut from a cubic lattice, five tetrahedra a
// cube, and what can be done to them.
#pragma once

#include "base/scene.hpp"
#include "fast/engine.hpp"
#include "internal/random.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <deque>
#include <memory_resource>
#include <numeric>
#include <utility>
#include <vector>

struct Mesh {
    std::vector<vox::Vec3f> positions;
    std::vector<vox::Tet> tets;
};

// The cubes (i, j, k) of a lattice with unit edges that `keep` wants, in five tetrahedra each, mirrored from
// cube to cube so that their facets match. Vertices in lattice order, x fastest; all tets positive.
template <class Keep>
Mesh lattice(int nx, int ny, int nz, Keep keep) {
    static constexpr int even[5][4] = {{0, 1, 3, 5}, {0, 3, 2, 6}, {0, 5, 6, 4}, {3, 6, 5, 7}, {0, 3, 6, 5}};
    static constexpr int odd[5][4] = {{1, 2, 0, 4}, {1, 3, 2, 7}, {1, 4, 5, 7}, {2, 6, 4, 7}, {1, 2, 4, 7}};
    const auto at = [&](int i, int j, int k) {
        return (std::size_t(k) * std::size_t(ny + 1) + std::size_t(j)) * std::size_t(nx + 1) + std::size_t(i);
    };
    std::vector<std::uint32_t> number(at(nx, ny, nz) + 1, ~0u);
    Mesh mesh;
    for (int k = 0; k < nz; ++k)
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i) {
                if (!keep(i, j, k)) continue;
                std::size_t corner[8];
                for (int c = 0; c < 8; ++c) corner[c] = at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
                for (const auto& tet : (i + j + k) % 2 ? odd : even) {
                    vox::Tet made{};
                    for (int c = 0; c < 4; ++c) {
                        made.v[c] = std::uint32_t(corner[tet[c]]);
                        number[made.v[c]] = 0;
                    }
                    mesh.tets.push_back(made);
                }
            }
    std::uint32_t count = 0;
    for (int k = 0; k <= nz; ++k)
        for (int j = 0; j <= ny; ++j)
            for (int i = 0; i <= nx; ++i)
                if (std::uint32_t& n = number[at(i, j, k)]; n != ~0u) {
                    n = count++;
                    mesh.positions.push_back({float(i), float(j), float(k)});
                }
    for (vox::Tet& tet : mesh.tets)
        for (std::uint32_t& v : tet.v) v = number[v];
    return mesh;
}

inline Mesh block(int nx, int ny, int nz) {
    return lattice(nx, ny, nz, [](int, int, int) { return true; });
}

// A ball of about `tets` tets around the origin, of unit lattice edges; *radius is what came out.
inline Mesh ball(double tets, double* radius = nullptr) {
    const double r = std::cbrt(tets / 5 * 3 / (4 * 3.14159265358979));
    const int n = 2 * int(std::ceil(r + 1));
    Mesh mesh = lattice(n, n, n, [&](int i, int j, int k) {
        const double x = i + 0.5 - n / 2, y = j + 0.5 - n / 2, z = k + 0.5 - n / 2;
        return x * x + y * y + z * z < r * r;
    });
    for (vox::Vec3f& p : mesh.positions) p = {p.x - float(n / 2), p.y - float(n / 2), p.z - float(n / 2)};
    if (radius) *radius = r;
    return mesh;
}

inline void jitter(Mesh& mesh, double amount, Random& random) {
    for (vox::Vec3f& p : mesh.positions)
        p = {p.x + random.uniform(-amount, amount), p.y + random.uniform(-amount, amount),
             p.z + random.uniform(-amount, amount)};
}

inline void move(Mesh& mesh, double scale, double x, double y, double z) {
    for (vox::Vec3f& p : mesh.positions)
        p = {float(p.x * scale + x), float(p.y * scale + y), float(p.z * scale + z)};
}

// Both in one mesh.
inline void append(Mesh& mesh, const Mesh& other) {
    const auto first = std::uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    for (vox::Tet tet : other.tets) {
        for (std::uint32_t& v : tet.v) v += first;
        mesh.tets.push_back(tet);
    }
}

template <class T>
void shuffle(std::vector<T>& list, Random& random) {
    for (std::size_t i = list.size(); i > 1; --i)
        std::swap(list[i - 1], list[random.below(std::uint32_t(i))]);
}

// New numbers for the vertices, and a new order of the tets.
inline void renumber(Mesh& mesh, Random& random) {
    std::vector<std::uint32_t> number(mesh.positions.size());
    std::iota(number.begin(), number.end(), 0u);
    shuffle(number, random);
    std::vector<vox::Vec3f> positions(mesh.positions.size());
    for (std::size_t v = 0; v < number.size(); ++v) positions[number[v]] = mesh.positions[v];
    mesh.positions = std::move(positions);
    for (vox::Tet& tet : mesh.tets)
        for (std::uint32_t& v : tet.v) v = number[v];
    shuffle(mesh.tets, random);
}

// Bodies over meshes, ready for both engines. Meshes stay where they are.
class Scene {
public:
    explicit Scene(std::pmr::memory_resource* memory = std::pmr::get_default_resource()) : memory_(memory) {}

    Mesh& add(Mesh mesh, bool self_collision = false) {
        meshes_.push_back(std::move(mesh));
        self_.push_back(self_collision);
        return meshes_.back();
    }

    std::deque<Mesh>& meshes() { return meshes_; }

    // Takes the bodies' views and prepares their tiles; again after a mesh was added.
    void prepare() {
        bodies_.clear();
        tiled_.clear();
        states_.clear();
        prepared_.clear();
        for (std::size_t i = 0; i < meshes_.size(); ++i) {
            const Mesh& mesh = meshes_[i];
            vox::Body body;
            body.mesh_id = std::uint32_t(i + 1);
            body.vertex_count = std::uint32_t(mesh.positions.size());
            body.positions = {reinterpret_cast<const std::byte*>(mesh.positions.data()), sizeof(vox::Vec3f)};
            body.tets = mesh.tets;
            body.self_collision = self_[i];
            bodies_.push_back(body);
            vox::TiledMesh& tiled = tiled_.emplace_back(memory_);
            vox::make_tiled_mesh(body, tiled);
            vox::fast::MeshState& state = states_.emplace_back(memory_);
            state.update(tiled, 1, body.vertex_count);
            prepared_.push_back({&tiled.tiles, &tiled.boundary, &state});
        }
    }

    std::vector<vox::Body>& bodies() { return bodies_; }
    const std::vector<vox::fast::PreparedBody>& prepared() const { return prepared_; }
    std::vector<const vox::Tiles*> tiles() const {
        std::vector<const vox::Tiles*> tiles;
        for (const vox::fast::PreparedBody& body : prepared_) tiles.push_back(body.tiles);
        return tiles;
    }

private:
    std::pmr::memory_resource* memory_;
    std::deque<Mesh> meshes_;
    std::deque<bool> self_;
    std::vector<vox::Body> bodies_;
    std::deque<vox::TiledMesh> tiled_;
    std::deque<vox::fast::MeshState> states_;
    std::vector<vox::fast::PreparedBody> prepared_;
};

// Hits as comparable numbers, sorted.
using Key = std::array<std::uint32_t, 5>;

template <class Hits>
std::vector<Key> keys(const Hits& hits) {
    std::vector<Key> out;
    out.reserve(hits.size());
    for (const vox::Hit& h : hits) out.push_back({h.body_a, h.vertex, h.body_b, h.tet, h.interior});
    std::sort(out.begin(), out.end());
    return out;
}
