// The time at which two features first come into contact, while their corners move along straight lines.
#pragma once

#include "surface/motion.hpp"

#include <cstdint>
#include <span>

namespace vox {

struct ContactTimeRule {
    double distance;               // contact is where features come this close
    double slack;                  // of the distance at time 0 that may be left
    std::uint32_t most_iterations; // >= 1
};

struct ContactTime {
    double time = 1;      // up to then the features are further apart than the distance; 1 without contact
    bool touches = false; // whether there may be contact from then on, within the motion
    bool finished = true; // else it was given up after so many iterations, and the time is early
};

// `a` and `b` are a face and a vertex, or two edges, by their corners. Gives up, with a time above `latest`,
// as soon as the time is seen to be above it. What it returns else does not depend on `latest`.
ContactTime contact_time(const SurfaceMotion& motion, std::span<const std::uint32_t> a,
                         std::span<const std::uint32_t> b, const ContactTimeRule& rule,
                         double latest) noexcept;

} // namespace vox
