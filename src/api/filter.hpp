// What more than one file of the C border reads from a caller.
#pragma once

#include <vox/vox.h>

#include <cstdint>

namespace vox {

// Throws Error(INVALID_ARGUMENT) for other numbers than 0 and 1.
bool read_enabled(std::uint32_t enabled);

} // namespace vox
