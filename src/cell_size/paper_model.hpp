// The paper's cost function (Sect. 4), in the cell size as a multiple of the size s of a tetrahedron, x =
// delta / s. Nothing in it has a unit, so scenes in millimetres and in kilometres give the same numbers.
//
//   v_o = (1/x + 2)^3                      objective voxels of a tetrahedron    (Eq. 4, without its floor)
//   p_v = 3 (sqrt(3)/2) x^2 s^2 / A        particles in a voxel                 (Eqs. 5 to 7)
//   z   = p_nc v_o + (1 - p_nc) v_o p_v r  cost of a tetrahedron in cell visits (Eq. 3)
//       = (1/x + 2)^3 (p_nc + k x^2),  k = (1 - p_nc) r 3 (sqrt(3)/2) s^2 / A
#pragma once

#include "cell_size/scene.hpp"
#include "cell_size/search.hpp"

#include <vox/vox_cell_size.h>

namespace vox {

class PaperModel {
public:
    // Throws INVALID_ARGUMENT where there are no tetrahedra,
    // none of any size, or k would leave [1e-290, 1e290], within which no number here overflows.
    PaperModel(const CellSizeScene& scene, const vox_cell_size_desc& desc);

    double operator()(double cell_size) const { return cost(cell_size / s_); }
    vox_cost_sample minimum() const;
    // Cell sizes whose cost is at most (1 + loss) times the least.
    CellSizeRange zone(double loss) const;
    CostTerms terms(double cell_size) const;

private:
    double cost(double x) const noexcept {
        const double side = 1 / x + 2;
        return side * side * side * (p_nc_ + k_ * x * x);
    }
    double best_x() const noexcept;

    double p_nc_; // probability that a tetrahedron has no collision
    double cost_ratio_, s_, k_;
};

} // namespace vox
