// What a step of the reference engine costs, as a function of the cell size.
//
//   T(d) = c_bin n                        classify every vertex
//        + c_prepare m                    box of every tetrahedron
//        + c_visit sum over tets of the cells their boxes meet
//        + c_other those of them whose list is of another length than the one before (list_changes.hpp)
//        + c_read  sum over tets of the vertices in these cells
//        + c_fetch those of them that are only passed over, and that no tetrahedron just before has read
//        + c_box   those of them that are another body's, or any where the body collides with itself
//        + c_tet   those of them that are in the box, corners of the tet itself included: independent of d
//        + c_scan  occupied cells gone through, for boxes that meet more cells than are occupied
//        + c_clear buckets of the table, or cells of dense storage
#pragma once

#include "cell_size/effort.hpp"
#include "cell_size/lookups.hpp"
#include "cell_size/search.hpp"
#include "cell_size/terms.hpp"

#include "base/scene.hpp"

#include <vox/vox.h>

#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

class ReferenceModel {
public:
    // Measures the positions as they are now; all of them are finite. Memory is given back on return.
    ReferenceModel(std::span<const Body> bodies, vox_storage storage, const SampleBudget& effort,
                  const vox_cost_weights& weights, std::pmr::memory_resource* memory);
    ReferenceModel(const ReferenceModel&) = delete;
    ReferenceModel& operator=(const ReferenceModel&) = delete;

    CostTerms terms(double cell_size) const;
    double operator()(double cell_size) const { return terms(cell_size).cost(); }

    // Cell sizes that are worth a look; false where there is no tetrahedron of any size.
    bool range(double& min, double& max) const noexcept;

    const Lookups& profile() const noexcept { return profile_; }
    double dense_cells(double cell_size) const noexcept;
    // The smallest cell size in the range whose cells dense storage takes, within the bytes (0: any number);
    // 0 where all of the range is fine.
    double least_cell_size(double byte_limit, const CellSizeRange& range) const noexcept;

    // The cost in parts: of a grid with this cell size that nothing looks into, vertices and buckets; of what
    // one class does in it, given how many of its cells are occupied; and of what is done once, however many
    // grids there are.
    double of_grid(double cell_size) const noexcept;
    double of_class(const SizeClass& c, double cell_size, double occupied) const noexcept;
    double shared() const noexcept;
    // The part of all that is no smooth function of the cell size: what lists of changing length cost.
    double of_changes(double cell_size) const noexcept;
    double occupied(double cell_size) const noexcept;

    // All that visits cost, in visits of empty cells nearby, and all that reading costs, in readings of
    // vertices at hand.
    double visit_units(double cell_size) const noexcept;
    double read_units(double cell_size) const noexcept;

private:
    // How often each piece is done that depends on the cell size.
    struct Work {
        double visited = 0, changed = 0, scanned = 0; // cells
        double read = 0, fetched = 0, tested = 0;     // vertices
    };
    static Work work(const SizeClass& c, double cell_size, double occupied) noexcept;
    Work work(double cell_size) const noexcept;
    // Of the cells visited; `mean` points lie in one.
    static double changed_share(const SizeClass& c, double cell_size, double mean) noexcept;
    double buckets(double cell_size) const noexcept;

    Lookups profile_;
    vox_cost_weights weights_;
    bool dense_;
    double vertices_ = 0, tets_ = 0;
    double sides_[3] = {0, 0, 0}; // of the box of all vertices
};

} // namespace vox
