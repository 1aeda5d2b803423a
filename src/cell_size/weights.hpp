// What a unit of each piece of work costs: the weights of the cost models, one set for the whole process.
#pragma once

#include <vox/vox.h>

namespace vox {

// Measured once on the machine at hand, rounded: what is used until vox_cost_calibrate or
// vox_cost_set_weights.
vox_cost_weights shipped_weights() noexcept;

// Those in use. Any thread.
vox_cost_weights weights_in_use() noexcept;
void use_weights(const vox_cost_weights& weights) noexcept;

// Throws INVALID_ARGUMENT naming the field that is not a number above 0.
void check_weights(const vox_cost_weights& weights);

} // namespace vox
