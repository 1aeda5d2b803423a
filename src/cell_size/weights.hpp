// What a unit of each piece of work costs: the weights of the cost models, one set for the whole process.
#pragma once

#include <vox/vox.h>

namespace vox {

// Used until vox_cost_calibrate or vox_cost_set_weights.
vox_cost_weights shipped_weights() noexcept;

// Both from any thread.
vox_cost_weights weights_in_use() noexcept;
void use_weights(const vox_cost_weights& weights) noexcept;

// Weights as a program gives them to vox_cost_set_weights; null: those shipped. Throws INVALID_ARGUMENT naming
// the field that is not a finite number above 0.
vox_cost_weights read_weights(const vox_cost_weights* given);

} // namespace vox
