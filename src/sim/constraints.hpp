// What a body does by itself in a substep.
//
// Macklin, Mueller, Chentanez: "XPBD: Position-Based Simulation of Compliant Constrained Dynamics" (2016),
// Eqs. 18 and 26; one iteration a substep after Macklin et al.: "Small Steps in Physics Simulation" (2019).
// Constraints are answered one after another in a fixed order (Gauss-Seidel), so that the same input gives
// the same bits.
#pragma once

#include "body.hpp"

namespace vox::sim {

// Semi-implicit Euler: velocities first, then positions with them.
void move_freely(Body& body, const Vec3& gravity, double h);

void solve_edges(Body& body, double h);
void solve_volumes(Body& body, double h);

// Velocities from the way that the substep has moved the particles.
void take_velocities(Body& body, double h);

// Energy stored in the constraints.
double elastic_energy(const Body& body);

} // namespace vox::sim
