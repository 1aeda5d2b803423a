// Closest points of triangles, in double (C. Ericson, Real-Time Collision Detection, 2005, Sect. 5.1). With
// coordinates in the range of floats, no square or product overflows.
#pragma once

#include "base/scene.hpp"

namespace vox {

// A point of a triangle, by its weights on the corners, and the squared distance to it.
struct ClosestPoint {
    double squared_distance;
    double weight[3];
};

// The point of the closed triangle abc that is closest to p. The triangle may be a segment or a point.
ClosestPoint closest_on_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) noexcept;

// The same, computed relative to p, so that rounding errors are in proportion to the distance and not to the
// coordinates. All searches for the closest point of a surface compare the distances of this function.
struct SeenPoint {
    ClosestPoint at;
    Vec3d way; // from p
};
SeenPoint closest_seen_from(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) noexcept;

} // namespace vox
