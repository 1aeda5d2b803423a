// What a step of the reference engine costs, as a function of the cell size.
//
//   T(d) = c_classify n    vertices put into cells
//        + c_prepare m     boxes of tetrahedra made
//        + c_visit V(d)    cells that the boxes meet
//        + c_list L(d)     of them, cells whose list is of another length than the one before
//        (branch_misses.hpp)
//        + c_read R(d)     vertices in these cells
//        + c_fetch R'(d)   of them, those only passed over that the tetrahedron just before did not read
//        + c_box B(d)      of them, those of other bodies, or all where the body collides with itself
//        + c_tet C         of them, those in the box, corners of the tetrahedron itself included
//        + c_scan S(d)     occupied cells scanned, for boxes that meet more cells than are occupied
//        + c_clear         buckets of the table, or cells of dense storage
#pragma once

#include "cell_size/lookups.hpp"
#include "cell_size/scene.hpp"
#include "cell_size/search.hpp"
#include "cell_size/weights.hpp"

#include <vox/vox_cell_size.h>

#include <optional>

namespace vox {

class ReferenceModel {
public:
    // Measures the positions as they are now; all of them are finite. The scene is not needed afterwards, its
    // memory is.
    ReferenceModel(const CellSizeScene& scene, bool dense, const CostWeights& weights);
    ReferenceModel(const ReferenceModel&) = delete;
    ReferenceModel& operator=(const ReferenceModel&) = delete;

    CostTerms terms(double cell_size) const;
    double operator()(double cell_size) const { return terms(cell_size).cost(); }

    // Cell sizes to search; none where no tetrahedron has a size.
    std::optional<CellSizeRange> range() const noexcept;

    const Lookups& lookups() const noexcept { return lookups_; }
    // The smallest cell size in the range whose cells fit dense storage and the bytes (0: any number of
    // bytes); 0 where all of the range does.
    double least_cell_size(double byte_limit, const CellSizeRange& range) const noexcept;

    // How often each piece of work is done that depends on the cell size.
    struct Work {
        double visited = 0, changed = 0, scanned = 0; // cells
        double read = 0, fetched = 0, tested = 0;     // vertices
    };
    Work work(double cell_size) const noexcept;

    // The cost in parts, for a step with several grids. of_grid() is what a grid of this cell size costs
    // before anything is looked up in it: its vertices and buckets. of_class() is what one class costs in a
    // grid with that many occupied cells. shared() is what is done once, however many grids there are.
    double of_grid(double cell_size) const noexcept;
    double of_class(const SizeClass& c, double cell_size, double occupied) const noexcept;
    double shared() const noexcept;
    double occupied(double cell_size) const noexcept;

private:
    static Work work(const SizeClass& c, double cell_size, double occupied) noexcept;
    // The part of visited cells with a list of another length than the one before; `mean` points lie in one.
    static double changed_share(const SizeClass& c, double cell_size, double mean) noexcept;
    double dense_cells(double cell_size) const noexcept;
    double buckets(double cell_size) const noexcept;

    Lookups lookups_;
    CostWeights weights_;
    bool dense_;
    double vertices_ = 0, tets_ = 0;
    double sides_[3] = {0, 0, 0}; // of the box of all vertices
};

} // namespace vox
