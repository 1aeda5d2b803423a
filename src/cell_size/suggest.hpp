// The cell size that minimises a cost model, and why (paper, Sect. 4; the models are in cost/).
#pragma once

#include "base/scene.hpp"
#include "cell_size/activity.hpp"
#include "cell_size/effort.hpp"
#include "cell_size/geometry.hpp"
#include "cell_size/scene_boxes.hpp"
#include "cell_size/terms.hpp"
#include "fast/engine.hpp"

#include <vox/vox.h>

#include <memory_resource>
#include <span>

namespace vox {

// Throws INVALID_ARGUMENT for a field that vox.h does not allow.
void check_suggest_desc(const vox_suggest_desc& desc);

// What is suggested for. All positions are finite (measure() has looked).
struct SuggestScene {
    std::span<const Body> bodies;
    std::span<const Tiles* const> tiles; // of each body; for VOX_COST_MODEL_FAST alone, as what follows
    std::span<const Activity> activity;        // of each body in the last step; none where there was none
    SampleBudget effort = thorough;
    // For FAST, what there is already of either: the boxes of the bodies and tiles, or a step of the engine in
    // which the bodies were where they are now; then there need be no tiles.
    SceneBoxes* boxes = nullptr;
    const FastEngine* last_step = nullptr;
};

// For a desc that passed the check. All fields but struct_size are set. Throws INVALID_ARGUMENT when the
// scene has no tetrahedra, none with an extent, or sizes beyond any computation.
vox_suggestion suggest(const vox_suggest_desc& desc, const Geometry& geometry, const SuggestScene& scene,
                       const vox_cost_weights& weights, std::pmr::memory_resource* memory);

// The terms of the model at one cell size, as the bodies lie. Throws as suggest().
CostTerms predict(const vox_suggest_desc& desc, const Geometry& geometry, const SuggestScene& scene,
                  const vox_cost_weights& weights, double cell_size, std::pmr::memory_resource* memory);

void write_shares(const CostTerms& terms, vox_cost_share (&out)[VOX_COST_TERM_CAPACITY],
                  std::uint32_t& count);

} // namespace vox
