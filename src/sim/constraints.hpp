// The stages of a substep that concern a single body.
//
// Macklin, Mueller, Chentanez: "XPBD: Position-Based Simulation of Compliant Constrained Dynamics" (2016),
// Eqs. 18 and 26, with one iteration a substep as in Macklin et al.: "Small Steps in Physics Simulation"
// (2019). Constraints are solved one after another in a fixed order (Gauss-Seidel), so that the same input
// gives the same bits.
#pragma once

#include "sim/body.hpp"

namespace vox::sim {

// Sets the constraints up for substeps of h. Stiffness that one sweep a substep cannot handle is reduced and
// counted, because it would add energy.
void set_substep(SoftBody& body, double h);

// Semi-implicit Euler: velocities first, then positions with them.
void move_freely(SoftBody& body, const Vec3& gravity, double h);

void solve_edges(SoftBody& body);
void solve_volumes(SoftBody& body);

// Computes velocities from how far the substep has moved the particles.
void take_velocities(SoftBody& body, double h);

// Damps the edges' change of length. Keeps momentum and angular momentum.
void damp(SoftBody& body, double h);

// Energy stored in the constraints.
double elastic_energy(const SoftBody& body);

} // namespace vox::sim
