// The cell size of a described grid that costs a run least, and the reasons for it.
#pragma once

#include "cell_size/foreign/grid.hpp"

#include <vox/vox_cell_size.h>

namespace vox {

// Sets all fields but struct_size.
vox_cell_size_result suggest_for(const ForeignGrid& grid, ForeignWork& work);

} // namespace vox
