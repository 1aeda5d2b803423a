// Measures steps of bodies that move.
#pragma once

#include "body.hpp"
#include "grid.hpp"

namespace tool {

// Runs one step to warm up, then returns the median of `repeat` more. In each, the bodies wobble by a
// thousandth of their size, as a body at rest would cost less. At the end the positions are restored, and a
// last step finds their contacts.
Counters measure_steps(vox_grid* grid, std::span<Body> bodies, std::span<const vox_body> ids,
                       std::uint32_t repeat);

} // namespace tool
