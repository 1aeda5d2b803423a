// The cell size that minimises the cost model of an engine, or of the paper (Sect. 4), and the reasons for
// it.
#pragma once

#include "cell_size/scene.hpp"
#include "cell_size/search.hpp"

#include <vox/vox.h>

#include <cstdint>
#include <functional>

namespace vox {

vox_suggest_desc suggest_defaults();
// Throws INVALID_ARGUMENT for a field that vox.h does not allow.
void check_suggest_desc(const vox_suggest_desc& desc);

// Both prepare the scene for desc.model and take a desc that passed the check.

// Sets all fields but struct_size. Throws INVALID_ARGUMENT where the scene has no tetrahedra, none of any
// size, or sizes beyond computation.
vox_suggestion suggest(const vox_suggest_desc& desc, CellSizeScene& scene, const vox_cost_weights& weights);

// What the model predicts at one cell size, as the bodies lie. Throws as suggest().
vox_cost_prediction predict(const vox_suggest_desc& desc, CellSizeScene& scene,
                            const vox_cost_weights& weights, double cell_size);

// The same for a cost that is described elsewhere, whose terms are given: it is least in `range`, and the
// zone reaches three octaves beyond that at most.
vox_suggestion suggest_by(const vox_suggest_desc& desc, const Geometry& geometry,
                          const std::function<CostTerms(double cell_size)>& terms,
                          const CellSizeRange& range);
vox_cost_prediction prediction_of(const CostTerms& terms, double cell_size);

} // namespace vox
