// The weights of the cost models, measured on the machine at hand.
#pragma once

#include <vox/vox.h>

namespace vox {

// Steps both engines over a small scene at a few cell sizes and fits the weights to their times and counters.
// Takes about ten milliseconds; throws std::bad_alloc.
vox_cost_weights measure_weights();

// The same, once in a process.
const vox_cost_weights& measured_weights();

} // namespace vox
