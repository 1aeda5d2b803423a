#include "bodies.hpp"

#include "scenes/solids.h"
#include "scenes/waves.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#if defined(BENCH_IO)
#include <vox/vox_io.h>
#endif

namespace bench {
namespace {

Solid taken(solid made) {
    Solid solid;
    for (const double* p = made.positions; p != made.positions + 3 * std::size_t{made.vertex_count}; p += 3)
        solid.positions.push_back({p[0], p[1], p[2]});
    solid.tets.assign(made.tets, made.tets + 4 * std::size_t{made.tet_count});
    free_solid(&made);
    return solid;
}

} // namespace

Solid lattice_beam(int nx, int ny, int nz, double jitter, std::uint64_t seed) {
    return taken(make_lattice_solid(static_cast<std::uint32_t>(nx), static_cast<std::uint32_t>(ny),
                                    static_cast<std::uint32_t>(nz), 0, jitter, seed));
}

Solid lattice_ball(double tets, std::uint64_t seed) { return taken(make_solid_ball(tets, seed)); }

double ball_radius(double tets) { return solid_ball_radius(tets); }

double cube_ball_radius(double tets) { return std::cbrt(tets / 5 * 3 / (4 * std::numbers::pi)); }

#if defined(BENCH_IO)
namespace {

Solid taken(vox_result made, vox_io_mesh* mesh) {
    vox_io_mesh_view view;
    if (made != VOX_OK || vox_io_mesh_get_arrays(mesh, &view) != VOX_OK)
        throw std::runtime_error(vox_last_error());
    Solid solid;
    for (std::uint64_t v = 0; v < view.vertex_count; ++v)
        solid.positions.push_back(
            {view.positions[3 * v], view.positions[3 * v + 1], view.positions[3 * v + 2]});
    solid.tets.assign(view.tets, view.tets + 4 * view.tet_count);
    vox_io_mesh_destroy(mesh);
    return solid;
}

} // namespace

Solid read_solid(const std::string& path) {
    vox_io_mesh* mesh = nullptr;
    const vox_result made = vox_io_load(path.c_str(), nullptr, &mesh);
    return taken(made, mesh);
}

Solid cube_ball(double tets) {
    vox_io_mesh* mesh = nullptr;
    const vox_result made =
        vox_io_make_lattice_ball(static_cast<std::uint64_t>(tets), cube_ball_radius(tets), &mesh);
    return taken(made, mesh);
}
#else
Solid cube_ball(double) { throw std::runtime_error("this build has no such balls (VOX_BUILD_IO=OFF)"); }

Solid read_solid(const std::string& path) {
    throw std::runtime_error("this build has no mesh readers (VOX_BUILD_IO=OFF): cannot read " + path);
}
#endif

void shuffle(Solid& solid, std::uint64_t seed) {
    std::vector<std::uint32_t> vertex(solid.positions.size()), tet(solid.tets.size() / 4);
    random_order(&seed, static_cast<std::uint32_t>(vertex.size()), vertex.data());
    random_order(&seed, static_cast<std::uint32_t>(tet.size()), tet.data());
    Solid shuffled = solid;
    for (std::size_t v = 0; v < vertex.size(); ++v) shuffled.positions[vertex[v]] = solid.positions[v];
    for (std::size_t t = 0; t < tet.size(); ++t)
        for (std::size_t k = 0; k < 4; ++k) shuffled.tets[4 * tet[t] + k] = vertex[solid.tets[4 * t + k]];
    solid = std::move(shuffled);
}

Vec3 waved(const Vec3& point, const Vec3& rest, double amplitude, double wave_number, double phase) {
    const double at[3] = {rest.x, rest.y, rest.z};
    double moved[3] = {point.x, point.y, point.z};
    add_sine_waves(amplitude, wave_number, phase, at, moved);
    return {moved[0], moved[1], moved[2]};
}

} // namespace bench
