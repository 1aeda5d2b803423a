// The cell size that minimises a cost model, from the geometry of the scene (paper, Sect. 4).
#pragma once

#include "geometry.hpp"

#include <vox/vox.h>

namespace vox {

// Throws INVALID_ARGUMENT for a field that vox.h does not allow.
void check_suggest_desc(const vox_suggest_desc& desc);

// For a desc that passed the check. All fields but struct_size are set. Throws INVALID_ARGUMENT when the
// scene has no tetrahedra, none with an extent, or sizes beyond any computation.
vox_suggestion suggest(const vox_suggest_desc& desc, const Geometry& geometry);

} // namespace vox
