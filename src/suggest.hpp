// The cell size that minimises a cost model, from the geometry of the scene (paper, Sect. 4).
#pragma once

#include "scene.hpp"

#include <vox/vox.h>

#include <span>

namespace vox {

// Throws Error: INVALID_ARGUMENT for a bad desc or when the bodies have no tetrahedron with an extent;
// NON_FINITE for a position. All fields but struct_size are set.
vox_suggestion suggest(const vox_suggest_desc& desc, std::span<const Body> bodies);

} // namespace vox
