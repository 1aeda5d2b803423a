// The cell size of a grid that chooses it: before the first step by the cost model, and then as the bodies
// change. Several sizes, where the tetrahedra are so unlike that one for all of them would be dear.
//
// Near the optimum a cell size d trades visits V(d) for reads R(d): at the best one c_visit V and c_read R
// stand in a fixed ratio, that of the slopes of log V and log R. So log(R / V), which every step counts
// anyway, tells how far d is from where it was best: when the bodies grow by a factor, or come into deeper
// contact, d follows by the change of log(R / V) over its slope. That costs nothing. Several sizes follow
// together, all of them by the same factor, so that their ratios stay. The model itself, at a price, is
// asked again, over a sample of the scene, after meshes came or went or d has moved far, and only as often as
// that stays below a hundredth of the time of the steps, told by counts: the same calls always give the same
// sizes. Where d has moved, that is when the steps since have paid for it; new meshes need not wait.
#pragma once

#include "cell_size/levels.hpp"

#include "base/scene.hpp"

#include <vox/vox.h>

#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

class AdaptiveCellSize {
public:
    struct Setting {
        vox_storage storage;
        double byte_limit; // of the cells of dense storage; 0: none
    };

    // Meshes came or went, or were cut.
    void scene_changed() noexcept { scene_changed_ = true; }
    // Forgets everything: the next step chooses anew.
    void restart() noexcept { *this = {}; }

    // Before a step with these bodies: the cell sizes for it, one at least. Where memory for the choice is
    // refused, it is made from a few tetrahedra. Throws NON_FINITE when a choice is due and a position is not
    // finite. Good until the next call.
    std::span<const CellLevel> cell_sizes(std::span<const Body> bodies, const Setting& setting,
                                          std::pmr::memory_resource* memory);

    // After that step: what it did.
    void observe(const vox_counters& counters) noexcept;

    // Times that cell_sizes() gave other sizes than before.
    std::uint64_t changes() const noexcept { return changes_; }

private:
    bool must_choose() const noexcept;
    void follow() noexcept;
    bool choose(std::span<const Body> bodies, const Setting& setting, std::pmr::memory_resource* memory);

    void use(double cell_size) noexcept;
    void scale(double factor) noexcept;

    Levels sizes_{};     // none: not chosen yet
    double floor_ = 0;   // of the byte limit
    double moved_ = 0;   // logarithm of how far the sizes are from what the model chose the last time
    bool sized_ = false; // the model found tetrahedra with a size
    bool scene_changed_ = false;
    double slope_ = 0;        // of log(R / V) over log d, at what was chosen
    double balance_ = 0;      // log(R / V) of the first step after the choice ...
    bool balanced_ = false;   // ... which there was
    double last_balance_ = 0; // of the last step
    double credit_ = 0;       // nanoseconds that may be spent on choosing, ...
    double price_ = 0;        // ... never more than for one choice
    std::uint64_t changes_ = 0;
};

} // namespace vox
