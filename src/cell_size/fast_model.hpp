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
    // lie there: `as_laid` counts them so. Else they are means over all alignments, which are smooth in the
    // cell size and better to choose one by, since bodies move on.
    CostTerms terms(double cell_size, bool as_laid = false) const;
    double operator()(double cell_size) const { return terms(cell_size).cost(); }
    double visited_cells(double cell_size) const; // of the rows, as laid

    // Cell sizes to search; none where no body is near another one or itself.
    std::optional<CellSizeRange> range() const noexcept;

    // How many points near sampled tiles were looked at, and how many looks each call of counts() goes
    // through.
    std::uint64_t points_looked_at() const noexcept;
    std::uint64_t looks_per_call() const noexcept;

private:
    // Windows whose smallest possible cells are alike, so that the same cell size is used in all of them.
    struct Pool {
        Pool(int key, std::pmr::memory_resource* memory) : key(key), extents(memory) {}

        void add_look(const Box& look, const Box& window);
        void keep(std::size_t most); // of the looks
        double mean_rows(double cell_size) const noexcept;
        // Sets rows and cells as they lie. Returns how much of the window they cover, relative to the
        // average.
        double lay(double cell_size, double& rows, double& cells) const noexcept;
        const float* extent(std::size_t look, int axis) const noexcept; // the next two are some_looks behind

        int key;
        double windows = 0, smallest_cell = 0;      // the mean of the windows
        double largest_side = 0;                    // of a window
        double vertices = 0, look_count = 0;        // of all
        double smallest_look = 0, largest_look = 0; // longest sides above 0
        Moments cells;                              // of the windows
        std::optional<PiecewiseMoments> read;
        std::size_t kept = 0; // looks that are gone through at each size
        // For each axis, the sides of their boxes, cut to the window, and how far it extends below and above,
        // of some looks at a time: compilers make vectors of loops over them.
        Array<float> extents;
    };

    void gather(const CellSizeScene& scene, fast::Points& points, Array<AskingBox>& looks);
    Pool& pool_of(double smallest_cell);
    void count_points(const fast::Points& points, const Array<AskingBox>& looks);

    Array<Pool> pools_;
    CostWeights weights_;
    SampleBudget budget_;
    double each_ = 1; // looks that one in the list stands for
};

} // namespace vox
