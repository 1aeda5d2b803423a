// When a point and a triangle that move linearly first meet.
#pragma once

#include "base/scene.hpp"

#include <cstdint>

namespace vox {

// A triangle relative to the point: each corner minus the point, at time 0 and at time 1.
struct SeenMotion {
    Vec3d from[3], to[3];
};

inline constexpr double no_meeting = 2;

// A time in [0, latest], never later than the exact time of the meeting, and earlier only by what rounding
// errors leave undecided; no_meeting if the two stay apart until `latest`, at most 1. Otherwise the result
// does not depend on `latest`. Adds to `tests` how many intervals were tested.
double meeting_time(const SeenMotion& motion, double latest, std::uint64_t& tests) noexcept;

} // namespace vox
