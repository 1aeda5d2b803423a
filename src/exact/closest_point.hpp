// Closest points of triangles, in double (C. Ericson, Real-Time Collision Detection, 2005, Sect. 5.1). With
// coordinates in the range of floats, no square or product overflows.
#pragma once

#include "base/scene.hpp"

#include <array>

namespace vox {

// A point of a triangle, by its weights on the corners, and the squared distance to it.
struct ClosestPoint {
    double squared_distance;
    double weight[3];
};

// The point of the closed triangle abc that is closest to p. The triangle may be a segment or a point, of any
// size down to denormals. The weights are not negative, and add up to 1 within 2^-26.
ClosestPoint closest_on_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) noexcept;

// The closest point, computed relative to p, so that rounding errors are in proportion to the distance and
// not to the coordinates. All searches for the closest point of a surface compare these distances.
struct SeenPoint {
    ClosestPoint at;
    Vec3d way; // from p to the point
};
SeenPoint closest_seen_from(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) noexcept;

// Weights of a closest point as the caller gets them: in [0, 1], with the sum 1 up to rounding.
inline std::array<double, 3> normalised(const double (&weight)[3]) noexcept {
    const double sum = weight[0] + weight[1] + weight[2];
    return {weight[0] / sum, weight[1] / sum, weight[2] / sum};
}

} // namespace vox
