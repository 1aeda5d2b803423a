// What a step of the fast engine costs, as a function of the cell size of its windows. These hold vertices,
// and the boxes of tiles ask (moments.hpp):
//
//   T(d) = c_bin n      vertices that may be in contact, binned once for each body
//        + c_clear W(d) cells of the windows, at most two a vertex
//        + c_tile L     looks of a tile into a window, one for each body that the tile is near
//        + c_row Q(d)   rows of cells that the tile's box meets there
//        + c_read R(d)  vertices in the cells of these rows: contiguous, hence cheap
//        + c_test C     of them, those in the tile's box, tested against its tetrahedra
//
// The unit is the tile, not the tetrahedron, and the row, not the cell. So the highest power of 1/d is 2
// instead of 3, and the best cell is larger. Bodies that touch nothing, and those whose self-collision is
// excluded by winding numbers, have no window and cost nothing here.
#pragma once

#include "base/array.hpp"
#include "cell_size/pairs.hpp"
#include "cell_size/scene.hpp"
#include "cell_size/search.hpp"
#include "cell_size/weights.hpp"

#include <vox/vox_cell_size.h>

#include <cstdint>
#include <memory_resource>
#include <optional>
#include <span>

namespace vox {

class FastModel {
public:
    // Of a scene that was prepared for this model. It is not needed afterwards, its memory is.
    FastModel(const CellSizeScene& scene, const CostWeights& weights);

    // A window's lattice begins at its corner. In small windows the counts depend on how the tiles happen to
    // lie there: `actual` counts them so. `average` takes the mean over all alignments, which is smooth in
    // the cell size and better to choose one by, since bodies move on.
    enum class Alignment { actual, average };

    CostTerms terms(double cell_size, Alignment alignment) const;
    double operator()(double cell_size) const { return terms(cell_size, Alignment::average).cost(); }

    // Cell sizes to search; none where no body is near another one or itself.
    std::optional<CellSizeRange> range() const noexcept;

    struct Counts {
        double vertices = 0, cells = 0; // binned, and of the windows
        double looks = 0;               // of tiles into windows
        double rows = 0, read = 0, tested = 0;
        double visited_cells = 0; // for Alignment::actual only
    };
    Counts counts(double cell_size, Alignment alignment) const;

    // How many points near sampled tiles were looked at, and how many looks each call of counts() goes
    // through.
    std::uint64_t points_looked_at() const noexcept;
    std::uint64_t looks_per_call() const noexcept;

private:
    // Of the box of a tile in a window, cut to it, along an axis: its side, and how far the window extends
    // below and above. One after the other: compilers make vectors of loops over them.
    struct Extents {
        explicit Extents(std::pmr::memory_resource* memory) : side(memory), below(memory), above(memory) {}
        double cells(std::size_t look, double inverse) const noexcept; // met, on average
        Array<float> side, below, above;
    };
    // Windows whose smallest possible cells are alike, so that the same cell size is used in all of them.
    struct Pool {
        Pool(int key, std::pmr::memory_resource* memory)
            : key(key), axes{Extents(memory), Extents(memory), Extents(memory)} {}

        void add(double cell_size, Alignment alignment, Counts& sum) const noexcept;
        double mean_rows(double cell_size) const noexcept;
        // Adds rows and cells as they lie. Returns how much of the window they cover, relative to the
        // average.
        double add_actual(double cell_size, Counts& sum) const noexcept;

        int key;
        double windows = 0, smallest_cell = 0;      // the mean of the windows
        double largest_side = 0;                    // of a window
        double vertices = 0, look_count = 0;        // of all
        double smallest_look = 0, largest_look = 0; // longest sides above 0
        Moments cells;                              // of the windows
        std::optional<PiecewiseMoments> read;
        std::size_t kept = 0; // looks that are gone through at each size
        Extents axes[3];      // of these
    };
    struct Window {
        Box box;
        std::uint32_t first, count, pool; // points
    };
    struct Look {
        Box box;
        std::uint32_t window;
    };

    void gather(const CellSizeScene& scene, fast::Points& points, Array<Window>& windows, Array<Look>& looks);
    std::uint32_t add_window(const fast::Points& points, std::uint32_t first, Array<Window>& windows);
    void keep_looks(const Array<Window>& windows, const Array<Look>& looks);
    void count_points(const fast::Points& points, const Array<Window>& windows, const Array<Look>& looks);

    Array<Pool> pools_;
    CostWeights weights_;
    SampleBudget budget_;
    double each_ = 1; // looks that one in the list stands for
};

} // namespace vox
