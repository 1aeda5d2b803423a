// What a step of the fast engine costs, as a function of the cell size of its windows.
//
//   T(d) = c_bin n           bin the vertices that may be in contact, once for each body
//        + c_clear           cells of the windows, at most two a vertex
//        + c_tile            tiles that look into a window, each for every body it is near to
//        + c_row  sum over these of the rows of cells that the tile's box meets there
//        + c_read sum over these of the vertices in these rows' cells: contiguous, hence cheap
//        + c_test            those of them in the tile's box, against its tets: independent of d
//
// The unit is the tile, not the tet, and the row, not the cell: so the power of 1/d is 2 instead of 3, and
// the best cell is larger. Bodies that touch nothing, and those that collide with themselves but are cleared
// by winding numbers, have no window and cost nothing here.
#pragma once

#include "cell_size/activity.hpp"
#include "cell_size/effort.hpp"
#include "cell_size/lookups.hpp"
#include "cell_size/scene_boxes.hpp"
#include "cell_size/terms.hpp"

#include "base/scene.hpp"
#include "fast/engine.hpp"

#include <vox/vox.h>

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

class FastModel {
public:
    // `tiles` of each body, and what its last step was like, if it is known: then `activity` has as many.
    // Measures the positions as they are now; all of them are finite.
    FastModel(std::span<const Body> bodies, std::span<const Tiles* const> tiles,
             std::span<const Activity> activity, const SampleBudget& effort, const vox_cost_weights& weights,
             std::pmr::memory_resource* memory);

    // The same with boxes that are there already, of the same bodies and tiles.
    FastModel(std::span<const Body> bodies, std::span<const Tiles* const> tiles,
             std::span<const Activity> activity, SceneBoxes& boxes, const SampleBudget& effort,
             const vox_cost_weights& weights, std::pmr::memory_resource* memory);

    // The same from what the engine found in its last step, of these bodies where they were then.
    FastModel(std::span<const Body> bodies, const FastEngine& last_step, const SampleBudget& effort,
             const vox_cost_weights& weights, std::pmr::memory_resource* memory);

    // A window's lattice begins at its corner: how the tiles lie in it is a matter of luck, which tells in
    // small windows. Counted as it is, or in the mean over all ways to lie, which is smooth in the cell size
    // and what to choose one by: bodies move on.
    enum class Alignment { actual, average };

    CostTerms terms(double cell_size, Alignment lie) const;
    double operator()(double cell_size) const { return terms(cell_size, Alignment::average).cost(); }

    // Cell sizes that are worth a look; false where no body is near another one, or itself.
    bool range(double& min, double& max) const noexcept;

    struct Counts {
        double vertices = 0, cells = 0; // binned, and of the windows
        double looks = 0;               // of tiles into windows
        double rows = 0, read = 0, tested = 0;
        double visited_cells = 0; // as they lie alone
    };
    Counts counts(double cell_size, Alignment lie) const;

    // What it takes: points looked at near sampled tiles, once, and looks gone through for each cell size.
    struct Work {
        std::uint64_t points = 0, looks = 0;
    };
    Work work() const noexcept;

private:
    // A tile's box in a window, cut to it: its sides, and how far the window goes on below and above.
    struct Look {
        double side[3], below[3], above[3];
    };
    // Windows whose smallest possible cells are alike, so that one effective cell size does for all.
    struct Pool {
        Pool(int key, const SampleSizes& sizes, std::pmr::memory_resource* memory)
            : key(key), profile(sizes, memory), points(memory), looks(memory) {}

        double effective(double cell_size) const noexcept { return std::max(cell_size, smallest_cell); }
        // From so many looks, evenly spread, at most.
        void add(double cell_size, Alignment lie, std::size_t most_looks, Counts& sum) const noexcept;
        static double along(const Look& look, int axis, double inverse) noexcept; // cells, in the mean
        double mean_rows(double cell_size, std::size_t most_looks) const noexcept;
        // Adds rows and cells as they lie; returns how much of the window they cover, over that in the mean.
        double laid(double cell_size, std::size_t most_looks, Counts& sum) const noexcept;

        int key;
        Lookups profile;
        fast::Points points;
        std::pmr::vector<Look> looks;
        double windows = 0, smallest_cell = 0; // of a window, in the mean
        double largest_side = 0;               // of a window
        Moments cells;                         // of the windows themselves
    };

    template <class Source>
    void look(std::span<const Body> bodies, Source&& source, const SampleBudget& effort,
              std::pmr::memory_resource* memory);
    Pool& pool_of(double smallest_cell, const SampleSizes& sizes);

    std::pmr::vector<Pool> pools_;
    vox_cost_weights weights_;
    std::size_t most_looks_;
};

} // namespace vox
