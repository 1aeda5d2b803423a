// Distances of two features: vertices, edges and faces, by their corners. In double, relative to one of the
// corners, so that errors are in proportion to the size of the pair. Features may be degenerate, and of any
// size down to denormals.
#pragma once

#include "base/vectors.hpp"

#include <cmath>
#include <span>

namespace vox {

struct CloseFeatures {
    double distance;
    double weights_a[3], weights_b[3]; // of the closest points, on the corners; the rest is 0
    Vec3d point_a, point_b;            // rounded
};

// Takes face and vertex, edge and edge, edge and vertex, vertex and vertex, in either order: 3 corners, 2
// or 1. `distance` is that of two points of the features up to rounding, so it is never below the exact one
// by more than 2^-48 of the size of the pair.
CloseFeatures closest_features(std::span<const Vec3d> a, std::span<const Vec3d> b) noexcept;

// A proven lower bound of the distance of a face and a vertex, or of two edges; 0 where there is none.
double distance_at_least(std::span<const Vec3d> a, std::span<const Vec3d> b) noexcept;

// Directions from b to a along which they lie apart about as far as they can, best first. Any may be zero or
// nonsense; what follows from them has to be proven by projecting the corners.
struct Axes {
    Vec3d axis[3];
    double length; // of the way between the closest points; the best that an axis can do
};
template <int kA, int kB>
Axes axes_between(const Vec3d (&a)[kA], const Vec3d (&b)[kB]) noexcept;

inline constexpr double good_enough = 0.999; // part of it, so that the next axis need not be tried

// Projections on axes whose squared length is less lose digits to underflow.
inline constexpr double least_squared_axis = 0x1p-900;

// By how many powers of two to enlarge a pair of that size, so that no product of three of its lengths
// underflows.
inline int powers_to_enlarge(double size) noexcept {
    return size > 0 && size < 0x1p-160 ? -std::ilogb(size) : 0;
}

} // namespace vox
