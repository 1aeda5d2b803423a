// Filters at the C border.
#pragma once

#include <vox/vox.h>

namespace vox {

// A caller's filter, completed and checked; null: the defaults. Throws Error(INVALID_ARGUMENT or LIMIT).
vox_filter read_filter(const vox_filter* filter);

} // namespace vox
