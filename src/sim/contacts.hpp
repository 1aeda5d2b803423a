// The response to contacts between bodies, with shapes and with the floor in a substep: penalty forces and
// friction.
//
// The vertices of a constraint (vox_constraint) whose gap is negative are pushed along its normal, each in
// proportion to its weight, with a force linear in the depth. The force is integrated implicitly, as an
// XPBD constraint on the depth (Macklin et al. 2016), so that any stiffness is stable. Two rules, both as in
// Box2D 3, keep contacts calm. Penetration from before the substep is undone at a bounded speed, which does
// not add to the velocities. A small depth, the slop, is tolerated, so that a resting contact is found again
// in every substep. Friction opposes the relative tangential motion of the substep, up to Coulomb's bound.
#pragma once

#include "base/array.hpp"
#include "sim/body.hpp"
#include "sim/shapes.hpp"

#include <memory>
#include <span>

namespace vox::sim {

// A point of body a and one of body b, which may be the same (vox_constraint), or of a shape.
struct Contact {
    SoftBody* a;
    SoftBody* b;                  // null: a shape, which has no vertices
    std::uint32_t count_a, count; // vertices of a, which come first, and of both
    std::uint32_t vertices[VOX_STENCIL_CAPACITY];
    double weights[VOX_STENCIL_CAPACITY];
    Vec3 direction; // out of b
    Vec3 motion;    // of the shape in a substep
    double depth;   // where the two points coincide
    double slop;
    double inverse_mass; // for the relative motion of the two points

    SoftBody& body(std::uint32_t i) const noexcept { return i < count_a ? *a : *b; }
};

struct ContactSettings {
    double friction;
    double compliance;
    double push_speed;
    double slop; // negative: a hundredth of the mean edge of the two bodies
};

// The floor fills the half-space normal . x < offset. There is none if normal is zero.
struct Floor {
    Vec3 normal;
    double offset;
};

// The body of a mesh, or null if there is none. `bodies` must ascend in mesh.
SoftBody* find_body(std::span<const BodyHandle> bodies, vox_body mesh);

// Reads the constraints of the grid's last step, except those of meshes not in `bodies`, of pairs of fixed
// bodies and, without `shapes`, of shapes.
void gather_contacts(const vox_grid* grid, std::span<const BodyHandle> bodies, const Shapes* shapes,
                     const ContactSettings& settings, Array<Contact>& contacts);

// `age`: how many substeps have ended since the contacts were found.
void solve_contacts(std::span<const Contact> contacts, std::uint32_t age, const ContactSettings& settings,
                    double h);

// Returns how many particles the floor held.
std::uint64_t solve_floor(SoftBody& body, const Floor& floor, const ContactSettings& settings, double h);

} // namespace vox::sim
