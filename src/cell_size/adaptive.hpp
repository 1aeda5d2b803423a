// The cell sizes of a grid that chooses them: by the cost model before the first step, then adapted as the
// bodies change. Several sizes where the tetrahedra are so unlike that one for all of them would be
// expensive.
//
// Near the optimum a cell size d trades visits V(d) for reads R(d): at the best one c_visit V and c_read R
// have a fixed ratio, that of the slopes of log V and log R. So log(R / V), which every step counts anyway,
// shows how far d is from the best size. When the bodies grow by a factor, or overlap more deeply, d changes
// by the change of log(R / V) over its slope, at no cost. Several sizes are scaled by the same factor, so
// their ratios stay.
//
// The model is asked again, over a sample of the scene, after meshes were added, removed or cut, or when d
// has been scaled far; for that, only when the steps since have paid for it. Choosing stays below a hundredth
// of the time of the steps, estimated from counters, so that the same calls always give the same sizes.
#pragma once

#include "base/counters.hpp"
#include "base/scene.hpp"
#include "cell_size/levels.hpp"
#include "cell_size/weights.hpp"

#include <vox/vox.h>

#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

class AdaptiveCellSize {
public:
    explicit AdaptiveCellSize(const CostWeights& weights) noexcept : weights_(weights) {}
    // Call after meshes were added, removed or cut.
    void scene_changed() noexcept { scene_changed_ = true; }
    // The next step chooses as if it were the first.
    void restart() noexcept { *this = AdaptiveCellSize(weights_); }

    // The cell sizes for a step with these bodies, at least one, valid until the next call. Dense storage has
    // at most `byte_limit` bytes of cells (0: any number). Where memory for a choice is refused, it is made
    // from a few tetrahedra. Throws NON_FINITE when a choice is due and a position is not finite.
    std::span<const CellLevel> cell_sizes(std::span<const Body> bodies, bool dense, double byte_limit,
                                          std::pmr::memory_resource* memory);

    // Call after that step with what it counted.
    void observe(const Counters& counters) noexcept;

    const CostWeights& weights() const noexcept { return weights_; }
    // How often cell_sizes() returned other sizes than the time before.
    std::uint64_t changes() const noexcept { return changes_; }

private:
    bool must_choose() const noexcept;
    void adapt() noexcept;
    bool choose(std::span<const Body> bodies, bool dense, double byte_limit,
                std::pmr::memory_resource* memory);

    CostWeights weights_;
    Levels sizes_{};     // empty before the first choice
    double floor_ = 0;   // the smallest size that the byte limit allows
    double moved_ = 0;   // logarithm of how far the sizes have been scaled since the last choice
    bool sized_ = false; // the model found tetrahedra with a size
    bool scene_changed_ = false;
    double slope_ = 0;        // of log(R / V) over log d, at the last choice
    double balance_ = 0;      // log(R / V) of the first step after that choice
    bool balanced_ = false;   // whether there was such a step
    double last_balance_ = 0; // of the last step
    double credit_ = 0;       // nanoseconds that may be spent on choosing, at most `price_`
    double price_ = 0;        // of one choice
    std::uint64_t changes_ = 0;
};

} // namespace vox
