// Bodies for the scenes, undeformed: those of scenes/solids.h, and files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace bench {

struct Vec3 {
    double x, y, z;
};

struct Solid {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> tets; // 4 * tet_count, positive
};

// A beam of nx * ny * nz cubes of the body-centred cubic lattice, from the origin on.
Solid lattice_beam(int nx, int ny, int nz, double jitter, std::uint64_t seed);

// A ball of about `tets` tetrahedra around the origin; the lattice's edge is 1.
Solid lattice_ball(double tets, std::uint64_t seed);
double ball_radius(double tets);

// A ball of the paper's experiment (vox_io_make_lattice_ball) with cubes of edge 1: tetrahedra at its
// boundary are flat. Throws std::runtime_error when this build has no such bodies.
Solid cube_ball(double tets);
double cube_ball_radius(double tets);

// Reads a mesh file; throws std::runtime_error when that fails or when this build has no readers.
Solid read_solid(const std::string& path);

// Gives vertices and tetrahedra random numbers.
void shuffle(Solid& solid, std::uint64_t seed);

// `point` moved by three sine waves that run through the body; `rest` is where the point is at rest.
Vec3 waved(const Vec3& point, const Vec3& rest, double amplitude, double wave_number, double phase);

} // namespace bench
