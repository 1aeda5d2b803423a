// The paper's cost function (Sect. 4), in the cell size as a multiple of the size of a tetrahedron: x = delta
// / s. Nothing in it has a unit, so that scenes in millimetres and in kilometres are the same numbers.
//
//   v_o = (1/x + 2)^3                      objective voxels of a tetrahedron    (Eq. 4, without its floor)
//   p_v = 3 (sqrt(3)/2) x^2 s^2 / A        particles in a voxel                 (Eqs. 5 to 7)
//   z   = p_nc v_o + (1 - p_nc) v_o p_v r  cost of a tetrahedron in cell visits (Eq. 3)
//       = (1/x + 2)^3 (p_nc + k x^2),  k = (1 - p_nc) r 3 (sqrt(3)/2) s^2 / A
#pragma once

namespace vox {

struct PaperModel {
    double p_nc; // probability that a tetrahedron has no collision, in (0, 1)
    double
        k; // in [1e-290, 1e290]: then nothing here overflows for x within a factor of 1000 of the least cost

    double operator()(double x) const {
        const double side = 1 / x + 2;
        return side * side * side * (p_nc + k * x * x);
    }

    // The x of least cost. dz/dx = 0 (Eq. 8) is 4 x^3 - x^2 = c with c = 3 p_nc / k: below 1/4 the left side
    // is not positive, above it ascends and is convex, so there is one root.
    double minimiser() const;
};

// Cell sizes around the best one, in whatever unit it has.
struct Zone {
    double min;
    double max;
};

// All x with cost(x) <= limit, for a limit of at least the cost at x_best, the minimiser: the cost falls
// before it and rises after it, without bound.
Zone zone_around(double x_best, double limit, const PaperModel& cost);

} // namespace vox
