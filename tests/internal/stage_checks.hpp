// What the tests of the fast engine's stages share: bodies of every kind, every SIMD level, and plain loops
// that say what the stages should find.
#pragma once

#include "base/simd.hpp"
#include "exact/predicates.hpp"
#include "internal/fast_scenes.hpp"

#include <set>
#include <string>

namespace stages {

// Calls function(name of the level) at every SIMD level of this machine.
template <class Function>
void at_each_level(Function&& function) {
    using vox::simd::Level;
    for (const Level level : {Level::portable, Level::sse4, Level::avx2, Level::avx512})
        if (vox::simd::force_level(level) == level) function(vox::simd::level_name(level));
    vox::simd::force_level(vox::simd::best_level());
}

inline vox::Positions view(const Mesh& mesh) {
    return {reinterpret_cast<const std::byte*>(mesh.positions.data()), sizeof(vox::Vec3f)};
}

inline const float* packed(const Mesh& mesh) { return reinterpret_cast<const float*>(mesh.positions.data()); }

inline std::uint32_t vertex_count(const Mesh& mesh) { return std::uint32_t(mesh.positions.size()); }

inline vox::Tiles tiles_of(const Mesh& mesh) {
    vox::Tiles tiles(std::pmr::get_default_resource());
    vox::make_tiles(mesh.tets, vertex_count(mesh), view(mesh), tiles);
    return tiles;
}

inline vox::Box box_around(const vox::Vec3f& p) { return {{p.x, p.y, p.z, 0}, {p.x, p.y, p.z, 0}}; }

inline vox::Box box_of(const Mesh& mesh) {
    vox::Box box = vox::empty_box;
    for (const vox::Vec3f& p : mesh.positions) vox::add(box, box_around(p));
    return box;
}

inline bool same(const vox::Box& a, const vox::Box& b) {
    return std::equal(a.lo, a.lo + 3, b.lo) && std::equal(a.hi, a.hi + 3, b.hi);
}

inline bool owns(const vox::Tet& tet, std::uint32_t v) { return std::count(tet.v, tet.v + 4, v) != 0; }

inline vox::Containment locate_in(const Mesh& mesh, const vox::Tet& tet, const vox::Vec3f& p) {
    std::uint64_t exact_tests = 0;
    return vox::locate(p, mesh.positions[tet.v[0]], mesh.positions[tet.v[1]], mesh.positions[tet.v[2]],
                       mesh.positions[tet.v[3]], exact_tests);
}

inline bool holds(vox::Containment where) {
    return where == vox::Containment::interior || where == vox::Containment::boundary;
}

// Tets over vertices at random; coordinates on a lattice of halves where `snapped`.
inline Mesh soup(Random& r, std::uint32_t vertices, std::uint32_t tets, double extent, bool snapped) {
    return vox::test::soup(r, vertices, tets, [=](Random& random) {
        const float c = random.uniform(-extent, extent);
        return snapped ? std::round(c * 2) / 2 : c;
    });
}

} // namespace stages
