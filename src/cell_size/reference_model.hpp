// What a step of the reference engine costs, as a function of the cell size. Its grid holds vertices, and the
// boxes of tetrahedra ask (moments.hpp):
//
//   T(d) = c_classify n    vertices put into cells
//        + c_prepare m     boxes of tetrahedra made
//        + c_visit V(d)    cells that the boxes meet
//        + c_list L(d)     of them, cells whose list is of another length than the one before
//        + c_read R(d)     vertices in these cells
//        + c_fetch R'(d)   of them, those only passed over that the tetrahedron just before did not read
//        + c_box B(d)      of them, those of other bodies, or all where the body collides with itself
//        + c_tet C         of them, those in the box, corners of the tetrahedron itself included
//        + c_scan S(d)     occupied cells scanned, for boxes that meet more cells than are occupied
//        + c_clear         buckets of the table, or cells of dense storage
//
// A branch predictor guesses where a list ends when its length repeats; otherwise the processor waits. Where
// q = R/V vertices lie in a cell on average, placed as irregularly as by mesh generators, L is the part
// 1 - (1 + 2.5 q)^-0.8 of V, which was fitted to counts.
#pragma once

#include "base/array.hpp"
#include "cell_size/pairs.hpp"
#include "cell_size/scene.hpp"
#include "cell_size/search.hpp"
#include "cell_size/weights.hpp"

#include <vox/vox_cell_size.h>

#include <array>
#include <optional>
#include <span>

namespace vox {

class ReferenceModel {
public:
    // Boxes of tetrahedra whose longest side is at least 2^exponent and less than twice that, and that agree
    // in may_meet: whether vertices of bodies that may collide with theirs may be near them.
    struct SizeClass {
        SizeClass(int exponent, bool may_meet, std::pmr::memory_resource* memory);
        double read(double cell_size) const noexcept { return passed.at(cell_size) + tested.at(cell_size); }

        int exponent;
        bool may_meet;
        double count = 0;                // of the boxes
        double apart = 0;                // of those on one side of the tetrahedron before them in the mesh
        Moments cells;                   // met
        PiecewiseMoments passed, tested; // vertices read, and passed over or tested
    };

    // Measures the positions as they are now; all of them are finite. The scene is not needed afterwards, its
    // memory is.
    ReferenceModel(const CellSizeScene& scene, bool dense, const CostWeights& weights);
    ReferenceModel(const ReferenceModel&) = delete;
    ReferenceModel& operator=(const ReferenceModel&) = delete;

    CostTerms terms(double cell_size) const;
    double operator()(double cell_size) const { return terms(cell_size).cost(); }

    // Cell sizes to search; none where no tetrahedron has a size.
    const std::optional<CellSizeRange>& range() const noexcept { return range_; }
    // The smallest cell size in the range whose cells fit dense storage and the bytes (0: any number of
    // bytes); 0 where all of the range does.
    double least_cell_size(double byte_limit, const CellSizeRange& range) const noexcept;

    // How often each piece of work is done that depends on the cell size: cells visited, changed, scanned,
    // and vertices read, fetched, tested.
    using Work = std::array<double, 6>;
    double candidates() const noexcept;      // C
    double occupied(double cell_size) const; // cells with a vertex in them

    // The cost in parts, for a step with several grids. of_grid() is what a grid of this cell size costs
    // before anything is looked up in it: its vertices and buckets. of_class() is what one class costs in it.
    // shared() is what is done once, however many grids there are.
    double of_grid(double cell_size) const noexcept;
    double of_class(const SizeClass& c, double cell_size) const;
    double shared() const noexcept;
    const Array<SizeClass>& classes() const noexcept { return classes_; }

private:
    // The boxes' kinds are classes. They pass over some of the vertices of all bodies, which are numbered one
    // body after the other.
    Array<AskingBox> sample_boxes(const CellSizeScene& scene);
    SizeClass& class_of(double side, bool may_meet);
    void count_points(const CellSizeScene& scene, const Array<AskingBox>& boxes);
    Work work(const SizeClass& c, double cell_size) const;
    double dense_cells(double cell_size) const noexcept;
    double buckets(double cell_size) const noexcept;

    CostWeights weights_;
    bool dense_;
    SampleBudget budget_;
    double vertices_ = 0, tets_ = 0;
    double sides_[3] = {0, 0, 0}; // of the box of all vertices
    Array<SizeClass> classes_;    // that occur
    std::optional<CellSizeRange> range_;
    std::optional<SampleTree> points_; // vertices
    mutable Array<Asking> points_chosen_;
    mutable std::optional<ShareTable> occupied_shares_;
};

} // namespace vox
