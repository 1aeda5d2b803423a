// Closest points, in double (C. Ericson, Real-Time Collision Detection, 2005, Sect. 5.1). Any float
// coordinates are small enough for their squares and products not to overflow.
#pragma once

#include "base/scene.hpp"

namespace vox {

// A point of a triangle: its weights for the corners, and the squared distance to it.
struct ClosestPoint {
    double squared_distance;
    double weight[3];
};

// The point of the closed triangle abc closest to p; abc may be an edge or a point.
ClosestPoint closest_on_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) noexcept;

// The same as seen from p, so that rounding errors are those of distances, not of coordinates. All searches
// for the closest point of a surface compare by this one.
struct SeenPoint {
    ClosestPoint at;
    Vec3d way; // from p
};
SeenPoint closest_seen_from(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) noexcept;

} // namespace vox
