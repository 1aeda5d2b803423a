// A uniform grid that is not this library's, as its user describes it (vox_foreign_grid), and what a run of
// it does at a cell size: the counts, and what they cost.
#pragma once

#include "base/array.hpp"
#include "cell_size/foreign/primitives.hpp"
#include "cell_size/pairs.hpp"
#include "cell_size/search.hpp"

#include <vox/vox_cell_size.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <optional>
#include <span>

namespace vox {

// ---- the description --------------------------------------------------------------------------------

// The numbers of vox_foreign_weights, in its order.
using WeightArray = std::array<double, sizeof(vox_foreign_weights) / sizeof(double)>;

// A grid that people have, as it is described and what its work takes; NONE has no weights.
const vox_foreign_grid& known_grid(vox_known_grid known) noexcept;

// Where nothing is known of the times: what loses least in the worst of the known grids that hold, look and
// keep their cells in this way.
vox_foreign_weights weights_of_any(vox_cells_stored stored, vox_cells_queried queried,
                                   bool is_dense) noexcept;

// With those weights a gain over another size may be none where it is smaller than this: the known grids of
// that kind differ so much.
double doubtful_gain(vox_cells_stored stored, vox_cells_queried queried, bool is_dense) noexcept;

// The caller's description, read and checked. The arrays of primitives are borrowed.
struct ForeignGrid {
    // Throws INVALID_ARGUMENT, INVALID_MESH, LIMIT.
    explicit ForeignGrid(const vox_foreign_grid* from_caller);

    vox_foreign_grid desc; // without defaults: with the weights that are in use
    bool weights_known;    // whether they are of some grid, not those for any
    Primitives held;
    std::optional<Primitives> asking; // another set

    bool same_set() const noexcept { return !asking; }
    const Primitives& those_asking() const noexcept { return asking ? *asking : held; }
    bool pairs() const noexcept { return desc.cells_queried == VOX_CELLS_QUERIED_PAIRS; }
    bool dense() const noexcept { return desc.cells_kept == VOX_CELLS_KEPT_DENSE; }
    bool centres() const noexcept { return desc.cells_stored == VOX_CELLS_STORED_CENTRE; }
    // By how much boxes are larger than their primitives with radii. Where the same boxes are put into cells
    // and paired there, the radius of the grid is theirs.
    double held_grown() const noexcept { return pairs() && same_set() ? desc.radius : 0; }
};

// ---- what a run does --------------------------------------------------------------------------------

// Beyond this a count is of no use: products of such counts and of times leave the range of doubles.
inline constexpr double most_counted = 1e80;

inline double grid_cost(const vox_foreign_counts& work, const vox_foreign_weights& weights) noexcept {
    return weights.run + weights.store * work.stored + weights.visit * work.visits +
           weights.found * (work.visits - work.empty) + weights.read * work.reads +
           weights.occupied * work.occupied + weights.cell * work.cells;
}

// For vox_foreign_grid_suggest: a look at 20,000 primitives takes less than half a millisecond, at a million
// a few.
inline SampleBudget quick_look(const ForeignGrid& grid) noexcept {
    const std::uint64_t count = std::max(grid.held.count(), grid.those_asking().count());
    const std::uint64_t held = std::clamp<std::uint64_t>(count / 10, 2048, 8192);
    const std::uint64_t chosen = std::min<std::uint64_t>(held / 32, 128);
    return {0, held, held / 4, static_cast<std::size_t>(chosen), 3, 48, 0.5, 48};
}
// What that takes, about.
inline constexpr std::size_t quick_look_bytes = std::size_t{1} << 19;
// For vox_foreign_grid_count. The tests hold its counts to within 5 % of those in a filled grid.
inline constexpr SampleBudget thorough_look{
    0, std::uint64_t{1} << 18, std::uint64_t{1} << 15, 4096, 1, 16384, 0, 131072};

// What a run does, as a function of the cell size.
class ForeignWork {
public:
    // Looks at the primitives. All memory, also that of at(), comes from `memory`. Throws INVALID_ARGUMENT,
    // INVALID_MESH, NON_FINITE, LIMIT.
    ForeignWork(const ForeignGrid& grid, const SampleBudget& budget, std::pmr::memory_resource* memory);
    ForeignWork(const ForeignWork&) = delete;
    ForeignWork& operator=(const ForeignWork&) = delete;

    // Empty and occupied cells take longer to count: they are 0 unless wanted, and come from a table over the
    // sizes that fills as it is asked.
    vox_foreign_counts at(double cell_size, bool empty = true, bool occupied = true);
    // All, with occupied and empty cells counted at this very size.
    vox_foreign_counts exactly_at(double cell_size);
    // All but occupied and empty cells, of which the former are 0 here and the latter as many as visits.
    vox_foreign_counts smooth_at(double cell_size) const noexcept;
    // Whether all counts are numbers of at most most_counted; those at larger sizes are, too.
    bool is_countable(double cell_size) const noexcept;

    double least_cell_size() const noexcept { return least_; } // that is legal; 0: any
    // Cell sizes that can matter, none below the least one: from tiny ones to one cell that holds all. Where
    // all are in one place and have no size, min and max are the least size, or 1.
    const CellSizeRange& range() const noexcept { return range_; }
    // Cell sizes that rules of thumb would choose; 0 where a rule does not apply. The first is the mean edge.
    std::span<const vox_cell_size_rule> rules() const noexcept { return rules_; }
    bool without_size() const noexcept { return !has_size_; } // points that ask points
    bool in_one_place() const noexcept { return !(extent_ > 0); }
    double asking_count() const noexcept { return asking_count_; }
    std::uint64_t pairs_looked_at() const noexcept { return read_.added(); }

private:
    double empty_share(double cell_size) const;
    double occupied_share(double cell_size);
    double occupied_of_few(double cell_size, double cells_there) const;
    vox_foreign_counts with_shares(double cell_size, double empty_part, double occupied_part) const noexcept;

    bool centres_, pairs_, same_set_, around_;
    std::size_t chosen_, looked_cells_, singly_; // of a SampleBudget
    double rough_;
    double held_count_, asking_count_;
    Moments held_cells_, asking_cells_; // that the boxes meet
    PlainBox held_bounds_, asking_bounds_;
    SampleTree held_, asking_;
    Array<Asking> asking_chosen_, held_chosen_;
    PiecewiseMoments read_; // by pairs of unlike ones
    double extent_ = 0, least_ = 0;
    bool has_size_ = false, never_empty_ = false;
    CellSizeRange range_{1, 1};
    std::array<vox_cell_size_rule, 5> rules_{};
    std::pmr::memory_resource* memory_;
    std::optional<ShareTable> empty_shares_, occupied_shares_; // of visits, of entries
};

// The cell size that costs a run least, and the reasons for it. Sets all fields but struct_size.
vox_cell_size_result suggest_for(const ForeignGrid& grid, ForeignWork& work);

} // namespace vox
