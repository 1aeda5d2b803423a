// Bodies for the scenes, undeformed.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace bench {

struct Vec3 {
    double x, y, z;
};

// Lattice constant 1 where it is made from a lattice.
struct Solid {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> tets; // 4 * tet_count, positive
};

// nx * ny * nz cubes of the body-centred cubic lattice from the origin on, 12 tetrahedra a cube inside; those
// whose centroid `keep` refuses are left out. Inner vertices are moved by up to `jitter` on each axis.
Solid lattice_solid(int nx, int ny, int nz, const std::function<bool(const Vec3&)>& keep, double jitter,
                    std::uint64_t seed);

// A ball of about `tets` tetrahedra around the origin, and its radius.
double ball_radius(double tets);
Solid lattice_ball(double tets, std::uint64_t seed);

// Reads a mesh file; throws std::runtime_error when that fails or when this build has no readers.
Solid read_solid(const std::string& path);

// Gives vertices and tetrahedra random numbers.
void shuffle(Solid& solid, std::uint64_t seed);

double signed_volume(const Solid& solid, std::size_t tet);

// Uniform in [-1, 1): splitmix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators",
// 2014).
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    std::uint64_t bits();
    double uniform();

private:
    std::uint64_t state_;
};

} // namespace bench
