// What more than one file of the C border reads from a caller.
#pragma once

#include <vox/vox.h>

#include <cstdint>

namespace vox {

// A caller's filter, completed and checked; null: the defaults. Throws Error(INVALID_ARGUMENT or LIMIT).
vox_filter read_filter(const vox_filter* filter);

// Throws Error(INVALID_ARGUMENT) for a filter with which a mesh would collide with nothing, as nothing was
// set in it.
void refuse_zeroed(const vox_filter& filter);

// Throws Error(INVALID_ARGUMENT) for other numbers than 0 and 1.
bool read_enabled(std::uint32_t enabled);

} // namespace vox
