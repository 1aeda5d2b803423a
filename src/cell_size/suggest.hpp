// The cell size that minimises the cost model of an engine, or of the paper (Sect. 4), and the reasons for
// it.
#pragma once

#include "cell_size/scene.hpp"
#include "cell_size/search.hpp"
#include "cell_size/weights.hpp"

#include <vox/vox_cell_size.h>

#include <cstdint>
#include <functional>

namespace vox {

// Throws INVALID_ARGUMENT for unknown ones of vox_reference_flags.
void check_reference_flags(std::uint32_t flags, const char* name);

// Sets the fields whose 0 stands for something else. Throws INVALID_ARGUMENT for one that
// vox_cell_size.h does not allow.
void check_suggest_desc(vox_cell_size_desc& desc);

// Takes a desc that passed the check, prepares the scene for its model, and sets all fields but struct_size.
// Throws INVALID_ARGUMENT where the scene has no tetrahedra, none of any size, or sizes beyond computation.
vox_cell_size_result suggest(const vox_cell_size_desc& desc, CellSizeScene& scene,
                             const CostWeights& weights);

// The same for a cost whose terms are given: it is least in `range`, and the zone is within `whole`.
vox_cell_size_result suggest_by(const vox_cell_size_desc& desc, const Geometry& geometry,
                                const std::function<CostTerms(double cell_size)>& terms,
                                const CellSizeRange& range, const CellSizeRange& whole);

} // namespace vox
