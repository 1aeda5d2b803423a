#include "fast/step_scene.hpp"

namespace vox {

void StreamedScene::fill(std::span<const fast::PreparedBody> prepared, StepScene& scene) {
    fast::begin_step(scene.bodies, scene.workers, step_);
    for (std::size_t b = 0; b < prepared.size(); ++b) {
        step_.of[b].tiles = prepared[b].tiles;
        step_.of[b].moved = true;
    }
    fast::lay_out(step_, boxes_);
    fast::stream(step_, boxes_, stream_);
    fast::find_pairs(boxes_.bodies, {scene.bodies, step_.of}, pair_buffers_, pairs_);
    scene.of = step_.of;
    scene.boxes = &boxes_;
    scene.pairs = pairs_;
    scene.origin = step_.origin;
}

} // namespace vox
