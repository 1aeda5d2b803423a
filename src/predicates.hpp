// Exact geometric decisions: point in closed tetrahedron, orientation. Float input, the sign as if computed in
// infinite precision.
#pragma once

#include "scene.hpp"

#include <array>
#include <cstdint>

namespace vox {

// Sign (-1, 0, +1) of det[b-a, c-a, d-a]: positive when d lies on the side of triangle abc that its
// counter-clockwise normal points to. `exact_tests` counts the calls that the filter could not decide.
int orientation(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d, std::uint64_t& exact_tests);

enum class Containment : std::uint8_t {
    outside,
    boundary, // on a face, an edge or a corner
    interior,
    degenerate // the tetrahedron has exactly zero volume and holds nothing
};

// Where p lies with respect to the closed tetrahedron abcd, of either winding.
Containment locate(const Vec3f& p, const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d,
                   std::uint64_t& exact_tests);

// Weights of the corners for a point p in the closed tetrahedron abcd of non-zero volume: each in [0, 1], within
// 2^-20 of the true weight. The one function that makes them, so that every engine gives the same bits.
std::array<float, 4> barycentric(const Vec3f& p, const Vec3f& a, const Vec3f& b, const Vec3f& c,
                                 const Vec3f& d);

} // namespace vox
