// When a point and a triangle that move in straight lines, at constant speed, first meet.
#pragma once

#include "base/scene.hpp"

namespace vox {

// A triangle as seen from the point: each corner less the point, at time 0 and at time 1.
struct SeenMotion {
    Vec3d from[3], to[3];
};

inline constexpr double no_meeting = 2;

// A time in [0, latest] at which the two have not met before, and from which on they meet as soon as rounding
// errors let it tell; no_meeting if they stay apart until `latest`, at most 1. Never later than the exact
// time. A result that is not later does not depend on `latest`.
double meeting_time(const SeenMotion& motion, double latest) noexcept;

} // namespace vox
