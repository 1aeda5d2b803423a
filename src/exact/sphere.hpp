// Distances of a point from a sphere and a box, to the last place.
#pragma once

#include "base/scene.hpp"

namespace vox {

// |p| - radius, off by at most one unit in its last place, however close p is to the sphere. Coordinates and
// radius are below 2^400.
double distance_to_sphere(const Vec3d& p, double radius) noexcept;
// The distance to the box around the origin, for a point outside or on it, with the same error.
double distance_to_box(const Vec3d& p, const Vec3d& half_size) noexcept;

} // namespace vox
