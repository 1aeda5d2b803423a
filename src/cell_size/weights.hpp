// What a unit of each piece of work costs: the weights of the cost models, one set for the whole process.
#pragma once

#include <vox/vox_cell_size.h>

namespace vox {

// Used until vox_cost_calibrate or vox_cost_set_weights.
vox_cost_weights shipped_weights() noexcept;

// Both from any thread.
vox_cost_weights weights_in_use() noexcept;
void use_weights(const vox_cost_weights& weights) noexcept;

// Weights as a program gives them to vox_cost_set_weights; null: those shipped. Throws INVALID_ARGUMENT
// naming the field that is not a finite number above 0.
vox_cost_weights read_weights(const vox_cost_weights* given);

// Measured once in a process, on the machine at hand (calibrate.cpp): steps both engines over a small scene
// at a few cell sizes and fits the weights to their times and counters. Takes about ten milliseconds; throws
// std::bad_alloc.
const vox_cost_weights& measured_weights();

} // namespace vox
